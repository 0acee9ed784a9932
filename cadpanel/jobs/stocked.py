"""Panels as long as was asked for, or as much shorter as it takes for their blanks to fit the sheets of the store."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from cadpanel.errors import PanelError, ReferenceFileError, SettingsError
from cadpanel.fitting.result import FitResult
from cadpanel.reference.settings import ReferenceSettings

SHORTER, MOST_TRIES = 0.85, 10
"""By what panels are shortened at a time, and how often: down to a fifth."""

FitOf = Callable[[ReferenceSettings], FitResult]


def fitted_to_stock(
    how: ReferenceSettings, fit_of: FitOf, fits: Callable[[FitResult], bool], stopped: Callable[[], bool]
) -> FitResult:
    """The fit of the longest panels that was found to give blanks which fit.

    Where panels have no length that may be shortened, or none was found, that of the panels as they were asked for.

    Args:
        how: how the reference is read and cut.
        fit_of: the fit of a reference that is cut in another way.
        fits: whether every blank of a fit fits a sheet.
        stopped: whether the user wants no more of it.

    Raises:
        CadpanelError: the reference cannot be fitted as it was asked for.
    """
    first = fit_of(how)
    length = how.panel_length
    if length is None or stopped() or fits(first):
        return first
    for _ in range(MOST_TRIES):
        length *= SHORTER
        try:
            result = fit_of(replace(how, panel_length=length))
            if stopped():
                return first
            fitting = fits(result)
        except (PanelError, ReferenceFileError, SettingsError):
            return first  # the panels as asked for stand, and it is said which fit no sheet
        if fitting:
            return _noted(result, length, how.panel_length or length)
    return first


def _noted(result: FitResult, length: float, asked: float) -> FitResult:
    note = (
        f"Panels are at most {length:.6g} mm long and not {asked:g} mm: blanks of longer ones fit no sheet of --stock."
    )
    reference = replace(result.reference, notes=(*result.reference.notes, note))
    return replace(result, reference=reference, baselines=result.baselines.told_of(reference))
