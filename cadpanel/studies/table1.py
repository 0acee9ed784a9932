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
        settings: tolerance, limits, rules, tilt and restarts, by default `LIKE_THE_PAPER`; its feature and method are
            not used. Two stages hold no rules but those that give panels features; what comes of the others is
            measured all the same.
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
    how = replace(settings, feature=feature, max_deviation=None)
    if method == "concurrent":
        return fit(reference, how, tell)
    return _measured(fit(reference, how.alone(method), tell), how)


def _measured(result: FitResult, settings: FitSettings) -> FitResult:
    """A result whose method holds no rules, with what came of them."""
    if settings.rules is None:
        return result
    names, corners = zip(*((panel.name, len(panel.edges)) for panel in result.reference.panels), strict=True)
    posed = settings.rules.pose(result.reference, settings.features_for(names, corners))
    outcomes = tuple(rule.outcome(result.measures) for rule in posed)
    met = result.tolerance_met and all(outcome.kept for outcome in outcomes)
    return replace(result, outcomes=outcomes, tolerance_met=met)
