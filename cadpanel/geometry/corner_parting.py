"""Panels that meet without a seam, in a corner or along a part of an edge, held apart where their sheets would meet.

Four walls that come together in a corner do not pass through one line, unless the panels are tangent to one cone
there: two of the four panels, opposite each other, would share a sliver inside the sheet. Both are set back a little.
Millimetres.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array
from cadpanel.geometry.boxes import meeting
from cadpanel.geometry.curve_pieces import CurvePieces, together
from cadpanel.geometry.panel import CutPlane, Panel
from cadpanel.geometry.vectors import unit

Walls = dict[str, CutPlane]
APART = 1e-9
"""Panels that reach behind a wall by less than this, mm, touch it."""
PREFERRED = 2.0
"""Of the walls that could be set back the first is, unless it had to go this many times as far as the best: where a
corner is symmetric, rounding must not choose."""


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


def part_at_corners(
    cut: list[Panel],
    shapes: Sequence[Panel],
    walls: Sequence[Walls],
    seams: Collection[tuple[int, int]],
    depth: float,
) -> None:
    """Set panels back, in `cut` and `walls`, by as much as others without a seam between them reach behind their walls.

    A panel is behind all of its own walls, so two panels are apart where one is beyond a wall of the other. Panels that
    reach farther than a sheet's thickness into each other are left as they are: no wall of theirs parts them.

    Args:
        cut: the panels as they are cut so far.
        shapes: the same before they were cut.
        walls: of each panel, by its edges.
        seams: pairs of panels that have a seam.
        depth: the other face of a sheet is `offset(depth)`.
    """
    extents = [_extent(shape, depth) for shape in cut]
    for pair in _unjoined(cut, extents, set(map(frozenset, seams))):
        # Half of the way by a wall of the one, the rest by one of the other: no joint opens more than it must.
        for order, share in ((pair, 0.5), (pair[::-1], 1.0)):
            moved = _set_back(order, share, shapes, walls, extents, depth)
            if moved is None:
                break
            cut[moved] = shapes[moved].cut_back(walls[moved], depth)
            extents[moved] = _extent(cut[moved], depth)


def _set_back(
    pair: tuple[int, int],
    share: float,
    shapes: Sequence[Panel],
    walls: Sequence[Walls],
    extents: Sequence[_Extent],
    depth: float,
) -> int | None:
    """Move a wall of either panel by a share of how far the other is behind it; the panel, None if they are apart."""
    one, other = pair
    if _beside(extents[one], extents[other]):
        return None
    planes = [(i, edge, plane) for i in pair for edge, plane in _all_walls(shapes[i], walls[i]).items()]
    behind = np.array([_behind(plane, extents[other if i == one else one]) for i, _, plane in planes])
    if behind.min() <= APART or behind.min() > abs(depth):
        return None
    chosen = int(np.flatnonzero(behind <= PREFERRED * behind.min())[0])
    panel, edge, plane = planes[chosen]
    walls[panel][edge] = plane.moved(-share * float(behind[chosen]))
    return panel


def _extent(shape: Panel, depth: float) -> _Extent:
    faces = (shape, shape.offset(depth))
    corners = np.concatenate([face.corners().reshape(-1, 3) for face in faces])
    return _Extent(corners, together([face.arcs() for face in faces]))


def _unjoined(
    cut: Sequence[Panel], extents: Sequence[_Extent], joined: Collection[frozenset[int]]
) -> list[tuple[int, int]]:
    """Pairs without a seam whose boxes meet, in the order of their names: that of the list changes nothing."""
    axes = np.concatenate([np.eye(3), -np.eye(3)])
    reach = np.array([extent.least(axes) for extent in extents]).reshape(-1, 6)
    pairs = [pair for pair in meeting(reach[:, :3], -reach[:, 3:], APART) if frozenset(pair) not in joined]
    named = [(i, j) if cut[i].name < cut[j].name else (j, i) for i, j in pairs]
    return sorted(named, key=lambda pair: (cut[pair[0]].name, cut[pair[1]].name))


def _beside(one: _Extent, other: _Extent) -> bool:
    """Whether two sheets lie on either side of a plane square to the way from one to the other."""
    way = unit(other.corners.mean(axis=0) - one.corners.mean(axis=0))[None]
    return bool(other.least(way)[0] + one.least(-way)[0] >= -APART)


def _all_walls(shape: Panel, walls: Walls) -> Walls:
    """The walls of a panel, edge by edge, those included that stand where the fit has cut it."""
    names = (
        ("end 0", "end 1", "side 0", "side 1")
        if shape.four_sided
        else tuple(f"edge {i}" for i in range(shape.corners().shape[1]))
    )
    free = {name: shape.edge(name) for name in names if name not in walls}
    own = {name: CutPlane(point=edge.corners[0], normal=edge.outward) for name, edge in free.items()}
    return {name: walls[name] if name in walls else own[name] for name in names}


def _behind(plane: CutPlane, extent: _Extent) -> float:
    """By how much a panel reaches behind a wall of another, mm."""
    return float(plane.point @ plane.normal - extent.least(plane.normal[None])[0])
