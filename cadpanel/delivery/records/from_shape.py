"""A panel's patches as a shop reads them: planes, cones by apex and axis, cylinders. Millimetres and degrees."""

from __future__ import annotations

import math
from functools import singledispatch

import numpy as np

from cadpanel.arrays import Array
from cadpanel.delivery.records.blanks import CutModel, Pair
from cadpanel.delivery.records.jsonfile import Vector
from cadpanel.delivery.records.patches import (
    ConePatchModel,
    CylinderPatchModel,
    PatchModel,
    PlanePatchModel,
    RulingModel,
)
from cadpanel.delivery.records.report import FittedModel
from cadpanel.geometry.cone_sections import AxisFrame, axis_frame, cut_cone, lifted, radius_range
from cadpanel.geometry.panel import Panel
from cadpanel.geometry.patches import ConePatch, Patch
from cadpanel.geometry.plane_sides import end_spans, planes_of
from cadpanel.geometry.shape import PanelShape, PolygonShape
from cadpanel.geometry.trays import TrayShape


@singledispatch
def patch_models(shape: Panel) -> tuple[PatchModel, ...]:
    """The patches of a panel as it is built, in the order of the walk; one entry for each kind of panel.

    Of a folded flat panel that of its flat part: its edges tell of the others.

    Raises:
        TypeError: nobody has said how panels of this kind are recorded.
    """
    raise TypeError(f"no record is known for a panel like {shape!r}: register one for its class")


@patch_models.register
def _of_polygon(shape: PolygonShape) -> tuple[PatchModel, ...]:
    return (PlanePatchModel(normal=vector(shape.normal), point=vector(shape.outline[0])),)


@patch_models.register
def _of_chain(shape: PanelShape) -> tuple[PatchModel, ...]:
    corners = shape.corners()
    models: list[PatchModel] = []
    for index, patch in enumerate(shape.patches):
        if isinstance(patch, ConePatch):
            models.append(_round_model(shape, index, patch))
        else:
            models.append(PlanePatchModel(normal=vector(shape.normals[index]), point=vector(corners[0, index])))
    return tuple(models)


@patch_models.register
def _of_tray(shape: TrayShape) -> tuple[PatchModel, ...]:
    return patch_models(shape.flat)


@singledispatch
def radius_ranges(shape: Panel) -> tuple[Pair | None, ...]:
    """Smallest and largest distance of each patch from its axis, mm; None where it is flat, as all others are."""
    return (None,) * len(patch_models(shape))


@radius_ranges.register
def _of_round_patches(shape: PanelShape) -> tuple[Pair | None, ...]:
    frames = [
        axis_frame(shape.points[index], shape.directions[index], shape.normals[index], patch)
        if isinstance(patch, ConePatch)
        else None
        for index, patch in enumerate(shape.patches)
    ]
    return tuple(None if frame is None else _radii(shape, index, frame) for index, frame in enumerate(frames))


@radius_ranges.register
def _of_folds(shape: TrayShape) -> tuple[Pair | None, ...]:
    return tuple((shape.radius, shape.radius) if isinstance(patch, ConePatch) else None for patch in shape.patches)


def fitted_model(shape: Panel) -> FittedModel:
    """A panel as it was fitted: its corners, and the planes that cut its ends."""
    return FittedModel(corners=rows(shape.corners()), cuts=cut_models(shape), rulings=ruling_models(shape))


@singledispatch
def ruling_models(_shape: Panel) -> tuple[RulingModel, ...]:
    """The rulings of a panel with the patches between them; none of one that is no chain of patches."""
    return ()


@ruling_models.register
def _along_chain(shape: PanelShape) -> tuple[RulingModel, ...]:
    return tuple(
        RulingModel(point=vector(point), direction=vector(direction), normal=vector(normal), **_numbers(patch))
        for point, direction, normal, patch in zip(*shape.rulings(), (*shape.patches, None), strict=True)
    )


@ruling_models.register
def _of_flat_part(shape: TrayShape) -> tuple[RulingModel, ...]:
    return ruling_models(shape.flat)


def _numbers(patch: Patch | None) -> dict[str, float]:
    if not isinstance(patch, ConePatch):
        return {}
    return {
        "radius": patch.radius,
        "half_angle": math.degrees(patch.half_angle),
        "sweep": math.degrees(patch.sweep),
    }


def cut_models(shape: Panel) -> tuple[CutModel, ...]:
    """The planes that cut a panel's ends."""
    return tuple(cut_model(point, normal) for point, normal in zip(*shape.cuts(), strict=True))


def side_cut_models(shape: Panel) -> tuple[CutModel | None, ...]:
    """The planes in which a panel's sides stand that follow no ruling; none where both do."""
    planes = planes_of(shape)
    if planes == (None, None):
        return ()
    return tuple(None if plane is None else cut_model(plane.point, plane.normal) for plane in planes)


def cut_model(point: Array, normal: Array) -> CutModel:
    """The plane through a point (3,) with a unit normal (3,)."""
    return CutModel(normal=vector(normal), offset=float(point @ normal))


def rows(corners: Array) -> tuple[tuple[Vector, ...], ...]:
    """Corners (r, m, 3) as a record holds them."""
    return tuple(tuple(vector(corner) for corner in row) for row in corners)


def vector(xyz: Array) -> Vector:
    """(3,) as a record holds it."""
    x, y, z = xyz.tolist()
    return x, y, z


def _round_model(shape: PanelShape, index: int, patch: ConePatch) -> ConePatchModel | CylinderPatchModel:
    frame = axis_frame(shape.points[index], shape.directions[index], shape.normals[index], patch)
    smallest, largest = _radii(shape, index, frame)
    if patch.half_angle == 0.0:
        return CylinderPatchModel(
            axis=vector(frame.axis),
            axis_point=vector(frame.center),
            radius_min=smallest,
            radius_max=largest,
            sweep=math.degrees(patch.sweep),
        )
    # The radius grows along the axis where radius and half angle have the same sign; the apex lies the other way.
    away = math.copysign(1.0, patch.radius * patch.half_angle)
    to_apex = frame.level_radius / math.tan(frame.half_angle)
    return ConePatchModel(
        apex=vector(frame.center - to_apex * frame.axis),
        axis=vector(away * frame.axis),
        half_angle=math.degrees(abs(patch.half_angle)),
        radius_min=smallest,
        radius_max=largest,
        sweep=away * math.degrees(patch.sweep),
    )


def _radii(shape: PanelShape, index: int, frame: AxisFrame) -> tuple[float, float]:
    """Smallest and largest distance of the trimmed patch from its axis; both lie on the sections at its ends."""
    cut = lifted(frame, shape.lift)
    found = np.array(
        [
            radius_range(cut_cone(cut, point, normal), last, first)
            for point, normal, (first, last) in zip(
                shape.cut_points, shape.cut_normals, end_spans(shape)[:, index].tolist(), strict=True
            )
        ]
    )
    radii = np.abs(found + (frame.level_radius - cut.level_radius))
    return float(radii.min()), float(radii.max())
