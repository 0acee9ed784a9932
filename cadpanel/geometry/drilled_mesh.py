"""Round holes cut out of a skin's mesh, and out of that of the sheet's other face. Millimetres.

Every point round a hole has a place on the mesh's chart: that of the triangle that it lies on. There the vertices of a
patch and its holes' rims are joined anew, after Delaunay, and what lies in a hole, or beyond the border, is left out.
Delaunay's triangles keep every side of a rim, as nothing else is near; sides of the border that they lose, in notches,
are halved until they keep them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import Delaunay

from cadpanel.arrays import Array, BoolArray, IntArray
from cadpanel.geometry.fixings import Hole
from cadpanel.geometry.polyline import inside_edges
from cadpanel.geometry.skin_mesh import SkinMesh
from cadpanel.geometry.vectors import unit

ROUND = 12
"""Corners of a hole."""
_CLEAR = 1.4
"""Vertices that are not on the border keep this many radii away from the middle of a hole."""
_BULGE = 1e-3
"""By which the chart's straight borders are bent outwards, as a share of its size, so that no three vertices of them
stand in line: which of them are joined would hang on rounding, and on a bent end they are not in line."""
_SHORTEST = 1.0
"""Sides of the border that are shorter, mm, are not halved: nobody sees them."""


@dataclass(frozen=True, slots=True, kw_only=True)
class DrilledMesh:
    """A sheet's two faces with their holes.

    Attributes:
        points: (v, 3) on the skin.
        other: (v, 3) the same ones on the other face.
        triangles: (f, 3) counterclockwise seen from outside.
    """

    points: Array
    other: Array
    triangles: IntArray


def hole_rims(holes: Sequence[Hole], depth: float) -> Array:
    """(2, h, ROUND, 3) points round holes, on the skin and on the other face, `depth` mm along the skin's normals."""
    turns = 2.0 * np.pi * np.arange(ROUND) / ROUND
    ways = np.stack([np.cos(turns), np.sin(turns)], axis=-1)
    rims = np.empty((2, len(holes), ROUND, 3))
    for place, hole in enumerate(holes):
        points, normals = hole.place.on_skin(hole.middle + 0.5 * hole.diameter * ways)
        rims[:, place] = points, points + depth * normals
    return rims


def hole_count(triangles: IntArray) -> int:
    """How many holes triangles (f, 3) leave, by Euler: each part that hangs together is a disc but for them."""
    sides = np.unique(np.sort(_sides(triangles), axis=1), axis=0)
    graph = coo_array((np.ones(len(sides)), sides.T), shape=(int(triangles.max()) + 1,) * 2)
    _, labels = connected_components(graph, directed=False)
    corners = np.unique(triangles)
    return len(np.unique(labels[corners])) - (len(corners) - len(sides) + len(triangles))


def drilled_mesh(mesh: SkinMesh, other: Array, rims: Array) -> DrilledMesh:
    """A mesh with holes.

    Args:
        mesh: of the skin.
        other: (v, 3) its vertices on the other face.
        rims: (2, h, k, 3) round the holes, each inside of one patch, clear of its border and of each other.
    """
    if not rims.shape[1]:
        return DrilledMesh(points=mesh.points, other=other, triangles=mesh.triangles)
    places, patches = _on_chart(mesh, rims[0])
    made = _Vertices(
        chart=np.concatenate([mesh.chart, places.reshape(-1, 2)]),
        faces=np.concatenate([np.stack([mesh.points, other]), rims.reshape(2, -1, 3)], axis=1),
    )
    rounds = len(mesh.points) + np.arange(places.shape[0] * places.shape[1]).reshape(places.shape[:2])
    triangles = [mesh.triangles[~np.isin(mesh.patches, patches)]]
    for patch in np.unique(patches).tolist():
        triangles.append(_with_holes(made, mesh.triangles[mesh.patches == patch], rounds[patches == patch]))
    used, local = np.unique(np.concatenate(triangles), return_inverse=True)
    skin, far = made.faces[:, used]
    return DrilledMesh(points=skin, other=far, triangles=local.reshape(-1, 3))


@dataclass(slots=True)
class _Vertices:
    """Of the patches and of the rims: (v, 2) on the chart and (2, v, 3) on the two faces."""

    chart: Array
    faces: Array

    def between(self, sides: IntArray) -> IntArray:
        """New ones in the middles of sides (m, 2)."""
        self.chart = np.concatenate([self.chart, self.chart[sides].mean(axis=1)])
        self.faces = np.concatenate([self.faces, self.faces[:, sides].mean(axis=2)], axis=1)
        return len(self.chart) - len(sides) + np.arange(len(sides))


def _with_holes(made: _Vertices, triangles: IntArray, rounds: IntArray) -> IntArray:
    """Triangles (f, 3) in place of those of a patch, without what lies inside of rounds (h, k) of vertices."""
    sides = _border(triangles)
    bent = _Bent.of(made.chart, sides)
    clear = np.concatenate([sides[:, 0], _clear(made.chart, np.setdiff1d(triangles, sides), rounds), rounds.ravel()])
    while True:
        found = clear[Delaunay(bent(made.chart[clear])).simplices]
        lost = _lost(sides, found) & (np.linalg.norm(np.diff(made.chart[sides], axis=1)[:, 0], axis=-1) > _SHORTEST)
        if not lost.any():
            break
        first, last = sides[lost].T
        between = made.between(sides[lost])
        clear = np.concatenate([clear, between])
        sides = np.concatenate([sides[~lost], np.stack([first, between, between, last], axis=1).reshape(-1, 2)])
    start, stop = (bent(made.chart[ends]) for ends in np.concatenate([sides, _sides(rounds)]).T)
    # Delaunay's run counterclockwise, as all do on a chart.
    return found[inside_edges(bent(made.chart[found]).mean(axis=1), start, stop)]


@dataclass(frozen=True, slots=True)
class _Bent:
    """A chart along the longest side of a border, bent outwards: a patch of rows and columns is a box there."""

    ways: Array
    middle: Array
    half: Array

    @classmethod
    def of(cls, chart: Array, sides: IntArray) -> _Bent:
        along = chart[sides[:, 1]] - chart[sides[:, 0]]
        x, y = unit(along[np.linalg.norm(along, axis=1).argmax()])
        ways = np.array([[x, -y], [y, x]])
        border = chart[sides[:, 0]] @ ways
        low, high = border.min(axis=0), border.max(axis=0)
        return cls(ways, 0.5 * (low + high), 0.5 * (high - low))

    def __call__(self, places: Array) -> Array:
        turned = places @ self.ways
        share = (turned - self.middle) / np.maximum(self.half, np.finfo(float).tiny)
        return np.asarray(turned + _BULGE * self.half * share * (1.0 - share[..., ::-1] ** 2))


def _clear(chart: Array, inner: IntArray, rounds: IntArray) -> IntArray:
    """Those of some vertices that are not near a hole."""
    middles = chart[rounds].mean(axis=1)
    radii = np.linalg.norm(chart[rounds] - middles[:, None], axis=-1).max(axis=1)
    apart = np.linalg.norm(chart[inner, None] - middles, axis=-1)
    return np.asarray(inner[(apart > _CLEAR * radii).all(axis=1)])


def _border(triangles: IntArray) -> IntArray:
    """(m, 2) the sides that one triangle only has, as it runs through them."""
    sides = _sides(triangles)
    return sides[~np.isin(_named(sides), _named(sides[:, ::-1]))]


def _sides(rounds: IntArray) -> IntArray:
    """(n k, 2) the sides of n rounds (n, k), each from corner to corner."""
    return np.stack([rounds, np.roll(rounds, -1, axis=1)], axis=-1).reshape(-1, 2)


def _on_chart(mesh: SkinMesh, rims: Array) -> tuple[Array, IntArray]:
    """(h, k, 2) where points (h, k, 3) near a mesh lie on its chart, and (h,) the patch of each hole."""
    corners = mesh.points[mesh.triangles]
    middles, sizes = corners.mean(axis=1), np.linalg.norm(np.ptp(corners, axis=1), axis=-1)
    places, patches = np.empty((*rims.shape[:2], 2)), np.empty(len(rims), dtype=np.intp)
    for hole, rim in enumerate(rims):
        size = np.linalg.norm(np.ptp(rim, axis=0))
        near = np.flatnonzero(np.linalg.norm(middles - rim.mean(axis=0), axis=-1) <= sizes + size)
        on, shares = _lying_on(corners[near], rim)
        places[hole] = np.einsum("kc,kcx->kx", shares, mesh.chart[mesh.triangles[near[on]]])
        patches[hole] = mesh.patches[near[on[0]]]
    return places, patches


def _lying_on(corners: Array, points: Array) -> tuple[IntArray, Array]:
    """The triangle of some (t, 3, 3) on or by which each point (k, 3) lies, and the shares (k, 3) of its corners."""
    origin, u, v = corners[:, 0], corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    way = points[:, None] - origin
    uu, uv, vv = ((one * other).sum(axis=-1) for one, other in ((u, u), (u, v), (v, v)))
    wu, wv = ((way * one).sum(axis=-1) for one in (u, v))
    doubled = np.maximum(uu * vv - uv**2, np.finfo(float).tiny)
    s, t = (vv * wu - uv * wv) / doubled, (uu * wv - uv * wu) / doubled
    off = np.linalg.norm(way - s[..., None] * u - t[..., None] * v, axis=-1)
    beside = np.maximum(np.max([-s, -t, s + t - 1.0], axis=0), 0.0) * np.sqrt(np.maximum(uu, vv))
    best = np.argmin(off + beside, axis=1)
    s, t = (np.take_along_axis(one, best[:, None], axis=1)[:, 0] for one in (s, t))
    return best, np.stack([1.0 - s - t, s, t], axis=-1)


def _lost(sides: IntArray, triangles: IntArray) -> BoolArray:
    """(m,) which sides (m, 2) are no side of a triangle."""
    own, wanted = np.sort(_sides(triangles), axis=1), np.sort(sides, axis=1)
    return ~np.isin(_named(wanted), _named(own))


def _named(sides: IntArray) -> IntArray:
    """(m,) a number of its own for each side (m, 2), told from its first end to its second."""
    return np.asarray(sides[:, 0].astype(np.int64) << 32 | sides[:, 1])
