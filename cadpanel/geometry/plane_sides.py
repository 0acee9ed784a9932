"""Sides that stand in planes, where no ruling keeps to the plane of a joint. Millimetres and radians.

All rulings of a cone run to its apex, and no plane but through that holds any of them: a side along a ruling leaves a
joint that widens along it. A plane cuts the cone, and every parallel one, in conics instead: hyperbolas very near to
rulings, mostly.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array
from cadpanel.errors import PanelError
from cadpanel.geometry.cone_sections import AxisFrame, axis_frame, lifted
from cadpanel.geometry.curve_pieces import CurvePieces, segments
from cadpanel.geometry.panel import Chain, CutPlane
from cadpanel.geometry.patches import ConePatch
from cadpanel.geometry.plane_section import PlaneSection, corner_angles, plane_section
from cadpanel.geometry.vectors import cross, unit

_NO_BOW = 1e-9
"""An arc whose tangents leave its chord by less, mm, at its far end, is its chord."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SideCurve:
    """The conic in which a side's plane cuts the skin, followed by the height along the generatrix.

    Attributes:
        frame: of the skin.
        section: where the plane meets it, or the parallel skin that it cuts, whose points lie at the same angles and
            heights.
        way_out: 1 or -1, see `PlaneSection.angles`.
        corners: (2,) the angles of its corners at end 0 and end 1.
        heights: (2,) their heights.
    """

    frame: AxisFrame
    section: PlaneSection
    way_out: float
    corners: Array
    heights: Array

    def angles(self, heights: Array) -> Array:
        """(m,) angles at heights (m,)."""
        return np.asarray(self._followed(heights)[0][0])

    def turns(self, heights: Array) -> Array:
        """(m,) derivatives of the angles by the heights (m,)."""
        return np.asarray(self._followed(heights)[1][0])

    def points(self, heights: Array) -> Array:
        """(m, 3) points at heights (m,)."""
        return self.frame.points(self.angles(heights), heights)

    def _followed(self, heights: Array) -> tuple[Array, Array]:
        return self.section.angles(heights[None], np.array([self.way_out]), self.corners[:1])


def planes_of(shape: object) -> tuple[CutPlane | None, CutPlane | None]:
    """The planes in which a panel's sides stand that follow no ruling; of one that is no chain none does."""
    return shape.side_planes if isinstance(shape, Chain) else (None, None)


def side_curves(shape: object) -> tuple[SideCurve | None, SideCurve | None]:
    """The curves of its sides, as `side_curve` tells them; of a panel that is no chain none."""
    return (side_curve(shape, 0), side_curve(shape, 1)) if isinstance(shape, Chain) else (None, None)


def side_curve(shape: Chain, side: int) -> SideCurve | None:
    """The curve of a side that stands in a plane, None of one along a ruling.

    Raises:
        PanelError: the plane misses the panel's ends.
    """
    plane = shape.side_planes[side]
    if plane is None:
        return None
    index = 0 if side == 0 else len(shape.patches) - 1
    patch = shape.patches[index]
    assert isinstance(patch, ConePatch)
    frame = axis_frame(shape.points[index], shape.directions[index], shape.normals[index], patch)
    return curve_in_plane(shape, frame, side, plane)


def curve_in_plane(shape: Chain, frame: AxisFrame, side: int, plane: CutPlane) -> SideCurve:
    """The curve in which a plane cuts a patch between the planes at the chain's ends.

    Args:
        shape: the chain.
        frame: of its first or last patch, or of one parallel to that.
        side: 0 or 1.
        plane: at that side.

    Raises:
        PanelError: the plane misses the panel's ends.
    """
    cut = lifted(frame, shape.lift)
    section = plane_section(cut, plane.point, plane.normal)
    cuts = [plane_section(cut, *of) for of in zip(shape.cut_points, shape.cut_normals, strict=True)]
    ends = PlaneSection(reach=np.concatenate([of.reach for of in cuts]), rate=np.concatenate([of.rate for of in cuts]))
    both = PlaneSection(reach=np.tile(section.reach, (2, 1)), rate=np.tile(section.rate, (2, 1)))
    corners = corner_angles(ends, both, np.full(2, frame.sweep if side else 0.0))
    if not np.abs(corners).max() <= np.pi:  # nor where one is not a number
        raise PanelError(
            shape.name,
            f"the plane of the joint at side {side} misses it: hold a smaller gap tolerance, or read the reference "
            "with a smaller --seam-tolerance, so that the two do not meet.",
        )
    return SideCurve(
        frame=frame,
        section=section,
        way_out=math.copysign(1.0, frame.sweep) * (1.0 if side else -1.0),
        corners=corners,
        heights=ends.heights(corners[:, None])[0][:, 0],
    )


def side_tangents(curve: SideCurve) -> CurvePieces:
    """The tangents of a side's arc at its corners, as segments that meet: it lies in the triangle that they close."""
    heights = curve.heights
    radials = curve.frame.radials(curve.corners)
    cosine, sine = math.cos(curve.frame.half_angle), math.sin(curve.frame.half_angle)
    width = (curve.frame.level_radius + sine * heights) * curve.turns(heights)
    ways = unit(cosine * curve.frame.axis + sine * radials + width[:, None] * cross(curve.frame.axis, radials))
    start, stop = curve.frame.points(curve.corners, heights)
    chord = stop - start
    aside = [chord - (chord @ way) * way for way in ways]
    # Two tangents that all but meet their chord would meet anywhere on it, and there is nothing between them.
    if min(float(np.linalg.norm(off)) for off in aside) <= _NO_BOW:
        return segments(start[None], stop[None])
    meet = start + float(chord @ aside[1]) / float(ways[0] @ aside[1]) * ways[0]
    return segments(np.array([start, meet]), np.array([meet, stop]))


def end_spans(shape: Chain) -> Array:
    """(2, k, 2) angles between which each end runs over each patch; those of flat ones are 0."""
    sweeps = [patch.sweep if isinstance(patch, ConePatch) else 0.0 for patch in shape.patches]
    spans = np.tile(np.stack([np.zeros(len(sweeps)), sweeps], axis=-1), (2, 1, 1))
    for side in range(2):
        curve = side_curve(shape, side)
        if curve is not None:
            spans[:, -side, side] = curve.corners
    return spans
