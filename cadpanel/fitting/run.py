"""From a reference to a result."""

from __future__ import annotations

from cadpanel.errors import SettingsError
from cadpanel.fitting.attempt import Attempts
from cadpanel.fitting.automatic import fit_automatically
from cadpanel.fitting.result import FitResult, Progress
from cadpanel.fitting.settings import FitSettings
from cadpanel.reference.model import Reference


def fit(
    reference: Reference,
    settings: FitSettings | None = None,
    progress: Progress | None = None,
    *,
    time_limit: float | None = None,
) -> FitResult:
    """Fit all panels of a reference.

    Args:
        reference: what is to be approximated.
        settings: how; by default concurrent plane-cone-plane with gaps of at most 1 mm.
        progress: told of every step of the concurrent fit; False ends it.
        time_limit: seconds after which the concurrent fit ends with the best so far. What comes before it, the fits of
            every panel alone, is always finished.

    Raises:
        PanelError: a panel's faces are nothing that the feature could approximate.
        SettingsError: no starting values are known for the feature, or a time limit is given beside weights.
    """
    how = settings or FitSettings()
    if time_limit is not None and how.weights is not None:
        raise SettingsError("a time limit ends the search for what holds tolerances; with weights there is none to end")
    attempts = Attempts(reference, how, progress, time_limit)
    if how.automatic:
        return fit_automatically(attempts)
    return attempts.fit([how.feature_for(len(panel.edges)) for panel in reference.panels])
