"""The paper's Table 1 for one reference: two-stage and concurrent, each with cylinders and with cones."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from cadpanel.delivery.folder import delivery_folder
from cadpanel.delivery.names import COMPARISON
from cadpanel.delivery.records.comparison import ColumnModel, ComparisonModel, ComparisonSettingsModel, write_comparison
from cadpanel.delivery.records.from_fit import reference_record, seam_names, settings_record
from cadpanel.delivery.records.summary import summary
from cadpanel.delivery.settings import SheetSettings
from cadpanel.fitting.result import FitResult, fit
from cadpanel.fitting.settings import FitSettings, Method
from cadpanel.reference.model import Reference

METHODS: tuple[Method, ...] = ("two_stage", "concurrent")
FEATURES = ("plane-cylinder-plane", "plane-cone-plane")

# The column (feature and method) that is being fitted, the round, and the largest excess over a tolerance.
Progress = Callable[[str, str, int, float], None]


def compare(
    reference: Reference, settings: FitSettings | None = None, *, progress: Progress | None = None
) -> ComparisonModel:
    """Fit a reference four ways under the same tolerance and limits.

    Args:
        reference: what is to be approximated.
        settings: tolerance, limits, tilt and restarts; its feature and method are not used.
        progress: told when a column begins (round 0), and of every round of a concurrent fit.

    Raises:
        PanelError: a panel's faces are nothing that a feature could approximate.
    """
    how = settings or FitSettings()
    columns = tuple(_column(reference, how, feature, method, progress) for method in METHODS for feature in FEATURES)
    return ComparisonModel(
        reference=reference_record(reference),
        settings=_settings_record(reference, how),
        seams=seam_names(reference),
        columns=columns,
    )


def write_comparison_folder(comparison: ComparisonModel, out: Path, *, overwrite: bool = False) -> None:
    """Write a folder with compare.json, whole or not at all.

    Raises:
        DeliveryError: the folder is refused or cannot be written.
    """
    with delivery_folder(out, overwrite=overwrite) as folder:
        write_comparison(comparison, folder / COMPARISON)


def _column(
    reference: Reference, settings: FitSettings, feature: str, method: Method, progress: Progress | None
) -> ColumnModel:
    def tell(_method: str, round_: int, excess: float) -> None:
        if progress is not None:
            progress(feature, method, round_, excess)

    tell(method, 0, 0.0)
    result = fit(reference, replace(settings, feature=feature, method=method, max_deviation=None), tell)
    return _record(result)


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
