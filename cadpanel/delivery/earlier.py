"""Panels as an earlier delivery made them, for rules that lock them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np

from cadpanel.arrays import Array
from cadpanel.delivery.own_files import REPORT
from cadpanel.delivery.records.report import PanelModel, read_report
from cadpanel.delivery.records.to_shape import recorded_shape, unfolded
from cadpanel.errors import SettingsError
from cadpanel.fitting.rules.boundary import boundary_of
from cadpanel.fitting.rules.lock import LockRule
from cadpanel.fitting.rules.rule import places_of
from cadpanel.fitting.settings import FitSettings
from cadpanel.geometry.panel import Chain
from cadpanel.geometry.sheet_checks import sheet_depth
from cadpanel.geometry.vectors import cross, norm
from cadpanel.reference.model import Reference

# A corner of the fit that is farther from the ruling that was built, mm, tells that the panel was cut back there.
_ON_RULING = 1e-6


def with_earlier(settings: FitSettings, reference: Reference, folder_of: Callable[[str], Path] = Path) -> FitSettings:
    """The same settings where rules that lock panels know how these were made.

    Args:
        settings: how panels are fitted.
        reference: what is fitted.
        folder_of: where the delivery of a name lies.

    Raises:
        SettingsError: a delivery does not have a panel of a name, or a rule names none of the reference's.
        DeliveryError: a folder is no delivery.
    """
    if settings.rules is None or not settings.rules.unread:
        return settings
    names = [panel.name for panel in reference.panels]
    return replace(
        settings, rules=settings.rules.with_made(lambda rule: _made(rule, names, reference, folder_of(rule.delivery)))
    )


def _made(rule: LockRule, names: list[str], reference: Reference, folder: Path) -> LockRule:
    report = read_report(folder / REPORT)
    shift = np.array(report.origin.offset) - np.array(reference.origin)
    sheet = report.settings.sheet()
    depth = sheet_depth(sheet.thickness, sheet.skin_side)
    there = {panel.name: panel for panel in report.panels}
    made = []
    for place in places_of(rule.panels, names, rule.table):
        if names[place] not in there:
            raise SettingsError(
                f"the delivery '{rule.delivery}' has no panel '{names[place]}': leave it out of the [[lock]]"
            )
        points = _boundary(there[names[place]], depth) + shift
        made.append(tuple(tuple(point) for point in points.tolist()))
    return replace(rule, made=tuple(made))


def _boundary(panel: PanelModel, depth: float) -> Array:
    """(q, 3) as it was fitted, before it was cut back; its corners alone where a round side was cut back, too."""
    shape = recorded_shape(unfolded(panel), depth)
    if panel.fitted is None:
        return boundary_of(shape)
    corners = np.array(panel.fitted.corners)
    if not isinstance(shape, Chain):
        return corners.reshape(-1, 3)
    cuts = np.array([cut.normal for cut in panel.fitted.cuts])
    whole = shape.trimmed(np.array([cut.offset for cut in panel.fitted.cuts])[:, None] * cuts, cuts, np.zeros(2))
    points, directions, _ = whole.rulings()
    off = norm(cross(corners - points, directions))
    round_sides = [side for side in (0, -1) if shape.patches[side].kind != "plane"]
    flat = corners.reshape(-1, 3)
    if any(off[:, side].max() > _ON_RULING for side in round_sides):
        return flat
    return np.concatenate([flat, boundary_of(whole)[len(flat) :]])
