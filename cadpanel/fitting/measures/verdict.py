"""Whether what was measured keeps within what was asked."""

from __future__ import annotations

import numpy as np

from cadpanel.fitting.measures.fit import Measures
from cadpanel.fitting.settings import FitSettings


def keeps_limits(measures: Measures, settings: FitSettings) -> bool:
    """Whether every gap, drift and deviation is within its limit; with weights only a deviation has one to miss."""
    if settings.max_deviation is not None and measures.max_deviation.max() > settings.max_deviation:
        return False
    if settings.weights is not None:
        return True
    return bool(
        measures.max_corner_gap <= settings.gap_tolerance
        and measures.max_seam_gap <= settings.gap_tolerance
        and np.all(measures.drift_along <= settings.drift_along * measures.lengths)
        and np.all(measures.drift_across <= settings.drift_across * measures.lengths)
    )
