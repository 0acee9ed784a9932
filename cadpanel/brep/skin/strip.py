"""A strip of any faces: its two long edges, and planes across it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from cadpanel.arrays import Array
from cadpanel.brep.skin.adjacency import Surface
from cadpanel.brep.skin.cut_planes import Cuts
from cadpanel.brep.skin.strip_direction import turning_angles, way_along
from cadpanel.errors import NoStripError, OutlineError
from cadpanel.geometry.order import goes_backwards
from cadpanel.geometry.polyline import arc_length, interpolate
from cadpanel.geometry.vectors import cross, dot, norm, unit
from cadpanel.reference.model import RawPanel
from cadpanel.reference.outline import find_outline
from cadpanel.reference.outline_sides import Side

SIDES = 4
# A chord between the long edges shorter than this part of the strip's girth gives a plane no direction.
NO_CHORD = 0.02
# A plane reaches beyond the middle of its chord by this part of the girth: no point of a section lies farther than 0.5.
REACH = 0.6
LEAST_SLANT = 0.1
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

    def frames(self, parts: Array) -> Array:
        """(k, 3, 3) rows at (k,) parts of the length: along the strip, along the chord, and square to both.

        The way along is square to the chord between the long edges; where they all but meet the chord is zero.
        """
        points = self.points(parts)
        before, after = self.points(np.maximum(parts - STEP, 0.0)), self.points(np.minimum(parts + STEP, 1.0))
        along = unit(unit(after - before).sum(axis=0))
        chords = points[1] - points[0]
        across = np.where(norm(chords)[:, None] > NO_CHORD * self.girth, unit(chords), 0.0)
        ways = unit(along - np.sum(along * across, axis=1, keepdims=True) * across)
        return np.stack([ways, across, cross(ways, across)], axis=1)

    def planes(self, parts: Array, normals: Array | None = None) -> Cuts:
        """Planes midway between the long edges at (k,) parts of their lengths, with their (k, 3) unit normals.

        Without normals they pass through both edges, square to the strip's direction there.
        """
        fine = np.linspace(0.0, 1.0, MIDDLE_POINTS)
        square = self.frames(parts)[:, 0]
        normals = square if normals is None else normals
        # A plane at a slant meets the same strip farther from its middle.
        slant = np.maximum(np.abs(dot(square, normals)), LEAST_SLANT)
        return Cuts(
            origins=self.points(parts).mean(axis=0),
            normals=normals,
            reach=REACH * self.girth / slant,
            line=self.points(fine).mean(axis=0),
            places=np.interp(fine, np.concatenate([[0.0], parts, [1.0]]), np.arange(len(parts) + 2)),
        )

    def lengths_between(self, cuts: Cuts) -> Array:
        """(2, k + 1) lengths along the two edges between their ends and the planes, in order, mm.

        An edge counts as cut where it crosses a plane nearest to the place opposite the plane's origin.
        """
        middle = self.points(np.linspace(0.0, 1.0, MIDDLE_POINTS)).mean(axis=0)
        opposite = np.asarray(cKDTree(middle).query(cuts.origins)[1]) / (MIDDLE_POINTS - 1)
        lengths = []
        for edge in self.edges:
            along = arc_length(edge)
            heights = np.einsum("qkd,kd->kq", edge[:, None] - cuts.origins, cuts.normals)
            crossed = (heights[:, 1:] > 0.0) != (heights[:, :-1] > 0.0)
            steps = heights[:, 1:] - heights[:, :-1]
            share = np.clip(-heights[:, :-1] / np.where(crossed, steps, 1.0), 0.0, 1.0)
            places = along[:-1] + share * np.diff(along)
            off = np.where(crossed, np.abs(places - opposite[:, None] * along[-1]), np.inf)
            nearest = np.take_along_axis(places, off.argmin(axis=1)[:, None], axis=1)[:, 0]
            # A plane beyond an end leaves nothing of the edge.
            beyond = np.where(heights[:, 0] > 0.0, 0.0, along[-1])
            at = np.where(crossed.any(axis=1), nearest, beyond)
            lengths.append(np.diff(np.concatenate([[0.0], at, [along[-1]]])))
        return np.array(lengths)


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
        raise NoStripError(
            f"The surface of {surface.numbers} of '{source}' is no strip that could be divided along its length "
            f"({error.fault})"
        ) from error
    if len(sides) != SIDES:
        raise NoStripError(
            f"The surface of {surface.numbers} of '{source}' has {len(sides)} sides where a strip has {SIDES}"
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
