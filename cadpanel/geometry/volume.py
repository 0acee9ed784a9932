"""Areas of trimmed skins and volumes of the sheets between them, from formulas and quadrature to rounding error.

A sheet is filled by the parallel skins at every distance h from its own skin, all cut by the same two planes, and h is
measured along their common normal: volume = integral of area(h) dh. Lengths along a generatrix are linear in h (of a
square sheet they do not change) and the local width too, so the area is a quadratic in h, which three Gauss
nodes integrate exactly; under a wall that leans at the side of a cylinder it is smooth, and eight take it to rounding
error. Across a cone patch the area is an integral over the sweep angle of a smooth function, which
Gauss-Legendre takes to rounding error.
"""

from __future__ import annotations

import math
from typing import Literal

import numpy as np

from cadpanel.arrays import Array
from cadpanel.geometry.cone_sections import ConeCut, axis_frame, cut_cone, lifted
from cadpanel.geometry.panel import Chain, Panel
from cadpanel.geometry.patches import ConePatch
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
    angles = 0.5 * patch.sweep * (1.0 + _SWEEP_ABSCISSAE)
    cut = lifted(frame, shape.lift)
    low, high = (
        _heights(cut_cone(cut, point, normal), cut.level_radius, patch.half_angle, angles)
        for point, normal in zip(shape.cut_points, shape.cut_normals, strict=True)
    )
    middle_radius = frame.level_radius + 0.5 * (low + high) * math.sin(patch.half_angle)
    return 0.5 * patch.sweep * float(_SWEEP_WEIGHTS @ (middle_radius * (high - low)))
