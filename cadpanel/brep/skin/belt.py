"""A ring of any faces: its two closed edges, and planes across it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from OCP.TopoDS import TopoDS_Face
from scipy.spatial import cKDTree

from cadpanel.arrays import Array
from cadpanel.brep.skin.adjacency import Surface
from cadpanel.brep.skin.cut_planes import Cuts
from cadpanel.brep.skin.ring import LEVEL
from cadpanel.brep.skin.split_by_planes import pieces_of
from cadpanel.brep.skin.strip import NO_CHORD, REACH
from cadpanel.errors import ReferenceFileError
from cadpanel.geometry.order import goes_backwards, order_in_space
from cadpanel.geometry.polyline import arc_length
from cadpanel.geometry.vectors import cross, norm, unit
from cadpanel.reference.model import RawPanel
from cadpanel.reference.outline import find_loops

# Points on each edge of the faces; along the first edge of the ring; and of the other one among which the nearest are
# sought.
ON_AN_EDGE, POINTS, FINE = 2049, 1024, 8192
# A hole in a plate makes no ring of it: the shorter edge of one has at least this part of the other's length.
ALIKE = 0.5
BOTH = 2


@dataclass(frozen=True, slots=True, kw_only=True)
class Belt:
    """A ring between two closed edges, begun where an edge of its faces ends that comes first in space.

    Attributes:
        edges: (2, POINTS + 1, 3) points of the two edges that lie across from each other, mm; the last is the first.
        reach: (POINTS + 1,) mean length of the two edges up to there, mm.
        girth: how far it is across, mm.
    """

    edges: Array
    reach: Array
    girth: float

    @property
    def length(self) -> float:
        """Mean length of the two edges, mm."""
        return float(self.reach[-1])

    def longest_part(self, count: int) -> float:
        """How long the longest of so many equal parts is along either edge, mm."""
        places = np.linspace(0.0, self.length, count + 1)
        along = (np.interp(places, self.reach, arc_length(edge)) for edge in self.edges)
        return max(float(np.diff(reach).max()) for reach in along)

    def cuts(self, count: int, start: float) -> Cuts:
        """The planes at equal parts of the length, from a place on: 0 is the first plane, 1.5 between the next two.

        Returns:
            All of them, the one first that follows that place.
        """
        middle = self.edges.mean(axis=0)[:-1]
        places = self.reach[:-1] / self.length * count
        order = np.argsort(np.mod(places - start, count), kind="stable")
        numbers = (np.ceil(start) + np.arange(count)) % count
        points = self._at(numbers / count)
        step = self.length / POINTS
        before, after = (self._at(numbers / count + side * step / self.length) for side in (-1.0, 1.0))
        along = unit(unit(after - before).sum(axis=0))
        chords = points[1] - points[0]
        across = np.where(norm(chords)[:, None] > NO_CHORD * self.girth, unit(chords), 0.0)
        return Cuts(
            origins=points.mean(axis=0),
            normals=unit(along - np.sum(along * across, axis=1, keepdims=True) * across),
            reach=np.full(count, REACH * self.girth),
            line=middle[order],
            places=np.mod(places - start, count)[order] + 1.0 - (np.ceil(start) - start),
        )

    def place_of(self, point: Array, count: int) -> float:
        """The place among so many planes of what lies nearest to a point (3,)."""
        middle = self.edges.mean(axis=0)[:-1]
        return float(self.reach[norm(middle - point).argmin()] / self.length * count)

    def _at(self, parts: Array) -> Array:
        """(2, k, 3) points of the edges at (k,) parts of the length."""
        where = np.interp(np.mod(parts, 1.0) * self.length, self.reach, np.arange(len(self.reach)))
        low = np.minimum(where.astype(np.intp), POINTS - 1)
        share = (where - low)[:, None]
        return np.asarray((1.0 - share) * self.edges[:, low] + share * self.edges[:, low + 1])

    def cut(self, surface: Surface, count: int, source: str) -> list[list[TopoDS_Face]]:
        """The faces of each of so many panels of equal length round the ring.

        Args:
            surface: the ring.
            count: of panels, 2 or more.
            source: the reference's name.

        Raises:
            ReferenceFileError: the kernel leaves a face uncut, or a panel would have no faces.
        """
        groups: list[list[TopoDS_Face]] = [[] for _ in range(count)]
        for face in surface.faces:
            # Planes are counted from where the face begins: at its own seam, or across from its middle.
            patch = face.patch
            closed = [axis for axis in (0, 1) if patch.whole and patch.closed(axis)]
            axis = closed[0] if closed else 0
            probe = patch.points(patch.at(axis, np.array(0.0 if closed else 0.5), np.array(0.5)))
            start = (self.place_of(probe, count) + (0.0 if closed else 0.5 * count)) % count
            for place, piece in pieces_of(patch, self.cuts(count, start), f"face {face.number} of '{source}'"):
                groups[(int(np.ceil(start)) + place - 1) % count].append(piece)
        if not all(groups):
            raise ReferenceFileError(
                f"Panel {groups.index([]) + 1} of {count} round the surface of {surface.numbers} of '{source}' would "
                "have no faces: give fewer panels."
            )
        return groups


def find_belt(surface: Surface, source: str, tolerance: float) -> Belt | None:
    """The surface as a ring between two closed edges; None where it has others, or is a plate with a hole.

    Args:
        surface: any.
        source: the reference's name.
        tolerance: how far faces that meet may lie apart, mm.
    """
    raw = RawPanel(name=surface.name, faces=tuple(face.samples for face in surface.faces))
    loops = find_loops(raw, source, tolerance, ON_AN_EDGE)
    if len(loops) != BOTH:
        return None
    lines = [np.concatenate([*(edge[:-1] for edge in loop), loop[0][:1]]) for loop in loops]
    lengths = [float(arc_length(line)[-1]) for line in lines]
    if min(lengths) < ALIKE * max(lengths):
        return None
    about = [_about(line) for line in lines]
    if goes_backwards(about[0]):
        lines[0], about[0] = lines[0][::-1], -about[0]
    if about[0] @ about[1] < 0.0:
        lines[1] = lines[1][::-1]
    ends = [np.array([edge[0] for edge in loop]) for loop in loops]
    edges = _across(lines, ends)
    reach = np.mean([arc_length(edge) for edge in edges], axis=0)
    points = np.concatenate([face.samples.points for face in surface.faces])
    bulge = 2.0 * float(np.max(cKDTree(edges.mean(axis=0)).query(points)[0]))
    belt = Belt(edges=edges, reach=reach, girth=max(bulge, float(norm(edges[1] - edges[0]).max())))
    return belt if belt.length >= belt.girth else None


def _about(line: Array) -> Array:
    """(3,) about which axis a closed line turns, twice the area that it encloses."""
    own = line - line.mean(axis=0)
    return np.asarray(cross(own[:-1], own[1:]).sum(axis=0))


def _across(lines: Sequence[Array], ends: Sequence[Array]) -> Array:
    """(2, POINTS + 1, 3) even points of a closed line and those of another one nearest to them, never turning back.

    They begin at the end of an edge that comes first in space; `ends` are (e, 3) those on each line.
    """
    every = np.concatenate(ends)
    start = every[int(order_in_space(every, LEVEL)[0])]
    begun = [_begun(line, own, start) for line, own in zip(lines, ends, strict=True)]
    one, other = _even(begun[0], POINTS), _even(begun[1], FINE)
    around = other[:-1]
    nearest = np.asarray(cKDTree(around).query(one[:-1])[1])
    # A parabola through the squares of the distances to three points tells where between them the nearest is.
    beside = [np.sum((around[(nearest + by) % FINE] - one[:-1]) ** 2, axis=1) for by in (-1, 0, 1)]
    bend = np.maximum(beside[0] - 2.0 * beside[1] + beside[2], np.finfo(float).tiny)
    exact = nearest + np.clip(0.5 * (beside[0] - beside[2]) / bend, -0.5, 0.5)
    # Counted on round the line from its beginning, which lies across from that of the first one.
    steps = np.mod(np.diff(exact) + FINE / 2, FINE) - FINE / 2
    reached = np.clip(np.maximum.accumulate(np.concatenate([[0.0], np.cumsum(steps)])), 0.0, FINE)
    places = np.concatenate([reached, [FINE]])
    counted = np.arange(FINE + 1.0)
    return np.array([one, np.stack([np.interp(places, counted, other[:, axis]) for axis in range(3)], axis=-1)])


def _begun(line: Array, ends: Array, point: Array) -> Array:
    """A closed line begun at the point of it that is nearest to another one, or at an end that is as near."""
    distances = norm(line[:-1] - point)
    first = int(distances.argmin())
    nearest_end = ends[norm(ends - point).argmin()]
    if norm(nearest_end - point) <= distances[first] + LEVEL:
        first = int(norm(line[:-1] - nearest_end).argmin())
    return np.concatenate([line[first:-1], line[: first + 1]])


def _even(line: Array, count: int) -> Array:
    """(count + 1, 3) even points along a line."""
    lengths = arc_length(line)
    places = np.linspace(0.0, lengths[-1], count + 1)
    return np.stack([np.interp(places, lengths, line[:, axis]) for axis in range(3)], axis=-1)
