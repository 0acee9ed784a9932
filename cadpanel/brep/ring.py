"""Whole faces that follow each other round a ring, cut across it along their own parameter lines."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from OCP.TopoDS import TopoDS_Face

from cadpanel.brep.connect import Surface, levels
from cadpanel.brep.lanes import Lane, Lanes, find_lanes
from cadpanel.brep.patch import equal_parts, lengths_along, rectangle
from cadpanel.reference.polyline import cross

Array = NDArray[np.float64]

# Places within this of each other along an axis of space, in mm, count as equally far along it.
LEVEL = 1.0
ENDS = np.array([0.0, 1.0])


@dataclass(frozen=True, slots=True, kw_only=True)
class Link:
    """One face of a ring: a lane across it, walked along the ring from its side 0 to its side 1, or back."""

    lane: Lane
    forward: bool

    @property
    def around(self) -> int:
        """The parameter that runs round the ring, 0 for u and 1 for v."""
        return 1 - self.lane.axis

    @property
    def reach(self) -> Array:
        """(INTERVALS + 1,) mean length of its two borders up to even parts of the way round it, mm."""
        reach = lengths_along(self.lane.patch, self.around, ENDS).mean(axis=0)
        return np.asarray(reach if self.forward else reach[-1] - reach[::-1])

    def middles(self, parts: Array) -> Array:
        """(k, 3) points midway across it at (k,) parts of the way round it."""
        patch = self.lane.patch
        return patch.points(patch.at(self.around, self._own(parts), np.full(len(parts), 0.5)))

    def between(self, first: float, last: float) -> TopoDS_Face:
        """What lies between two parts of the way round it."""
        low, high = self.lane.patch.bounds[self.around]
        start, stop = sorted((low + self._own(np.array([first, last])) * (high - low)).tolist())
        across = tuple(self.lane.patch.bounds[self.lane.axis].tolist())
        ranges = ((start, stop), across) if self.around == 0 else (across, (start, stop))
        return rectangle(self.lane.patch, *ranges)

    def _own(self, parts: Array) -> Array:
        return parts if self.forward else 1.0 - parts


@dataclass(frozen=True, slots=True, kw_only=True)
class Ring:
    """Faces that follow each other until they are back at the first."""

    links: tuple[Link, ...]

    @property
    def length(self) -> float:
        """Of the way round, in the mean of the two edges, mm."""
        return sum(float(link.reach[-1]) for link in self.links)

    @property
    def width(self) -> float:
        """Mean length from one edge to the other, mm."""
        widths = [float(lengths_along(link.lane.patch, link.lane.axis, ENDS)[:, -1].mean()) for link in self.links]
        return float(np.mean(widths))

    def cut(self, count: int, tolerance: float) -> list[list[TopoDS_Face]]:
        """The faces of each of so many panels of equal length round the ring.

        Args:
            count: of panels, 2 or more.
            tolerance: a cut as close as this to where two faces meet is made there, mm.
        """
        groups: list[list[TopoDS_Face]] = [[] for _ in range(count)]
        step = self.length / count
        start = 0.0
        for link in self.links:
            reach = link.reach
            stop = start + float(reach[-1])
            cuts = np.arange(count + 1) * step
            inside = cuts[(cuts > start + tolerance) & (cuts < stop - tolerance)]
            borders = np.concatenate([[start], inside, [stop]])
            parts = np.concatenate([[0.0], equal_parts(reach, (inside - start) / reach[-1]), [1.0]])
            for places, (first, last) in zip(pairwise(borders), pairwise(parts.tolist()), strict=True):
                groups[min(int(np.mean(places) / step), count - 1)].append(link.between(first, last))
            start = stop
        return groups


def find_ring(surface: Surface) -> Ring | None:
    """The surface as a ring, or None where it is none, closes both ways, or its faces share no parameter across it.

    The ring begins where two faces meet, or the one meets itself, at the place that comes first in space (by x, then y,
    then z), and runs counterclockwise about the axis of space about which it mostly turns.
    """
    for crosswise in (False, True):
        lanes = find_lanes(surface, crosswise=crosswise)
        links = None if lanes is None or lanes.outer else _chain(lanes)
        if links is not None:
            return None if any(link.lane.patch.closed(link.lane.axis) for link in links) else Ring(links=_begun(links))
    return None


def _chain(lanes: Lanes) -> list[Link] | None:
    """Lanes side by side, from the first one until it is reached again; None where that leaves some out."""
    joined = {first: second for pair in lanes.joints for first, second in (pair, pair[::-1])}
    links = []
    index, side = 0, 0.0
    for _ in lanes.lanes:
        links.append(Link(lane=lanes.lanes[index], forward=side == 0.0))
        index, side = joined.get((index, 1.0 - side), (index, side))
        if index == 0:
            break
    return links if len(links) == len(lanes.lanes) and index == 0 else None


def _begun(links: Sequence[Link]) -> tuple[Link, ...]:
    """The same ring begun where it comes first in space, and walked counterclockwise."""
    line = np.concatenate([link.middles(np.linspace(0.0, 1.0, 33)[:-1]) for link in links])
    about = cross(line - line.mean(axis=0), np.roll(line, -1, axis=0) - line.mean(axis=0)).sum(axis=0)
    if about[np.abs(about).argmax()] < 0.0:
        links = [Link(lane=link.lane, forward=not link.forward) for link in reversed(links)]
    joints = np.concatenate([link.middles(ENDS[:1]) for link in links])
    first = int(np.lexsort([levels(joints[:, axis], LEVEL) for axis in (2, 1, 0)])[0])
    return (*links[first:], *links[:first])
