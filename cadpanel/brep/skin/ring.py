"""Whole faces that follow each other round a ring, in one row or several, cut across it along their parameter lines."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from OCP.TopoDS import TopoDS_Face
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from cadpanel.arrays import Array
from cadpanel.brep.faces.face_patch import equal_parts, lengths_along
from cadpanel.brep.skin.adjacency import Surface
from cadpanel.brep.skin.iso_strip import ENDS, Lane, Lanes, match_behind, match_beside, neighbours_of
from cadpanel.geometry.order import goes_backwards, order_in_space
from cadpanel.geometry.vectors import cross

# Places within this of each other along an axis of space, in mm, count as equally far along it.
LEVEL = 1.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Ring:
    """Faces that follow each other until they are back at the first.

    Attributes:
        columns: the faces side by side across the ring, all walked round it the same way, column after column.
    """

    columns: tuple[Lanes, ...]

    @property
    def length(self) -> float:
        """Of the way round, in the mean of the two edges, mm."""
        return sum(float(column.reach()[-1]) for column in self.columns)

    @property
    def longest(self) -> float:
        """Of the longest way round along a border of its faces, mm."""
        return sum(
            max(float(lengths_along(lane.patch, lane.axis, ENDS)[:, -1].max()) for lane in column.lanes)
            for column in self.columns
        )

    @property
    def width(self) -> float:
        """Mean length from one edge to the other, mm."""
        return float(np.mean([column.width for column in self.columns]))

    def cut(self, count: int, tolerance: float) -> list[list[TopoDS_Face]]:
        """The faces of each of so many panels of equal length round the ring.

        Args:
            count: of panels, 2 or more.
            tolerance: a cut as close as this to where two faces meet is made there, mm.
        """
        groups: list[list[TopoDS_Face]] = [[] for _ in range(count)]
        for column, parts, panels in self._parts(count, tolerance):
            for panel, pieces in zip(panels, column.cut(parts), strict=True):
                groups[panel] += pieces
        return groups

    def longest_panel(self, count: int, tolerance: float) -> float:
        """How long the longest of so many panels is along the longest border of its faces, mm."""
        lengths = np.zeros(count)
        for column, parts, panels in self._parts(count, tolerance):
            np.add.at(lengths, np.array(panels), column.spans(parts).max(axis=0))
        return float(lengths.max())

    def _parts(self, count: int, tolerance: float) -> Iterator[tuple[Lanes, Array, list[int]]]:
        """Every column, where it is cut, as parts of the way along it, and to which panel each piece goes."""
        step = self.length / count
        start = 0.0
        for column in self.columns:
            reach = column.reach()
            stop = start + float(reach[-1])
            cuts = np.arange(count + 1) * step
            inside = cuts[(cuts > start + tolerance) & (cuts < stop - tolerance)]
            borders = np.concatenate([[start], inside, [stop]])
            parts = np.concatenate([[0.0], equal_parts(reach, (inside - start) / reach[-1]), [1.0]])
            yield column, parts, [min(int(np.mean(places) / step), count - 1) for places in pairwise(borders)]
            start = stop


@dataclass(frozen=True, slots=True, kw_only=True)
class _Walk:
    """Faces walked round a ring.

    Attributes:
        lanes: one a face.
        beside: the pairs of face and side that lie on each other.
        behind: the face that follows each, where it ends.
    """

    lanes: tuple[Lane, ...]
    beside: frozenset[tuple[tuple[int, float], tuple[int, float]]]
    behind: dict[int, int]


def find_ring(surface: Surface) -> Ring | None:
    """The surface as a ring, or None where it is none, closes both ways, or its faces do not meet in whole borders.

    All faces of a column share their parameter round the ring, and columns meet end to end. The ring begins where two
    columns meet, or the one meets itself, at the place that comes first in space (by x, then y, then z), and runs
    counterclockwise about the axis of space about which it mostly turns.
    """
    if not all(face.patch.whole for face in surface.faces):
        return None
    for axis in (0, 1):
        walk = _walk(surface, axis)
        columns = None if walk is None else _chain(walk)
        if columns is not None:
            return Ring(columns=_begun(columns))
    return None


def _walk(surface: Surface, axis: int) -> _Walk | None:
    """All faces walked the way in which the first one is walked by a parameter; None where two do not agree on it."""
    patches = [face.patch for face in surface.faces]
    lanes = {0: Lane(patch=patches[0], axis=axis, forward=True)}
    neighbours = neighbours_of(surface)
    beside: set[tuple[tuple[int, float], tuple[int, float]]] = set()
    behind: dict[int, int] = {}
    front = [0]
    while front:
        index = front.pop()
        for other, point in neighbours[index]:
            known = lanes.get(other)
            side, end = match_beside(lanes[index], known, patches[other], point), None
            if side is not None:
                lane, own_side, other_side = side
                beside.add(((index, own_side), (other, other_side)))
            else:
                end = match_behind(lanes[index], known, patches[other], point)
                if end is None:
                    return None
                lane, own_end = end
                first, second = (index, other) if own_end == 1.0 else (other, index)
                if behind.setdefault(first, second) != second:
                    return None
            if known is None:
                lanes[other] = lane
                front.append(other)
    if len(lanes) < len(patches):
        return None
    return _Walk(lanes=tuple(lanes[index] for index in range(len(patches))), beside=frozenset(beside), behind=behind)


def _chain(walk: _Walk) -> list[Lanes] | None:
    """The columns from the first one until it is reached again; None where they do not close to one ring."""
    count = len(walk.lanes)
    pairs = np.array([(one, other) for (one, _), (other, _) in walk.beside], dtype=np.intp).reshape(-1, 2)
    graph = coo_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(count, count))
    number, labels = connected_components(graph, directed=False)
    found = [_column(walk, np.flatnonzero(labels == label).tolist()) for label in range(number)]
    columns = [column for column in found if column is not None]
    if len(columns) < number:
        return None
    if number == 1:
        return columns if not walk.behind and all(lane.patch.closed(lane.axis) for lane in walk.lanes) else None
    follows = {(int(labels[one]), int(labels[other])) for one, other in walk.behind.items()}
    if len(walk.behind) < count or len(follows) != number:
        return None
    after, chain = dict(follows), [0]
    while (label := after[chain[-1]]) not in chain:
        chain.append(label)
    return [columns[label] for label in chain] if len(chain) == number and label == 0 else None


def _column(walk: _Walk, members: Sequence[int]) -> Lanes | None:
    """Faces side by side; None where they are no strip between two long edges."""
    place = {index: position for position, index in enumerate(members)}
    joints = sorted(
        ((place[one], side), (place[other], other_side))
        for (one, side), (other, other_side) in walk.beside
        if one in place
    )
    joined = {end for joint in joints for end in joint}
    outer = [(index, side) for index in range(len(members)) for side in (0.0, 1.0) if (index, side) not in joined]
    lanes = tuple(walk.lanes[index] for index in members)
    if len(outer) != 2 or lanes[0].patch.closed(1 - lanes[0].axis):
        return None
    return Lanes(lanes=lanes, outer=tuple(outer), joints=tuple(joints))


def _begun(columns: Sequence[Lanes]) -> tuple[Lanes, ...]:
    """The same ring begun where it comes first in space, and walked counterclockwise."""
    line = np.concatenate([column.middles(np.linspace(0.0, 1.0, 33)[:-1]) for column in columns])
    about = cross(line - line.mean(axis=0), np.roll(line, -1, axis=0) - line.mean(axis=0)).sum(axis=0)
    if goes_backwards(about):
        columns = [column.turned() for column in reversed(columns)]
    joints = np.concatenate([column.middles(ENDS[:1]) for column in columns])
    first = int(order_in_space(joints, LEVEL)[0])
    return (*columns[first:], *columns[:first])
