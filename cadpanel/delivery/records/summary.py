"""The measures of one fit in a few numbers, the same for every method."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cadpanel.delivery.records.report import SummaryModel
from cadpanel.fitting.measures.fit import Measures
from cadpanel.fitting.measures.verdict import keeps_limits
from cadpanel.fitting.rules.rule import Outcome
from cadpanel.fitting.settings import FitSettings
from cadpanel.terms.limits.catalogue import LIMITS

# A local fit closer than this, mm, is exact: a multiple of it would be a multiple of rounding.
_EXACT = 1e-6


def summary(
    measures: Measures, local: Measures, settings: FitSettings, outcomes: Sequence[Outcome] = ()
) -> SummaryModel:
    """What a fit is judged by.

    Args:
        measures: of the fit.
        local: of the local fit of the same feature, which its deviation is held against.
        settings: with the tolerance and the limits.
        outcomes: of rules.
    """
    stated = {
        "max_corner_gap": measures.max_corner_gap,
        "max_seam_gap": measures.max_seam_gap,
        "max_width": float(measures.seam_width.max(initial=0.0)),
        "max_step": float(measures.seam_step.max(initial=0.0)),
        "max_shift": float(measures.seam_shift.max(initial=0.0)),
        "max_unevenness": float(measures.uneven.max(initial=0.0)),
        "max_kink": float(np.degrees(measures.kink.max(initial=0.0))),
        "rms_deviation": measures.overall_rms,
        "max_deviation": float(measures.max_deviation.max()),
        "hausdorff": float(measures.hausdorff.max()),
        "max_corner_drift": float(measures.drift.max()),
        "max_drift_along": float(measures.drift_along.max()),
        "max_free_edge_drift": float(measures.drift_across.max()),
        "max_outline_drift": float(measures.outline_drift.max()),
        "local_rms_multiple": measures.overall_rms / local.overall_rms if local.overall_rms > _EXACT else None,
        "tolerance_met": keeps_limits(measures, settings) and all(outcome.kept for outcome in outcomes),
    }
    return SummaryModel.model_validate(stated | {limit.rows[-1].key: limit.worst(measures) for limit in LIMITS})
