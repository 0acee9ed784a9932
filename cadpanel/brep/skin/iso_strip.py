"""Whole faces that lie side by side along a strip and share its parameter: they can be cut without any boolean.

A lane is a face walked along the strip by one of its parameters. Where neighbouring lanes have the same point at the
same part of their ranges, all along the border between them, cutting every lane at one part of its range gives one
continuous cut, and each piece is exactly the surface that it was.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from OCP.TopoDS import TopoDS_Face
from scipy.interpolate import PchipInterpolator

from cadpanel.arrays import Array
from cadpanel.brep.faces.face_patch import INTERVALS, Patch, equal_parts, lengths_along, rectangle
from cadpanel.brep.skin.adjacency import Surface
from cadpanel.brep.skin.strip_direction import turning_angles, way_along
from cadpanel.geometry.order import goes_backwards
from cadpanel.geometry.vectors import norm

# Parameter lines each way on which a face's curvature is looked at.
MEASURED_LINES = 17
# How closely neighbouring lanes must agree at equal parts, mm.
COMMON = 1e-3
ENDS = np.array([0.0, 1.0])


@dataclass(frozen=True, slots=True, kw_only=True)
class Lane:
    """A face along a strip.

    Attributes:
        patch: a whole patch.
        axis: its parameter along the strip, 0 for u and 1 for v.
        forward: whether that parameter grows along the strip.
    """

    patch: Patch
    axis: int
    forward: bool

    def border(self, across: float, parts: Array) -> Array:
        """(k, 3) points of the border at `across` (0 or 1) at (k,) parts of the way along the strip."""
        return self.patch.points(self.patch.at(self.axis, self.own(parts), np.full(len(parts), across)))

    def end(self, part: float, across: Array) -> Array:
        """(k, 3) points of the end at `part` (0 or 1) of the way along the strip, at (k,) parts of the way across."""
        return self.patch.points(self.patch.at(self.axis, self.own(np.full(len(across), part)), across))

    def turned(self) -> Lane:
        """The same lane walked the other way."""
        return replace(self, forward=not self.forward)

    def own(self, parts: Array) -> Array:
        """Parts of the way along the strip as parts of the lane's own range."""
        return parts if self.forward else 1.0 - parts


@dataclass(frozen=True, slots=True, kw_only=True)
class Lanes:
    """Lanes side by side.

    Attributes:
        lanes: one a face, in the surface's order.
        outer: the strip's long edges: lane and side (0.0 or 1.0) of each; two of them, or none where it is a tube.
        joints: the pairs of lane and side that lie on each other.
    """

    lanes: tuple[Lane, ...]
    outer: tuple[tuple[int, float], ...]
    joints: tuple[tuple[tuple[int, float], tuple[int, float]], ...] = ()

    def edges(self, parts: Array) -> Array:
        """(2, k, 3) points of the two long edges at (k,) parts of the way."""
        return np.array([self.lanes[lane].border(side, parts) for lane, side in self.outer])

    def reach(self) -> Array:
        """(INTERVALS + 1,) mean length of the long edges up to even parts of the way, mm."""
        edges = []
        for lane, side in self.outer:
            steps = np.diff(lengths_along(self.lanes[lane].patch, self.lanes[lane].axis, np.array([side]))[0])
            edges.append(np.concatenate([[0.0], np.cumsum(steps if self.lanes[lane].forward else steps[::-1])]))
        return np.asarray(np.mean(edges, axis=0), dtype=np.float64)

    def cut(self, parts: Array) -> list[list[TopoDS_Face]]:
        """The faces between (n + 1,) rising parts of the way, from 0 to 1: n groups, each with one face a lane."""
        groups: list[list[TopoDS_Face]] = [[] for _ in parts[1:]]
        for lane in self.lanes:
            low, high = lane.patch.bounds[lane.axis]
            other_low, other_high = lane.patch.bounds[1 - lane.axis].tolist()
            places = (low + lane.own(parts) * (high - low)).tolist()
            for group, first, last in zip(groups, places, places[1:], strict=False):
                along = (min(first, last), max(first, last))
                ranges = (along, (other_low, other_high)) if lane.axis == 0 else ((other_low, other_high), along)
                group.append(rectangle(lane.patch, *ranges))
        return groups

    def spans(self, parts: Array) -> Array:
        """(2 lanes, n) lengths along both borders of every lane between (n + 1,) rising parts of the way, mm."""
        even = np.linspace(0.0, 1.0, INTERVALS + 1)
        spans = []
        for lane in self.lanes:
            places = lane.own(parts)
            for reach in lengths_along(lane.patch, lane.axis, ENDS):
                spans.append(np.abs(np.diff(PchipInterpolator(even, reach)(places))))
        return np.array(spans)

    def turned(self) -> Lanes:
        """The same lanes walked the other way."""
        return replace(self, lanes=tuple(lane.turned() for lane in self.lanes))

    def middles(self, parts: Array) -> Array:
        """(k, 3) points midway between the two long edges at (k,) parts of the way along them."""
        edges = [self.lanes[lane].border(side, parts) for lane, side in self.outer]
        return np.asarray(np.mean(edges, axis=0), dtype=np.float64)

    @property
    def width(self) -> float:
        """How far it is from one long edge to the other, in the mean of both ends, mm."""
        return sum(float(lengths_along(one.patch, 1 - one.axis, ENDS)[:, -1].mean()) for one in self.lanes)

    def order(self) -> list[tuple[int, bool]] | None:
        """The lanes in their order across the strip, each with whether it is walked along its other parameter.

        None where they are no chain from one long edge to the other.
        """
        if len(self.outer) != 2:
            return None
        joined = {first: second for pair in self.joints for first, second in (pair, pair[::-1])}
        order = []
        index, side = self.outer[0]
        for _ in self.lanes:
            order.append((index, side == 0.0))
            exit_side = (index, 1.0 - side)
            if exit_side not in joined:
                break
            index, side = joined[exit_side]
        return order if len(order) == len(self.lanes) and exit_side == self.outer[1] else None

    def at_lengths(self, parts: Array) -> Array:
        """Where, as parts of the way, (k,) parts of the long edges' mean length are reached."""
        return equal_parts(self.reach(), parts)


def find_lanes(surface: Surface) -> Lanes | None:
    """The surface as lanes side by side; None where faces are trimmed, share no parameter, or run from pole to pole.

    The strip runs in the direction in which normals turn slowly; where both turn alike, in the longer one. It begins at
    the end that comes first along the axis of space which it follows most.

    Args:
        surface: any.
    """
    patches = [face.patch for face in surface.faces]
    if not all(patch.whole for patch in patches):
        return None
    rates = [_turning_rates(patch) for patch in patches]
    first = max(range(len(patches)), key=lambda index: max(rates[index][0]))
    axis = way_along(*rates[first])
    lanes: dict[int, Lane] = {first: Lane(patch=patches[first], axis=axis, forward=True)}
    neighbours = neighbours_of(surface)
    joints: set[tuple[tuple[int, float], tuple[int, float]]] = set()
    front = [first]
    while front:
        index = front.pop()
        for other, point in neighbours[index]:
            found = match_beside(lanes[index], lanes.get(other), patches[other], point)
            if found is None:
                return None
            lane, own_side, other_side = found
            if other not in lanes:
                lanes[other] = lane
                front.append(other)
            joints.add(((index, own_side), (other, other_side)))
    if len(lanes) < len(patches):
        return None
    ordered = tuple(lanes[index] for index in range(len(patches)))
    joined = {end for joint in joints for end in joint}
    outer = [(index, side) for index in range(len(patches)) for side in (0.0, 1.0) if (index, side) not in joined]
    if len(ordered) == 1 and ordered[0].patch.closed(1 - ordered[0].axis):
        outer = []
    if len(outer) not in (0, 2):
        return None
    chain = Lanes(lanes=ordered, outer=tuple(outer), joints=tuple(sorted(joints)))
    # From pole to pole there is no length along which a strip could run.
    return None if outer and chain.reach()[-1] <= COMMON else _forwards(chain)


def _turning_rates(patch: Patch) -> tuple[tuple[float, float], tuple[float, float]]:
    """By how much normals turn per length along u and v, radians a mm, and how long the patch is along them, mm."""
    parts = np.linspace(0.0, 1.0, MEASURED_LINES)
    middles = 0.5 * (parts[1:] + parts[:-1])
    rates, lengths = [], []
    for axis in (0, 1):
        parameters = patch.at(axis, middles[None, :], middles[:, None])
        points, normals = patch.points(parameters), patch.normals(parameters)
        length = norm(np.diff(points, axis=1)).sum(axis=1)
        rates.append(float(turning_angles(normals).sum() / max(length.sum(), np.finfo(float).tiny)))
        lengths.append(float(length.mean()))
    return (rates[0], rates[1]), (lengths[0], lengths[1])


def neighbours_of(surface: Surface) -> list[list[tuple[int, Array]]]:
    """For each face the others that it touches, each with a point of the edge between them."""
    neighbours: list[list[tuple[int, Array]]] = [[] for _ in surface.faces]
    for contact in surface.contacts:
        first, second = contact.faces
        neighbours[first].append((second, contact.point))
        neighbours[second].append((first, contact.point))
    return neighbours


def match_beside(lane: Lane, known: Lane | None, patch: Patch, point: Array) -> tuple[Lane, float, float] | None:
    """The neighbour as a lane, and the sides on which the two meet with the same points at the same parts.

    Only borders that pass by the (3,) point are looked at: two faces may also meet elsewhere, in a knife edge.
    """
    parts = np.linspace(0.0, 1.0, MEASURED_LINES)
    for own_side in (0.0, 1.0):
        border = lane.border(own_side, parts)
        if not _passes(border, point):
            continue
        for candidate in _candidates(known, patch):
            for side in (0.0, 1.0):
                if norm(candidate.border(side, parts) - border).max() <= COMMON:
                    return candidate, own_side, side
    return None


def match_behind(lane: Lane, known: Lane | None, patch: Patch, point: Array) -> tuple[Lane, float] | None:
    """The neighbour as a lane that goes on from this one, and at which end of this one the two meet.

    Their ends have the same points at the same parts. Only an end that passes by the (3,) point is looked at.
    """
    parts = np.linspace(0.0, 1.0, MEASURED_LINES)
    for own_end in (0.0, 1.0):
        end = lane.end(own_end, parts)
        if not _passes(end, point):
            continue
        for candidate in _candidates(known, patch):
            other = candidate.end(1.0 - own_end, parts)
            if min(norm(other - end).max(), norm(other[::-1] - end).max()) <= COMMON:
                return candidate, own_end
    return None


def _passes(border: Array, point: Array) -> bool:
    return bool(norm(border - point).min() <= norm(np.diff(border, axis=0)).max())


def _candidates(known: Lane | None, patch: Patch) -> list[Lane]:
    return [known] if known else [Lane(patch=patch, axis=a, forward=f) for a in (0, 1) for f in (True, False)]


def _forwards(lanes: Lanes) -> Lanes:
    """The lanes walked along the axis of space that they follow most."""
    ends = np.array(
        [
            [lane.border(side, np.array([part])).mean(axis=0) for part in (0.0, 1.0)]
            for lane in lanes.lanes
            for side in (0.0, 1.0)
        ]
    ).mean(axis=0)
    return lanes.turned() if goes_backwards(ends[1] - ends[0], COMMON) else lanes
