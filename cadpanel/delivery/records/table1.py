"""From the results of a comparison to compare.json."""

from __future__ import annotations

from collections.abc import Sequence

from cadpanel.delivery.records.comparison import ColumnModel, ComparisonModel
from cadpanel.delivery.records.from_fit import reference_record, seam_names
from cadpanel.delivery.records.settings import comparison_settings_record
from cadpanel.delivery.records.summary import summary
from cadpanel.fitting.result import FitResult
from cadpanel.fitting.settings import FitSettings
from cadpanel.reference.model import Reference


def comparison_record(reference: Reference, settings: FitSettings, results: Sequence[FitResult]) -> ComparisonModel:
    """What compare.json holds.

    Args:
        reference: what was approximated.
        settings: tolerance, limits, tilt and restarts of all columns.
        results: one a column, as `studies.table1.compare` gives them.
    """
    return ComparisonModel(
        reference=reference_record(reference),
        settings=comparison_settings_record(reference, settings),
        seams=seam_names(reference),
        columns=tuple(map(_record, results)),
    )


def _record(result: FitResult) -> ColumnModel:
    return ColumnModel(
        feature=result.settings.feature_name,
        method=result.settings.method,
        max_corner_gap=tuple(result.measures.widest_corners.tolist()),
        summary=summary(result.measures, result.local, result.settings, result.outcomes),
        local_rms_deviation=result.local.overall_rms,
        seconds=result.seconds,
    )
