"""A strip of any faces: its two long edges, and planes across it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array
from cadpanel.brep.skin.adjacency import Surface
from cadpanel.brep.skin.cut_planes import Cuts
from cadpanel.brep.skin.strip_direction import turning_angles, way_along
from cadpanel.errors import OutlineError, ReferenceFileError
from cadpanel.geometry.order import goes_backwards
from cadpanel.geometry.polyline import arc_length, interpolate
from cadpanel.geometry.vectors import norm, unit
from cadpanel.reference.model import RawPanel
from cadpanel.reference.outline import Side, find_outline

CUT_OTHERWISE = "cut it with a grid, a network of curves or a mesh"
"""What to do about a surface that is no strip."""


class NoStripError(ReferenceFileError):
    """A surface without two long edges."""


SIDES = 4
# A chord between the long edges shorter than this part of the strip's girth gives a plane no direction.
NO_CHORD = 0.02
# A plane reaches beyond the middle of its chord by this part of the girth: no point of a section lies farther than 0.5.
REACH = 0.6
# Places on the middle line by which points of the surface are told how far along they are.
MIDDLE_POINTS = 1025
# Half the step by which directions along the long edges are measured, as a part of the length.
STEP = 1e-3


@dataclass(frozen=True, slots=True, kw_only=True)
class Strip:
    """The long edges of a strip, each (q, 3) points from its beginning to its end, and how far it is across, mm."""

    edges: tuple[Array, Array]
    girth: float

    @property
    def length(self) -> float:
        """Mean length of the two long edges, mm."""
        return float(np.mean([arc_length(edge)[-1] for edge in self.edges]))

    def points(self, parts: Array) -> Array:
        """(2, k, 3) points on the two edges at (k,) parts of their lengths."""
        found = []
        for edge in self.edges:
            lengths = arc_length(edge)
            found.append(interpolate([lengths], edge, [parts * lengths[-1]]))
        return np.array(found)

    def planes(self, parts: Array) -> Cuts:
        """Planes through both long edges at (k,) parts of their lengths, square to the strip's direction there."""
        points = self.points(parts)
        before, after = self.points(np.maximum(parts - STEP, 0.0)), self.points(np.minimum(parts + STEP, 1.0))
        along = unit(unit(after - before).sum(axis=0))
        chords = points[1] - points[0]
        across = np.where(norm(chords)[:, None] > NO_CHORD * self.girth, unit(chords), 0.0)
        normals = unit(along - np.sum(along * across, axis=1, keepdims=True) * across)
        fine = np.linspace(0.0, 1.0, MIDDLE_POINTS)
        return Cuts(
            origins=points.mean(axis=0),
            normals=normals,
            reach=np.full(len(parts), REACH * self.girth),
            line=self.points(fine).mean(axis=0),
            places=np.interp(fine, np.concatenate([[0.0], parts, [1.0]]), np.arange(len(parts) + 2)),
        )


def find_strip(surface: Surface, source: str, tolerance: float) -> Strip:
    """The long edges of a surface with four sides, or one with more where two of them are clearly its ends.

    The strip runs in the direction in which normals turn slowly; where both turn alike, in the longer one; where both
    are as long, in the one that follows the first axis of space most. It begins at the end that comes first along the
    axis of space which it follows most.

    Args:
        surface: any.
        source: the reference's name.
        tolerance: how far faces that meet may lie apart, mm.

    Raises:
        NoStripError: the surface is none.
    """
    raw = RawPanel(name=surface.name, faces=tuple(face.samples for face in surface.faces))
    try:
        sides = find_outline(raw, source, tolerance).sides
    except OutlineError as error:
        fewer = "choose fewer faces, or " if len(surface.faces) > 1 else ""
        raise NoStripError(
            f"The surface of {surface.numbers} of '{source}' is no strip that could be divided along its length "
            f"({error.fault}): {fewer}{CUT_OTHERWISE}."
        ) from error
    if len(sides) != SIDES:
        raise NoStripError(
            f"The surface of {surface.numbers} of '{source}' has {len(sides)} sides where a strip has {SIDES}: "
            f"{CUT_OTHERWISE}."
        )
    lengths, turned = (
        [sum(map(measure, pair)) for pair in (sides[0::2], sides[1::2])] for measure in (_length, _turning)
    )
    # The sides follow each other round the outline, so that opposite ones run against each other.
    pairs = [(sides[one].points, sides[one + 2].points[::-1]) for one in (0, 1)]
    ways = np.array([np.mean([edge[-1] - edge[0] for edge in pair], axis=0) for pair in pairs])
    first = way_along((turned[0] / lengths[0], turned[1] / lengths[1]), (lengths[0], lengths[1]), ways)
    edges = pairs[first]
    if goes_backwards(ways[first]):
        edges = edges[0][::-1], edges[1][::-1]
    return Strip(edges=edges, girth=max(sides[first - 1].length, sides[1 - first].length, *_bulge(surface, edges)))


def _length(side: Side) -> float:
    return side.length


def _turning(side: Side) -> float:
    """By how much the normals turn on the way along a side, radians."""
    return float(turning_angles(side.normals).sum())


def _bulge(surface: Surface, edges: tuple[Array, Array]) -> tuple[float]:
    """How far the surface reaches from the middle of the long edges, doubled: its girth is no less, mm."""
    points = np.concatenate([face.samples.points for face in surface.faces])
    middle = 0.5 * (edges[0] + edges[1])
    nearest = np.min(np.linalg.norm(points[:, None] - middle[None, ::4], axis=-1), axis=1)
    return (2.0 * float(nearest.max()),)
