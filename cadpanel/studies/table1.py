"""The paper's Table 1 for one reference: two-stage and concurrent, each with cylinders and with cones."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from cadpanel.fitting.result import FitResult
from cadpanel.fitting.run import fit
from cadpanel.fitting.settings import LIKE_THE_PAPER, FitSettings, Method
from cadpanel.reference.model import Reference

METHODS: tuple[Method, ...] = ("two_stage", "concurrent")
FEATURES = ("plane-cylinder-plane", "plane-cone-plane")

# The column (feature and method) that is being fitted, the round, and the largest excess over a tolerance.
Progress = Callable[[str, str, int, float, float], None]


def compare(
    reference: Reference, settings: FitSettings | None = None, *, progress: Progress | None = None
) -> tuple[FitResult, ...]:
    """Fit a reference four ways under the same tolerance and limits: one result a column of the table.

    Args:
        reference: what is to be approximated.
        settings: tolerance, limits, tilt and restarts, by default `LIKE_THE_PAPER`; its feature and method are not
            used.
        progress: told when a column begins (step 0), and of every step of a concurrent fit.

    Raises:
        PanelError: a panel's faces are nothing that a feature could approximate.
    """
    how = settings or LIKE_THE_PAPER
    return tuple(_column(reference, how, feature, method, progress) for method in METHODS for feature in FEATURES)


def _column(
    reference: Reference, settings: FitSettings, feature: str, method: Method, progress: Progress | None
) -> FitResult:
    def tell(_method: str, step: int, excess: float, rms: float) -> None:
        if progress is not None:
            progress(feature, method, step, excess, rms)

    tell(method, 0, 0.0, 0.0)
    return fit(reference, replace(settings, feature=feature, method=method, max_deviation=None), tell)
