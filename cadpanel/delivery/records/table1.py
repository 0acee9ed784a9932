"""From the results of a comparison to compare.json."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from cadpanel.delivery.folder import COMPARISON, delivery_folder
from cadpanel.delivery.records.comparison import ColumnModel, ComparisonModel, ComparisonSettingsModel, write_comparison
from cadpanel.delivery.records.from_fit import reference_record, seam_names, settings_record
from cadpanel.delivery.records.summary import summary
from cadpanel.delivery.settings import SheetSettings
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
        settings=_settings_record(reference, settings),
        seams=seam_names(reference),
        columns=tuple(map(_record, results)),
    )


def write_comparison_folder(comparison: ComparisonModel, out: Path, *, overwrite: bool = False) -> None:
    """Write a folder with compare.json, whole or not at all.

    Raises:
        DeliveryError: the folder is refused or cannot be written.
    """
    with delivery_folder(out, overwrite=overwrite) as folder:
        write_comparison(comparison, folder / COMPARISON)


def _settings_record(reference: Reference, settings: FitSettings) -> ComparisonSettingsModel:
    whole = settings_record(reference, settings, SheetSettings())
    return ComparisonSettingsModel(
        cadpanel_version=whole.cadpanel_version,
        tilt=whole.tilt,
        gap_tolerance=whole.gap_tolerance,
        drift_along=whole.drift_along,
        drift_across=whole.drift_across,
        weights=whole.weights,
        restarts=whole.restarts,
        seed=whole.seed,
        seam_tolerance=whole.seam_tolerance,
    )


def _record(result: FitResult) -> ColumnModel:
    return ColumnModel(
        feature=result.settings.feature_name,
        method=result.settings.method,
        max_corner_gap=tuple(result.measures.widest_corners.tolist()),
        summary=summary(result.measures, result.local, result.settings),
        local_rms_deviation=result.local.overall_rms,
        seconds=result.seconds,
    )
