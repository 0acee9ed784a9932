"""The paper's objective (3): squares of gaps, deviations and drifts, weighed against each other."""

from __future__ import annotations

from cadpanel.fitting.objective import Objective
from cadpanel.fitting.problem import Problem
from cadpanel.fitting.settings import FitSettings, Weights
from cadpanel.terms.term import Term


def weighted_objective(problem: Problem, weights: Weights) -> Objective:
    """The paper's objective (3) with a weak pull on the corners, relative to the deviation's weight."""
    terms: list[Term] = [problem.deviation]
    for gap in problem.corner_gaps(1.0):
        gap.hold.weight[:] = weights.gap / weights.deviation
        terms.append(gap)
    for limit in problem.drift_limits(FitSettings(), 0.0):
        limit.hold.weight[:] = weights.drift / weights.deviation
        terms.append(limit)
    terms += problem.shop_limits(FitSettings())
    return Objective(problem, terms, coupled=True)
