"""From a report's record back to the panel that it tells of: by it the files of a delivery can be held against it."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from cadpanel.arrays import Array
from cadpanel.delivery.records.patches import ConePatchModel, CylinderPatchModel, PatchModel, PlanePatchModel
from cadpanel.delivery.records.report import PanelModel
from cadpanel.errors import DeliveryError
from cadpanel.geometry.cone_sections import axis_frame
from cadpanel.geometry.patches import ConePatch, Patch, PlanePatch
from cadpanel.geometry.returns import PATCHES, SIDES, ReturnRule
from cadpanel.geometry.shape import PanelShape, PolygonShape
from cadpanel.geometry.sheet_checks import skin_side_of
from cadpanel.geometry.trays import TrayShape, folded_tray
from cadpanel.geometry.vectors import cross, unit


def recorded_shape(panel: PanelModel, depth: float, *, square: bool = False) -> PanelShape | PolygonShape | TrayShape:
    """The panel as it was built, from its corners, patches and cuts; good to some 1e-9 mm.

    Of a flat panel that is folded, what it was before tells where the walls of its joints stand.

    Args:
        panel: the record.
        depth: where the sheet's other face lies, mm along the skin's normal.
        square: whether the sheet's walls stand square to it.

    Raises:
        DeliveryError: the record does not say how the panel is cut, or what part it is.
    """
    if panel.tray is None:
        return _before_folding(panel, depth, square=square)
    length, radius = panel.tray
    rule, side = ReturnRule(length=length, inner_radius=radius), skin_side_of(depth)
    return folded_tray(_before_folding(panel, depth), panel.returns, rule, abs(depth), side)


def _before_folding(panel: PanelModel, depth: float, *, square: bool = False) -> PanelShape | PolygonShape:
    corners = np.array(panel.corners)
    other = np.array(panel.other_face)
    if (
        panel.blank is None
        or panel.mass is None
        or len(panel.cuts) != (0, 2)[len(corners) - 1]
        or other.shape != corners.shape
    ):
        raise DeliveryError(
            f"The report tells of panel '{panel.name}' without its blank, mass, cuts or other face, as older versions "
            "did: write the delivery again."
        )
    moves = (other - corners) / depth
    if len(corners) == 1:
        (plane,) = panel.patches
        assert isinstance(plane, PlanePatchModel)
        return PolygonShape(
            name=panel.name,
            feature=panel.feature,
            outline=corners[0],
            normal=np.array(plane.normal),
            posts=None if square else moves[0],
            square=square,
        )
    directions = unit(corners[1] - corners[0])
    normals = np.empty_like(directions)
    patches: list[Patch] = []
    for index, model in enumerate(panel.patches):
        patch, normals[index] = _patch(model, corners[0, index], directions[index])
        patches.append(patch)
    normals[-1] = _last_normal(patches[-1], corners[0, -2], directions[-2], normals[-2])
    cuts = np.array([cut.normal for cut in panel.cuts])
    return PanelShape(
        name=panel.name,
        feature=panel.feature,
        points=corners[0],
        directions=directions,
        normals=normals,
        patches=tuple(patches),
        cut_points=np.array([cut.offset for cut in panel.cuts])[:, None] * cuts,
        cut_normals=cuts,
        side_leans=np.zeros(2) if square else _side_leans(moves, cross(directions, normals), patches),
        square=square,
    )


def tray_of(panel: PanelModel, depth: float) -> TrayShape | None:
    """The panel where it is a flat one with folded edges."""
    shape = None if panel.tray is None else recorded_shape(panel, depth)
    return shape if isinstance(shape, TrayShape) else None


def sheet_corners(panel: PanelModel, depth: float) -> tuple[Array, Array]:
    """(v, 3) the corners of the skin and of the other face of a sheet as it is built, mm."""
    tray = tray_of(panel, depth)
    if tray is not None:
        return tray.vertices(), tray.offset(depth).vertices()
    return np.array(panel.corners).reshape(-1, 3), np.array(panel.other_face).reshape(-1, 3)


def unfolded_rulings(panel: PanelModel) -> tuple[int, int]:
    """From which to which corner of its rows a panel is as it was fitted: beyond lie its returns."""
    first, last = (PATCHES * (side in panel.returns and panel.tray is None) for side in SIDES)
    return first, len(panel.corners[0]) - last


def fitted_patches(panel: PanelModel) -> tuple[PatchModel, ...]:
    """The patches of a panel as it was fitted, without those of its returns."""
    own = slice(*unfolded_rulings(panel))
    return panel.patches[own.start : own.stop - 1] if panel.returns and panel.tray is None else panel.patches


def unfolded(panel: PanelModel) -> PanelModel:
    """The record of a panel as it was built, but for its returns."""
    own = slice(*unfolded_rulings(panel))
    rows = {"corners": tuple(r[own] for r in panel.corners), "other_face": tuple(r[own] for r in panel.other_face)}
    return panel.model_copy(update={**rows, "patches": fitted_patches(panel), "returns": (), "tray": None})


def fitted_shape(panel: PanelModel, depth: float) -> PanelShape | PolygonShape:
    """The panel as it was fitted, before it was cut back, as gaps and limits are measured on it.

    Args:
        panel: the record.
        depth: where the sheet's other face lies, mm along the skin's normal.

    Raises:
        DeliveryError: the record does not say how the panel is cut, or what part it is.
    """
    if panel.fitted is None:
        return _before_folding(panel, depth)
    own = unfolded(panel)
    moves = np.array(own.other_face) - np.array(own.corners)
    other = tuple(tuple(map(tuple, row)) for row in (np.array(panel.fitted.corners) + moves).tolist())
    uncut = {"corners": panel.fitted.corners, "cuts": panel.fitted.cuts, "other_face": other}
    return _before_folding(own.model_copy(update=uncut), depth)


def _side_leans(moves: Array, binormals: Array, patches: Sequence[Patch]) -> Array:
    """(2,) by how much the walls lean at the first and the last ruling; at a round patch they are square."""
    flat = [not isinstance(patches[place], ConePatch) for place in (0, -1)]
    leans = [moves[:, place].mean(axis=0) @ binormals[place] for place in (0, -1)]
    return np.where(flat, leans, 0.0)


def _patch(model: PatchModel, point: Array, direction: Array) -> tuple[Patch, Array]:
    """A patch and the skin's normal at its first ruling."""
    if not isinstance(model, ConePatchModel | CylinderPatchModel):
        return PlanePatch(), np.array(model.normal)
    axis = np.array(model.axis)
    ahead = math.copysign(1.0, float(axis @ direction))
    axis = ahead * axis
    to = point - np.array(model.apex if isinstance(model, ConePatchModel) else model.axis_point)
    out = to - (to @ axis) * axis
    sweep = math.radians(ahead * model.sweep)
    level = math.copysign(float(np.linalg.norm(out)), sweep)
    radial = out / level
    half_angle = 0.0
    if isinstance(model, ConePatchModel):
        # It widens along the axis as it was recorded, which led away from the apex.
        half_angle = math.radians(ahead * math.copysign(model.half_angle, level))
    cosine, sine = math.cos(half_angle), math.sin(half_angle)
    normal = cosine * radial - sine * axis
    return ConePatch(radius=level / cosine, half_angle=half_angle, sweep=sweep, kind=model.kind), normal


def _last_normal(patch: Patch, point: Array, direction: Array, normal: Array) -> Array:
    if not isinstance(patch, ConePatch):
        return normal
    frame = axis_frame(point, direction, normal, patch)
    radial = frame.radials(np.array([patch.sweep]))[0]
    return np.asarray(math.cos(patch.half_angle) * radial - math.sin(patch.half_angle) * frame.axis)
