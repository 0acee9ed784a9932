"""The paper's objective (3): squares of gaps, deviations and drifts, weighed against each other."""

from __future__ import annotations

from cadpanel.fitting.objective import Objective
from cadpanel.fitting.problem import Problem
from cadpanel.fitting.settings import FitSettings, Weights
from cadpanel.terms.limits.catalogue import LIMITS
from cadpanel.terms.term import Term


def weighted_objective(problem: Problem, weights: Weights, settings: FitSettings) -> Objective:
    """The paper's objective (3) with a weak pull on the corners, relative to the deviation's weight.

    Args:
        problem: the panels.
        weights: of gaps, deviation and drift.
        settings: with the limits that no weight is given for.
    """
    terms: list[Term] = [problem.deviation]
    for gap in problem.corner_gaps(1.0):
        gap.hold.weight[:] = weights.gap / weights.deviation
        terms.append(gap)
    for limit in LIMITS:
        for held in limit.held(problem, settings.allowed, 0.0):
            if limit.weight is not None:
                held.hold.weight[:] = getattr(weights, limit.weight) / weights.deviation
            terms.append(held)
    return Objective(problem, terms, coupled=True)
