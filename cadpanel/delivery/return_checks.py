"""Is every return that a report tells of as long and as round as was asked for, and is none missing?"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from cadpanel.delivery.contents import Contents
from cadpanel.delivery.records.patches import CylinderPatchModel, PlanePatchModel
from cadpanel.delivery.records.report import PanelModel
from cadpanel.delivery.records.to_shape import recorded_shape, unfolded
from cadpanel.delivery.settings import SheetSettings
from cadpanel.geometry.returns import SIDES, ReturnRule, tangent_length
from cadpanel.geometry.sheet_checks import sheet_depth
from cadpanel.geometry.trays import TrayShape, foldable_edges
from cadpanel.geometry.vectors import unit

SAME_LENGTH = 1e-6
"""Difference in mm between a return and what was asked for."""


def return_faults(contents: Contents) -> tuple[str, ...]:
    """One sentence for every edge of a panel that is not folded as it was asked for."""
    asked = contents.shop.returns
    rule = None if asked is None else ReturnRule(length=asked[0], inner_radius=asked[1])
    faults = (
        (panel, fault)
        for panel in contents.records
        for fault in (
            _flat_faults(panel, rule, contents.sheet)
            if len(panel.patches) == 1 and isinstance(panel.patches[0], PlanePatchModel)
            else _chain_faults(panel, rule, contents.sheet)
        )
    )
    return tuple(f"Panel '{panel.name}': its {fault}." for panel, fault in faults)


def _flat_faults(panel: PanelModel, rule: ReturnRule | None, sheet: SheetSettings) -> Iterator[str]:
    """What is wrong with the returns round a flat panel."""
    if rule is None:
        if panel.returns or panel.tray is not None:
            yield "report tells of returns that were not asked for"
        return
    if panel.tray is not None and panel.tray != (rule.length, rule.inner_radius):
        length, radius = panel.tray
        yield (
            f"returns are {length:g} mm long and {radius:g} mm round inside, {rule.length:g} and "
            f"{rule.inner_radius:g} were asked for"
        )
        return
    shape = recorded_shape(unfolded(panel), sheet_depth(sheet.thickness, sheet.skin_side))
    if isinstance(shape, TrayShape):
        return
    edges, _ = foldable_edges(shape, rule, sheet.thickness, sheet.skin_side)
    for edge in sorted({*edges} ^ {*panel.returns}):
        yield (
            f"{edge} has no return, and nothing is in its way" if edge in edges else f"{edge} has no room for a return"
        )


def _chain_faults(panel: PanelModel, rule: ReturnRule | None, sheet: SheetSettings) -> Iterator[str]:
    for place, side in enumerate(SIDES):
        for fault in _side_faults(panel, place, rule, sheet):
            yield f"{side} {fault}"


def _side_faults(panel: PanelModel, place: int, rule: ReturnRule | None, sheet: SheetSettings) -> Iterator[str]:
    if SIDES[place] not in panel.returns:
        flat = len(panel.corners) == 2 and isinstance(panel.patches[-place], PlanePatchModel)
        if rule is not None and flat:
            yield "has no return, and nothing is in its way"
        return
    fold = panel.patches[(1, -2)[place]] if len(panel.patches) > 2 else None
    if rule is None or not isinstance(fold, CylinderPatchModel):
        yield "has a return that was not asked for, or is none"
        return
    inside = rule.inner_radius + (sheet.thickness if sheet.skin_side == "outer" else 0.0)
    if not abs(fold.radius_max - inside) <= SAME_LENGTH:
        yield f"is folded round {fold.radius_max:.6g} mm on its skin, {inside:g} mm were asked for"
    corners = np.array(panel.corners)[:, [0, 1] if place == 0 else [-1, -2]]
    along, across = unit(corners[1, 0] - corners[0, 0]), corners[0, 0] - corners[0, 1]
    leg = float(np.linalg.norm(across - (across @ along) * along))
    found = leg + tangent_length(rule, sheet.thickness, math.radians(abs(fold.sweep)))
    if not abs(found - rule.length) <= SAME_LENGTH:
        yield f"has a return of {found:.6g} mm, {rule.length:g} mm were asked for"
