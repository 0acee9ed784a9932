"""Is every return that a report tells of as long and as round as was asked for, and is none missing?"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from cadpanel.delivery.contents import Contents
from cadpanel.delivery.records.patches import CylinderPatchModel, PlanePatchModel
from cadpanel.delivery.records.report import PanelModel
from cadpanel.delivery.settings import SheetSettings
from cadpanel.geometry.returns import SIDES, ReturnRule, tangent_length
from cadpanel.geometry.vectors import unit

SAME_LENGTH = 1e-6
"""Difference in mm between a return and what was asked for."""


def return_faults(contents: Contents) -> tuple[str, ...]:
    """One sentence for every side of a panel that is not folded as it was asked for."""
    asked = contents.shop.returns
    rule = None if asked is None else ReturnRule(length=asked[0], inner_radius=asked[1])
    meeting = {(panel, edge) for seam in contents.seams for panel, edge in zip(seam.panels, seam.edges, strict=True)}
    return tuple(
        f"Panel '{panel.name}': its {side} {fault}."
        for panel in contents.records
        for place, side in enumerate(SIDES)
        for fault in _faults(panel, place, rule, contents.sheet, meets=(panel.name, side) in meeting)
    )


def _faults(
    panel: PanelModel, place: int, rule: ReturnRule | None, sheet: SheetSettings, *, meets: bool
) -> Iterator[str]:
    if SIDES[place] not in panel.returns:
        flat = len(panel.corners) == 2 and isinstance(panel.patches[-place], PlanePatchModel)
        if rule is not None and flat and not meets:
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
