"""From a reference to a result."""

from __future__ import annotations

import time

from cadpanel.arrays import IntArray
from cadpanel.errors import SettingsError
from cadpanel.fitting.attempt import Attempts
from cadpanel.fitting.automatic import fit_automatically
from cadpanel.fitting.bends.taken import check_blends
from cadpanel.fitting.components import components, fit_apart
from cadpanel.fitting.result import FitResult, Progress
from cadpanel.fitting.seams_asked import for_seams
from cadpanel.fitting.settings import FitSettings
from cadpanel.reference.model import Reference

# Of a time limit that is over, s: a fit ends with the first thing that it tells.
_AT_ONCE = 1e-6


def fit(
    reference: Reference,
    settings: FitSettings | None = None,
    progress: Progress | None = None,
    *,
    time_limit: float | None = None,
    after: FitResult | None = None,
) -> FitResult:
    """Fit all panels of a reference, those that seams connect together, and components by themselves.

    Args:
        reference: what is to be approximated.
        settings: how; by default concurrent plane-cone-plane, steps of at most 3 mm, seams within 3 degrees of the
            drawn ones.
        progress: told of every step of the concurrent fit; False ends it.
        time_limit: seconds after which the concurrent fit ends with the best so far. What comes before it, the fits of
            every panel alone, is always finished.
        after: a concurrent fit of the same reference with the same features under other tolerances, to go on from.

    Raises:
        PanelError: a panel's faces are nothing that the feature could approximate.
        SettingsError: no starting values are known for the feature, a time limit is given beside weights, or there is
            no going on from the fit that is given.
    """
    how = for_seams(settings or FitSettings(), reference.settings.seams)
    if time_limit is not None and how.weights is not None:
        raise SettingsError("a time limit ends the search for what holds tolerances; with weights there is none to end")
    if after is not None:
        _require_alike(reference, how, after)
    names, corners = zip(*((panel.name, len(panel.edges)) for panel in reference.panels), strict=True)
    features = None if how.automatic else how.features_for(names, corners)
    deadline = None if time_limit is None else time.perf_counter() + time_limit

    def one(part: Reference, own: FitSettings, places: IntArray, before: FitResult | None) -> FitResult:
        left = None if deadline is None else max(deadline - time.perf_counter(), _AT_ONCE)
        attempts = Attempts(part, own, progress, left)
        return fit_automatically(attempts) if features is None else attempts.fit([features[i] for i in places], before)

    parts = components(reference, how)
    if len(parts) == 1:
        return one(reference, how, parts[0], after)
    if features is not None:
        check_blends(reference, features, how.blend)  # of all: a part knows nothing of another one's panels
    return fit_apart(reference, how, parts, one, after)


def _require_alike(reference: Reference, how: FitSettings, after: FitResult) -> None:
    """Refuse to go on from a fit of other panels or features, or where a method does not go on."""
    if how.automatic or how.method != "concurrent" or how.weights is not None:
        raise SettingsError("only a concurrent fit of one feature that holds tolerances goes on from another one")
    if after.reference is not reference or (after.settings.feature, after.settings.tilt) != (how.feature, how.tilt):
        raise SettingsError("a fit goes on from one of the same reference with the same feature and tilt")
