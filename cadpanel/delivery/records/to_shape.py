"""From a report's record back to the panel that it tells of: by it the files of a delivery can be held against it."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from cadpanel.arrays import Array
from cadpanel.delivery.records.blanks import CutModel
from cadpanel.delivery.records.patches import PatchModel, RulingModel
from cadpanel.delivery.records.report import PanelModel, ReportModel
from cadpanel.errors import DeliveryError
from cadpanel.geometry.leaning_sides import may_lean
from cadpanel.geometry.panel import CutPlane
from cadpanel.geometry.patches import ConePatch, Patch, PlanePatch
from cadpanel.geometry.returns import PATCHES, SIDES, ReturnRule
from cadpanel.geometry.shape import PanelShape, PolygonShape
from cadpanel.geometry.sheet_checks import sheet_depth, skin_side_of
from cadpanel.geometry.trays import TrayShape, folded_tray

Built = PanelShape | PolygonShape | TrayShape
"""A panel as a report tells of it."""


def recorded_shape(panel: PanelModel, depth: float, *, square: bool = False) -> Built:
    """The panel as it was built, to the last digit: from its rulings and cuts, or from a polygon's corners and plane.

    Of a flat panel that is folded, what it was before tells where the walls of its joints stand.

    Args:
        panel: the record.
        depth: where the sheet's other face lies, mm along the skin's normal.
        square: whether the sheet's walls stand square to it.

    Raises:
        DeliveryError: the record does not say how the panel runs, how it is cut, or what part it is.
    """
    if panel.tray is None:
        return _before_folding(panel, depth, square=square)
    length, radius = panel.tray
    rule, side = ReturnRule(length=length, inner_radius=radius), skin_side_of(depth)
    return folded_tray(_before_folding(panel, depth), panel.returns, rule, abs(depth), side)


def _before_folding(panel: PanelModel, depth: float, *, square: bool = False) -> PanelShape | PolygonShape:
    corners, other = np.array(panel.corners), np.array(panel.other_face)
    if panel.blank is None or panel.mass is None or other.shape != corners.shape:
        raise _too_old(panel)
    moves = (other - corners) / depth
    if len(corners) == 1:
        posts = None if square else moves[0]
        return _polygon(panel, corners[0], posts, square=square)
    shape = _chain(panel, panel.rulings, panel.cuts)
    leans = _side_leans(moves, shape.binormals(), shape.normals, shape.patches)
    for side, cut in enumerate(panel.side_cuts):
        if cut is not None:
            normal = np.array(cut.normal)
            shape, leans[side] = shape.walled(side, CutPlane(point=cut.offset * normal, normal=normal)), 0.0
    return shape.made_square() if square else shape.trimmed(*shape.cuts(), leans)


def recorded_shapes(report: ReportModel) -> list[Built]:
    """The panels of a report's list.

    Raises:
        DeliveryError: a record does not say how its panel runs.
    """
    sheet = report.settings.sheet()
    depth = sheet_depth(sheet.thickness, sheet.skin_side)
    return [recorded_shape(panel, depth, square=sheet.ends == "square") for panel in report.panels]


def fitted_shape(panel: PanelModel) -> PanelShape | PolygonShape:
    """The panel as it was fitted, before it was cut back, as gaps and limits are measured on it.

    Raises:
        DeliveryError: the record does not say how the panel runs or how it is cut.
    """
    if panel.fitted is None:
        raise _too_old(panel)
    corners = np.array(panel.fitted.corners)
    if len(corners) == 1:
        return _polygon(panel, corners[0], None)
    return _chain(panel, panel.fitted.rulings, panel.fitted.cuts)


def _polygon(panel: PanelModel, outline: Array, posts: Array | None, *, square: bool = False) -> PolygonShape:
    (plane,) = panel.patches
    if plane.kind != "plane":
        raise DeliveryError(f"The report tells of panel '{panel.name}' as a polygon that is bent: write it again.")
    normal = np.array(plane.normal)
    return PolygonShape(
        name=panel.name, feature=panel.feature, outline=outline, normal=normal, posts=posts, square=square
    )


def _chain(panel: PanelModel, rulings: Sequence[RulingModel], cuts: Sequence[CutModel]) -> PanelShape:
    if len(rulings) < 2 or len(cuts) != 2:
        raise _too_old(panel)
    points, directions, normals = (
        np.array([getattr(ruling, key) for ruling in rulings]) for key in ("point", "direction", "normal")
    )
    cut_normals = np.array([cut.normal for cut in cuts])
    return PanelShape(
        name=panel.name,
        feature=panel.feature,
        points=points,
        directions=directions,
        normals=normals,
        patches=tuple(_patch(ruling) for ruling in rulings[:-1]),
        cut_points=np.array([cut.offset for cut in cuts])[:, None] * cut_normals,
        cut_normals=cut_normals,
    )


def _patch(ruling: RulingModel) -> Patch:
    if ruling.radius is None or ruling.half_angle is None or ruling.sweep is None:
        return PlanePatch()
    return ConePatch(
        radius=ruling.radius,
        half_angle=math.radians(ruling.half_angle),
        sweep=math.radians(ruling.sweep),
        kind="cone" if ruling.half_angle else "cylinder",
    )


def _too_old(panel: PanelModel) -> DeliveryError:
    return DeliveryError(
        f"The report tells of panel '{panel.name}' without its rulings, cuts, blank, mass or other face, as older "
        "versions did: write the delivery again."
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
    kept = {"rulings": panel.rulings[own], "patches": fitted_patches(panel)}
    return panel.model_copy(update={**rows, **kept, "returns": (), "tray": None})


def _side_leans(moves: Array, binormals: Array, normals: Array, patches: Sequence[Patch]) -> Array:
    """(2,) by how much the walls lean at the first and the last ruling; at a cone they are square."""
    ways = [moves[:, place].mean(axis=0) for place in (0, -1)]
    leans = [way @ b / (way @ n) for way, b, n in zip(ways, binormals[[0, -1]], normals[[0, -1]], strict=True)]
    return np.where([may_lean(patches[place]) for place in (0, -1)], leans, 0.0)
