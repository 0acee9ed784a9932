"""A loft unrolled into the plane, ruling by ruling.

With e the unit direction of the ruling, n the normal in its middle and w = n x e, the ruling turns in the plane as it
does in the tangent plane, and the rail A goes on beside it as it does there:

    phi' = e' . w,    p' = (A' . e) (cos phi, sin phi) + (A' . w) (-sin phi, cos phi),

and B lies |B - A| along the ruling (do Carmo, Differential geometry of curves and surfaces, 1976, on developable
surfaces: e' lies in the tangent plane). Where the surface is warped, what points out of that plane is lost: lengths
and areas in the plane come out too small, and by how much is measured.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import BSpline, make_interp_spline

from cadpanel.arrays import Array, BoolArray, IntArray
from cadpanel.geometry.vectors import cross, norm
from cadpanel.lofting.pieces import DEGREE, Piece

# Places in every span between two knots, and across, along a ruling.
_FINE, _ACROSS = 3, 12


@dataclass(frozen=True, eq=False)
class FlatPiece:
    """A piece in the plane: the images of A and B, splines of u in mm, and the angles of its first and last ruling."""

    edges: tuple[BSpline, BSpline]
    apex: int | None

    def rulings(self, u: Array) -> Array:
        """(m, 2, 2) the ends of rulings."""
        return np.stack([np.asarray(edge(u)) for edge in self.edges], axis=1)


@dataclass(frozen=True, slots=True, kw_only=True)
class FlatError:
    """By how much the plane is wrong.

    Attributes:
        length: the largest difference between the length of a rail, or of a part of it from its beginning, and that of
            its image, mm.
        area: of the surface less that of its image, mm2.
        surface: the area of the surface, mm2.
    """

    length: float
    area: float
    surface: float


def unrolled(pieces: Sequence[Piece]) -> tuple[tuple[FlatPiece, ...], FlatError]:
    """Pieces that follow each other, the first ruling from the origin along y, seen from where n points."""
    place, angle = np.zeros(2), 0.5 * np.pi
    flats, lost, areas = [], np.zeros(2), np.zeros(2)
    worst = 0.0
    for piece in pieces:
        u = _places(piece)
        a, b = piece.jets(u)
        ruling = b.point - a.point
        length = norm(ruling)
        e = ruling / length[:, None]
        change = b.first - a.first
        turn = (change - _dot(change, e)[:, None] * e) / length[:, None]
        w = cross(piece.normals(u), e)
        phi = angle + _integral(u, _dot(turn, w))
        along, beside = np.stack([np.cos(phi), np.sin(phi)], axis=-1), np.stack([-np.sin(phi), np.cos(phi)], axis=-1)
        image = place + _integral(u, _dot(a.first, e)[:, None] * along + _dot(a.first, w)[:, None] * beside)
        other = image + length[:, None] * along
        edges = [_spline(u, image), _spline(u, other)]
        if piece.apex is not None:
            edges[piece.apex] = _spline(u, np.broadcast_to((image, other)[piece.apex][:1], image.shape))
        flats.append(FlatPiece((edges[0], edges[1]), piece.apex))
        for row, jet in enumerate((a, b)):
            missing = lost[row] + _integral(u, norm(jet.first) - np.linalg.norm(edges[row](u, nu=1), axis=-1))
            worst, lost[row] = max(worst, float(np.abs(missing).max())), float(missing[-1])
        areas += _areas(piece, u, image, other, along)
        place, angle = image[-1], float(phi[-1])
    return tuple(flats), FlatError(length=worst, area=float(areas[0] - areas[1]), surface=float(areas[0]))


def _places(piece: Piece) -> Array:
    knots = np.unique(piece.edges[0].t)
    return np.linspace(0.0, 1.0, _FINE * max(len(knots) - 1, 8) + 1)


def _spline(u: Array, values: Array) -> BSpline:
    return make_interp_spline(u, values, k=DEGREE)


def _integral(u: Array, values: Array) -> Array:
    return np.asarray(_spline(u, values).antiderivative()(u))


def _areas(piece: Piece, u: Array, image: Array, other: Array, along: Array) -> Array:
    """The areas of the surface and of its image, mm2: both over the rulings' own lengths by Gauss' rule."""
    a, b = piece.jets(u)
    nodes, weights = np.polynomial.legendre.leggauss(_ACROSS)
    found = np.zeros((2, len(u)))
    slopes = [np.asarray(_spline(u, line)(u, nu=1)) for line in (image, other)]
    length = norm(b.point - a.point)
    for v, weight in zip(0.5 * (1.0 + nodes), 0.5 * weights, strict=True):
        found[0] += weight * norm(cross((1.0 - v) * a.first + v * b.first, b.point - a.point))
        slope = (1.0 - v) * slopes[0] + v * slopes[1]
        found[1] += weight * length * np.abs(slope[:, 0] * along[:, 1] - slope[:, 1] * along[:, 0])
    return np.array([_integral(u, row)[-1] for row in found])


def _dot(one: Array, other: Array) -> Array:
    return np.asarray(np.einsum("md,md->m", one, other))


class FlatPaths:
    """Edges in the plane as `biarcs` follows curves: c splines, each by u from 0 to 1."""

    def __init__(self, paths: Sequence[tuple[BSpline, bool]]) -> None:
        """Splines, and whether each of them is followed backwards."""
        self._paths = list(paths)
        self.curved: BoolArray = np.array([not _straight(path) for path, _ in self._paths], dtype=bool)
        self.start: Array = np.array([path(1.0 if back else 0.0) for path, back in self._paths])

    def __len__(self) -> int:
        return len(self._paths)

    def take(self, rows: IntArray) -> FlatPaths:
        """Some of them, perhaps one several times."""
        return FlatPaths([self._paths[row] for row in rows.tolist()])

    def points(self, u: Array) -> Array:
        """(c, q, 2) points at parameters (c, q)."""
        return np.array([path(1.0 - row if back else row) for (path, back), row in zip(self._paths, u, strict=True)])

    def velocities(self, u: Array) -> Array:
        """(c, q, 2) derivatives of `points`."""
        found = [
            -path(1.0 - row, nu=1) if back else path(row, nu=1)
            for (path, back), row in zip(self._paths, u, strict=True)
        ]
        return np.array(found)


def _straight(path: BSpline) -> bool:
    poles = np.asarray(path.c)
    way = poles[-1] - poles[0]
    off = np.abs((poles[:, 0] - poles[0, 0]) * way[1] - (poles[:, 1] - poles[0, 1]) * way[0])
    return bool(off.max() <= 1e-12 * float(way @ way))


def outline(flats: Sequence[FlatPiece]) -> FlatPaths:
    """The outline of a loft in the plane, counterclockwise: along A, the last ruling, back along B, the first one."""
    forward = [(flat.edges[0], False) for flat in flats if flat.apex != 0]
    backward = [(flat.edges[1], True) for flat in reversed(flats) if flat.apex != 1]
    last, first = flats[-1].rulings(np.ones(1))[0], flats[0].rulings(np.zeros(1))[0]
    return FlatPaths([*forward, (_line(last), False), *backward, (_line(first[::-1]), False)])


def _line(ends: Array) -> BSpline:
    return BSpline(np.array([0.0, 0.0, 1.0, 1.0]), ends, 1)
