"""The paper's objective (3): squares of gaps, deviations and drifts, weighed against each other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from cadpanel.arrays import Array
from cadpanel.fitting.methods.method import Fitted, Method, Progress
from cadpanel.fitting.methods.restarts import best_of_starts
from cadpanel.fitting.objective import Objective
from cadpanel.fitting.problem import Problem
from cadpanel.fitting.settings import FitSettings, Weights
from cadpanel.solver.levenberg_marquardt import Stopping, levenberg_marquardt
from cadpanel.terms.limits.catalogue import LIMITS
from cadpanel.terms.term import Term

# Steps at most from one start.
_ITERATIONS = 300


@dataclass(frozen=True, slots=True)
class Weighted(Method):
    """All panels and the gaps between them in one optimization of the paper's objective, which knows no tolerance.

    It takes the place of the concurrent method where the user gives weights, and has no name of its own.
    """

    def fit(
        self, problem: Problem, starts: Sequence[Array], settings: FitSettings, progress: Progress | None = None
    ) -> Fitted:
        """Fit all panels from their local fits, and from as many restarts as are asked for."""
        del progress
        model = weighted_objective(problem, settings.weights or Weights(), settings)

        def solve(start: Array) -> Fitted:
            solution = levenberg_marquardt(model, start, Stopping(iterations=_ITERATIONS))
            return Fitted(solution.unknowns, solution.iterations, solution.stopped)

        return best_of_starts(solve, lambda unknowns: float(model.cost(unknowns).sum()), starts[0], settings)


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
