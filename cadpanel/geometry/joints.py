"""Sheets cut back from their seams, so that a joint of one width stands between any two neighbours. Millimetres.

Every seam has one plane in the middle of its joint, which both neighbours' walls are parallel to: each keeps behind it
by half of the joint, so two neighbours never share volume. Panels that meet in a corner only are held apart, too: where
four walls do not pass through one line, two opposite panels would meet inside the sheet, and one is set back.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array
from cadpanel.geometry.curve_pieces import CurvePieces, together
from cadpanel.geometry.edge_planes import SeamEdges, farthest, seam_plane, turned_round
from cadpanel.geometry.panel import CutPlane, Panel
from cadpanel.geometry.vectors import unit

Walls = dict[str, CutPlane]
APART = 1e-9
"""Panels that reach behind a wall by less than this, mm, touch it."""
PREFERRED = 2.0
"""Of the walls that could be set back the first is, unless it had to go this many times as far as the best: where a
corner is symmetric, rounding must not choose."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Jointed:
    """Panels cut back from their seams.

    Attributes:
        shapes: the panels.
        planes: of each seam, in the middle of its joint, the normal out of the seam's first panel.
        recut: how far from its plane the farthest corner of each seam's edges was, mm: so far, at most, the fit's edges
            were moved to lie in one plane.
    """

    shapes: tuple[Panel, ...]
    planes: tuple[CutPlane, ...]
    recut: tuple[float, ...]


def cut_to_seams(shapes: Sequence[Panel], seams: Sequence[SeamEdges], joint: float, depth: float) -> Jointed:
    """Cut panels back from their seams.

    Args:
        shapes: as they were fitted.
        seams: which of their edges meet.
        joint: clear width between two sheets, mm.
        depth: the other face of a sheet is `offset(depth)`, mm.

    Raises:
        PanelError: nothing is left of a panel, or two fold back on each other.
    """
    planes = seam_planes(shapes, seams)
    walls = walls_of(len(shapes), seams, planes, joint)
    cut = [shape.cut_back(own, depth) if own else shape for shape, own in zip(shapes, walls, strict=True)]
    _set_back(cut, shapes, walls, seams, depth)
    recut = tuple(
        max(farthest(plane, shapes[panel], edge) for panel, edge in zip(seam.panels, seam.edges, strict=True))
        for seam, plane in zip(seams, planes, strict=True)
    )
    return Jointed(shapes=tuple(cut), planes=planes, recut=recut)


def seam_planes(shapes: Sequence[Panel], seams: Sequence[SeamEdges]) -> tuple[CutPlane, ...]:
    """The plane of each seam, its normal out of the seam's first panel.

    Raises:
        PanelError: two panels fold back on each other.
    """
    return tuple(seam_plane((shapes[seam.panels[0]], shapes[seam.panels[1]]), seam.edges) for seam in seams)


def walls_of(count: int, seams: Sequence[SeamEdges], planes: Sequence[CutPlane], joint: float) -> list[Walls]:
    """The walls of each of `count` panels by its edges: half a joint behind the seams' planes."""
    walls: list[Walls] = [{} for _ in range(count)]
    for seam, plane in zip(seams, planes, strict=True):
        for panel, edge, own in zip(seam.panels, seam.edges, (plane, turned_round(plane)), strict=True):
            walls[panel][edge] = own.moved(-0.5 * joint)
    return walls


@dataclass(frozen=True, slots=True)
class _Extent:
    """All that can be farthest out on a sheet, whichever way: its corners (n, 3) and its bent edges."""

    corners: Array
    arcs: CurvePieces

    def least(self, directions: Array) -> Array:
        """(d,) the least inner product with each direction (d, 3)."""
        straight = (directions @ self.corners.T).min(axis=1)
        bent = self.arcs.reach(directions)[0].min(axis=1, initial=np.inf)
        return np.asarray(np.minimum(straight, bent))


def _extent(shape: Panel, depth: float) -> _Extent:
    faces = (shape, shape.offset(depth))
    corners = np.concatenate([face.corners().reshape(-1, 3) for face in faces])
    return _Extent(corners, together([face.arcs() for face in faces]))


def _set_back(
    cut: list[Panel], shapes: Sequence[Panel], walls: Sequence[Walls], seams: Sequence[SeamEdges], depth: float
) -> None:
    """Part the panels that meet in a corner only, in `cut`: one is set back by as much as the other is behind its wall.

    A panel is behind all of its own walls, so two panels are apart where one is beyond a wall of the other.
    """
    names = [shape.name for shape in shapes]
    # By their names, so that the order of the panels in the list changes nothing.
    place = {name: i for i, name in enumerate(names)}
    pairs = [(place[a], place[b]) for a, b in sorted(sorted((names[i], names[j])) for i, j in _opposite(seams))]
    extents = {i: _extent(cut[i], depth) for i in sorted({i for pair in pairs for i in pair})}
    for pair in pairs:
        if _beside(*(extents[i] for i in pair)):
            continue
        ways = [(i, edge) for i in pair for edge in sorted(walls[i])]
        behind = np.concatenate([_behind(walls[i], extents[j]) for i, j in (pair, pair[::-1])])
        if behind.min() <= APART or behind.min() > abs(depth):
            continue
        chosen = int(np.flatnonzero(behind <= PREFERRED * behind.min())[0])
        panel, edge = ways[chosen]
        walls[panel][edge] = walls[panel][edge].moved(-float(behind[chosen]))
        cut[panel] = shapes[panel].cut_back(walls[panel], depth)
        extents[panel] = _extent(cut[panel], depth)


def _beside(one: _Extent, other: _Extent) -> bool:
    """Whether two sheets lie on either side of a plane square to the way from one to the other."""
    way = unit(other.corners.mean(axis=0) - one.corners.mean(axis=0))[None]
    return bool(other.least(way)[0] + one.least(-way)[0] >= -APART)


def _behind(walls: Walls, extent: _Extent) -> Array:
    """By how much a panel reaches behind each wall of another, in the order of their edges' names, mm."""
    planes = [walls[edge] for edge in sorted(walls)]
    normals = np.array([plane.normal for plane in planes])
    reaches = np.array([plane.point @ plane.normal for plane in planes])
    return np.asarray(reaches - extent.least(normals))


def _opposite(seams: Sequence[SeamEdges]) -> Iterator[tuple[int, int]]:
    """Pairs of panels with a neighbour in common and no seam of their own."""
    neighbours: dict[int, set[int]] = defaultdict(set)
    for seam in seams:
        first, second = seam.panels
        neighbours[first].add(second)
        neighbours[second].add(first)
    for panel, own in neighbours.items():
        beyond = set[int]().union(*(neighbours[other] for other in own)) - own
        yield from ((panel, other) for other in beyond if other > panel)
