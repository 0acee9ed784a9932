"""Is what a report says of a panel's shape that of the shape which its rulings, plane and cuts make?"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from cadpanel.arrays import Array
from cadpanel.delivery.records.from_shape import patch_models
from cadpanel.delivery.records.patches import ConePatchModel, PatchModel, PlanePatchModel
from cadpanel.delivery.records.report import PanelModel
from cadpanel.delivery.records.to_shape import Built, fitted_shape, unfolded_rulings
from cadpanel.errors import PanelError
from cadpanel.geometry.chain_checks import check_walk
from cadpanel.geometry.cone_sections import axis_frame
from cadpanel.geometry.panel import Chain, Panel
from cadpanel.geometry.patches import ConePatch, Patch
from cadpanel.geometry.slender_cones import SMALLEST_HALF_ANGLE
from cadpanel.geometry.trays import TrayShape
from cadpanel.geometry.vectors import cross, norm

SAME_LENGTH = 1e-5
"""Two lengths in mm that are meant to be one may differ by this."""
SAME_FAR = 1e-12
"""The same of what lies far away, as a slender cone's apex, as a part of its distance."""
SAME_AREA = 1e-9
"""Relative difference of two areas that are meant to be one."""
SAME_CORNER = 1e-6
"""Distance in mm of a corner from where rulings meet cuts."""
SAME_WAY = 1e-9
"""Difference of two unit vectors that are meant to be one."""
SAME_ANGLE = 1e-6
"""Degrees by which two angles may differ that are meant to be one."""


def shape_faults(record: PanelModel, shape: Built, depth: float) -> Iterator[str]:
    """One sentence for every number of a record that is not the shape's, as `recorded_shape` makes it.

    Where that surface is, is proved by the files; here are the numbers that are told of it besides.

    Args:
        record: of a panel.
        shape: which it gives.
        depth: where the sheet's other face lies, mm along the skin's normal.
    """
    name = f"Panel '{record.name}'"
    yield from (f"{name}: the report's {patch} is not that of its rulings." for patch in _other_patches(record, shape))
    for what, stated, own in (
        ("corner", record.corners, shape.corners()),
        ("corner of the other face", record.other_face, shape.offset(depth).corners()),
    ):
        off = _apart(np.array(stated), own)
        if not off <= SAME_CORNER:
            yield f"{name}: a {what} in the report lies {off:.3g} mm from where its rulings end."
    area = shape.area()
    if not abs(record.area / area - 1.0) <= SAME_AREA:
        yield f"{name}: the report's area is {record.area:.9g} mm2, its rulings and cuts enclose {area:.9g}."
    most = SMALLEST_HALF_ANGLE * float(np.linalg.norm(np.ptp(np.array(record.corners).reshape(-1, 3), axis=0)))
    if record.moved > 0.0 and all(patch.kind != "cylinder" for patch in record.patches):
        yield f"{name}: the report says that a slender cone was straightened, and it has no cylinder."
    if not record.moved <= most:
        yield (
            f"{name}: the report says that a slender cone was straightened by {record.moved:.3g} mm, one of its size "
            f"moves by {most:.3g} mm at most."
        )
    if record.fitted is not None:
        fault = _fitted_fault(record, shape.flat if isinstance(shape, TrayShape) else shape)
        if fault is not None:
            yield f"{name}: {fault} of the report's fitted panel lies not where the panel has it."


def _apart(stated: Array, own: Array) -> float:
    return float(norm(stated - own).max()) if stated.shape == own.shape else np.inf


def _other_patches(record: PanelModel, shape: Built) -> Iterator[str]:
    """The patches of a record that are not the shape's, as sentences call them."""
    own = patch_models(shape)
    if len(own) != len(record.patches):
        yield f"list of {len(record.patches)} patches"
        return
    starts = np.array(record.corners)[0]
    for index, (stated, other) in enumerate(zip(record.patches, own, strict=True)):
        if not _same_patch(stated, other, starts[index]):
            yield f"{stated.kind} (patch {index + 1})"


def _same_patch(one: PatchModel, other: PatchModel, near: Array) -> bool:
    """Whether two records tell of one patch, near a point (3,) on it."""
    if isinstance(one, PlanePatchModel) or isinstance(other, PlanePatchModel):
        if not (isinstance(one, PlanePatchModel) and isinstance(other, PlanePatchModel)):
            return False
        same = np.abs(np.subtract(one.normal, other.normal)).max() <= SAME_WAY
        return bool(same and np.abs(np.subtract(one.point, other.point)).max() <= SAME_LENGTH)
    of_cone = isinstance(one, ConePatchModel), isinstance(other, ConePatchModel)
    if of_cone[0] != of_cone[1]:
        return False
    here, there = (np.array(own.apex if isinstance(own, ConePatchModel) else own.axis_point) for own in (one, other))
    half_angles = [own.half_angle if isinstance(own, ConePatchModel) else 0.0 for own in (one, other)]
    radii = np.abs(np.subtract((one.radius_min, one.radius_max), (other.radius_min, other.radius_max)))
    return bool(
        norm(here - there) <= SAME_LENGTH + SAME_FAR * norm(there - near)
        and np.abs(np.subtract(one.axis, other.axis)).max() <= SAME_WAY
        and abs(half_angles[0] - half_angles[1]) <= SAME_ANGLE
        and abs(one.sweep - other.sweep) <= SAME_ANGLE
        and radii.max() <= SAME_LENGTH
    )


def _fitted_fault(record: PanelModel, shape: Panel) -> str | None:
    """What of the fitted panel is not the built one's, of which nothing but ends and outermost rulings was moved."""
    assert record.fitted is not None
    fitted = fitted_shape(record)
    if _apart(np.array(record.fitted.corners), fitted.corners()) > SAME_CORNER:
        return "a corner"
    if not (isinstance(fitted, Chain) and isinstance(shape, Chain)):
        if isinstance(fitted, Chain) or isinstance(shape, Chain):
            return "a ruling"
        off = (np.array(record.fitted.corners) - np.array(record.corners)[0, 0]) @ fitted.normal
        return None if np.abs(off).max() <= SAME_LENGTH else "a corner"
    try:
        check_walk(fitted)
    except PanelError:
        return "a ruling"
    own = slice(*unfolded_rulings(record))
    return _other_walk(fitted, shape, own)


def _other_walk(fitted: Chain, built: Chain, own: slice) -> str | None:
    """Whether two walks over the same patches differ; of the built one without its returns."""
    points, directions, normals = (of[own] for of in (built.points, built.directions, built.normals))
    patches = built.patches[own.start : own.stop - 1]
    if len(patches) != len(fitted.patches):
        return "a patch"
    inner = slice(1, -1)
    beside = norm(cross(fitted.points - points, directions))[inner].max(initial=0.0)
    turned = norm(fitted.directions - directions)[inner].max(initial=0.0)
    tilted = norm(fitted.normals - normals)[inner].max(initial=0.0)
    if not (beside <= SAME_LENGTH and turned <= SAME_WAY and tilted <= SAME_WAY):
        return "a ruling"
    starts = points[:-1], directions[:-1], normals[:-1], patches
    of_fitted = fitted.points[:-1], fitted.directions[:-1], fitted.normals[:-1], fitted.patches
    same = all(map(_same_surface, zip(*of_fitted, strict=True), zip(*starts, strict=True)))
    return None if same else "a patch"


_Start = tuple[Array, Array, Array, Patch]
"""Point, direction and normal of a ruling, and the patch that begins there."""


def _same_surface(one: _Start, other: _Start) -> bool:
    """Whether two patches lie on one plane or one cone, wherever on it they begin."""
    if not (isinstance(one[3], ConePatch) and isinstance(other[3], ConePatch)):
        flat = not (isinstance(one[3], ConePatch) or isinstance(other[3], ConePatch))
        same_way = norm(one[2] - other[2]) <= SAME_WAY
        return bool(flat and same_way and abs((one[0] - other[0]) @ other[2]) <= SAME_LENGTH)
    first, second = axis_frame(*one[:3], one[3]), axis_frame(*other[:3], other[3])
    away = second.center - first.center
    along = away @ first.axis
    beside = norm(away - along * first.axis)
    wider = first.level_radius + math.tan(first.half_angle) * along - second.level_radius
    near = SAME_LENGTH + SAME_FAR * abs(second.level_radius)
    return bool(
        norm(first.axis - second.axis) <= SAME_WAY
        and abs(first.half_angle - second.half_angle) <= SAME_WAY
        and max(beside, abs(wider)) <= near
    )
