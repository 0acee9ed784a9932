"""Panels as an earlier delivery made them, for rules that lock them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np

from cadpanel.delivery.own_files import REPORT
from cadpanel.delivery.records.report import read_report
from cadpanel.delivery.records.to_shape import fitted_shape
from cadpanel.errors import SettingsError
from cadpanel.fitting.rules.boundary import boundary_of
from cadpanel.fitting.rules.lock import LockRule
from cadpanel.fitting.rules.rule import places_of
from cadpanel.fitting.settings import FitSettings
from cadpanel.reference.model import Reference


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
    there = {panel.name: panel for panel in report.panels}
    made = []
    for place in places_of(rule.panels, names, rule.table):
        if names[place] not in there:
            raise SettingsError(
                f"the delivery '{rule.delivery}' has no panel '{names[place]}': leave it out of the [[lock]]"
            )
        points = boundary_of(fitted_shape(there[names[place]])) + shift
        made.append(tuple(tuple(point) for point in points.tolist()))
    return replace(rule, made=tuple(made))
