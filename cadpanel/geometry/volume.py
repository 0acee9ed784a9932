"""Areas of trimmed skins and volumes of the sheets between them, from formulas and quadrature to rounding error.

A sheet is filled by the parallel skins at every distance h from its own skin, all cut by the same two planes, and h is
measured along their common normal: volume = integral of area(h) dh. Lengths along a generatrix are linear in h (of a
square sheet they do not change) and the local width too, so the area is a quadratic in h, which three Gauss
nodes integrate exactly; under a wall that leans at the side of a cylinder, or stands in a plane at that of a cone, it
is smooth, and eight take it to rounding error. Across a cone patch the area is an integral over the sweep angle of a
smooth function, which Gauss-Legendre takes to rounding error.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Literal

import numpy as np

from cadpanel.arrays import Array
from cadpanel.geometry.cone_sections import AxisFrame, ConeCut, axis_frame, cut_cone, lifted
from cadpanel.geometry.panel import Chain, Panel
from cadpanel.geometry.patches import ConePatch
from cadpanel.geometry.plane_sides import SideCurve, end_spans, planes_of, side_curves
from cadpanel.geometry.vectors import cross

SWEEP_NODES = 48
_SWEEP_ABSCISSAE, _SWEEP_WEIGHTS = np.polynomial.legendre.leggauss(SWEEP_NODES)
QUADRATIC = np.polynomial.legendre.leggauss(3)
LEANING = np.polynomial.legendre.leggauss(8)


def patch_areas(shape: Chain) -> list[float]:
    """Area of each trimmed patch in the order of the walk, mm2. The shape must be buildable."""
    corners = shape.corners()
    areas = []
    for index, patch in enumerate(shape.patches):
        if isinstance(patch, ConePatch):
            areas.append(_cone_area(shape, index, patch))
        else:
            areas.append(_quadrilateral_area(corners[:, index : index + 2], shape.normals[index]))
    return areas


def sheet_volume(shape: Panel, thickness: float, skin_side: Literal["outer", "inner"] = "outer") -> float:
    """Volume in mm3 of the sheet of `thickness` mm on the side of the skin that `skin_side` leaves free.

    With "outer" the skin is the outer face and the sheet lies at -n, with "inner" at +n. The shape must be buildable.
    """
    away = -1.0 if skin_side == "outer" else 1.0
    may_lean = any(isinstance(side, ConePatch) and side.half_angle == 0.0 for side in shape.patches)
    abscissae, weights = LEANING if may_lean else QUADRATIC
    depths = 0.5 * thickness * (1.0 + abscissae)
    areas = np.array([shape.offset(away * float(depth)).area() for depth in depths])
    return float(0.5 * thickness * (weights @ areas))


def beyond_quadratic(shape: Panel, depth: float, share: float) -> float:
    """What the parallel skin at a share of `depth` has more than a quadratic in the share says, mm2.

    The quadratic is the one with the areas of both faces and the volume between them. More than a hair is left only
    where a side stands in a plane that meets a cone in no ruling.
    """
    if planes_of(shape) == (None, None):
        return 0.0
    near, far, own = (shape.offset(part * depth).area() for part in (0.0, 1.0, share))
    mean = sheet_volume(shape, abs(depth), "outer" if depth < 0.0 else "inner") / abs(depth)
    return own - quadratic_area(near, far, mean, share)


def quadratic_area(near: float, far: float, mean: float, share: float) -> float:
    """Area at a share of the way between two faces, of which both areas and the mean of all between them are known.

    With D = far - near and M = mean - near: near + (6 M - 2 D) share + (3 D - 6 M) share^2.
    """
    across, rise = far - near, mean - near
    return near + (6.0 * rise - 2.0 * across) * share + (3.0 * across - 6.0 * rise) * share**2


def _quadrilateral_area(corners: Array, normal: Array) -> float:
    """Area of a flat patch with corners (end, ruling, xyz): half the cross product of its diagonals."""
    diagonals = cross(corners[1, 1] - corners[0, 0], corners[1, 0] - corners[0, 1])
    return 0.5 * float(diagonals @ normal)


def _heights(cut: ConeCut, level_radius: float, half_angle: float, sweep_angles: Array) -> Array:
    """(m,) heights along the generatrix at which the cut plane lies, see ConeCut."""
    lean = cut.tilt * np.cos(sweep_angles - cut.phase)
    reach: Array = cut.offset - level_radius * lean
    rate: Array = math.cos(half_angle) * cut.rise + math.sin(half_angle) * lean
    return reach / rate


def _cone_area(shape: Chain, index: int, patch: ConePatch) -> float:
    """Integral over phi of the integral over the generatrix of (level_radius + height * sin(half_angle))."""
    frame = axis_frame(shape.points[index], shape.directions[index], shape.normals[index], patch)
    ends = {0: 0, 1: len(shape.patches) - 1}
    curves = {side: curve for side, curve in enumerate(side_curves(shape)) if curve is not None and ends[side] == index}
    if curves:
        return _area_between(shape, index, frame, curves)
    angles = 0.5 * patch.sweep * (1.0 + _SWEEP_ABSCISSAE)
    cut = lifted(frame, shape.lift)
    low, high = (
        _heights(cut_cone(cut, point, normal), cut.level_radius, patch.half_angle, angles)
        for point, normal in zip(shape.cut_points, shape.cut_normals, strict=True)
    )
    middle_radius = frame.level_radius + 0.5 * (low + high) * math.sin(patch.half_angle)
    return 0.5 * patch.sweep * float(_SWEEP_WEIGHTS @ (middle_radius * (high - low)))


def _area_between(shape: Chain, index: int, frame: AxisFrame, sides: Mapping[int, SideCurve]) -> float:
    """The same as an integral round the patch, where sides stand in planes.

    With G(h) = (level_radius + h sin(half_angle) / 2) h the area is that of -G dphi round the patch in the plane of phi
    and h; G is counted from half way up, as it loses digits far from 0.
    """
    level = float(np.mean([curve.heights.mean() for curve in sides.values()]))
    sine = math.sin(frame.half_angle)

    def swept(heights: Array) -> Array:
        up = heights - level
        return np.asarray((frame.level_radius + (level + 0.5 * up) * sine) * up)

    cut, area = lifted(frame, shape.lift), 0.0
    for end, (first, last) in enumerate(end_spans(shape)[:, index].tolist()):
        angles = first + 0.5 * (last - first) * (1.0 + _SWEEP_ABSCISSAE)
        section = cut_cone(cut, shape.cut_points[end], shape.cut_normals[end])
        heights = _heights(section, cut.level_radius, frame.half_angle, angles)
        area += (1.0 if end else -1.0) * 0.5 * (last - first) * float(_SWEEP_WEIGHTS @ swept(heights))
    for side, curve in sides.items():
        low, high = curve.heights.tolist()
        heights = low + 0.5 * (high - low) * (1.0 + _SWEEP_ABSCISSAE)
        along = float(_SWEEP_WEIGHTS @ (swept(heights) * curve.turns(heights)))
        area -= (1.0 if side else -1.0) * 0.5 * (high - low) * along
    return area
