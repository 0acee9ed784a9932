"""The smallest deviation at which seams, drifts and what the shop can make keep to their limits."""

from __future__ import annotations

from collections.abc import Sequence

from cadpanel.arrays import Array
from cadpanel.fitting.methods.method import Fitted, Progress
from cadpanel.fitting.objective import Frozen, Objective
from cadpanel.fitting.problem import Problem, SeamTerm
from cadpanel.solver.constrained import Schedule, hold_tolerances
from cadpanel.terms.state import State
from cadpanel.terms.term import HeldTerm

# Gaps and drifts are held a little inside what the user allows, so that rounding in a file cannot break the promise.
MARGIN = 1e-3
# No gap is closed at an RMS deviation beyond this multiple of the local fits', or this share of a panel's length where
# the local fits are nearly exact: what comes then is no approximation of the reference any more.
_MOST_MULTIPLE = 5.0
_MOST_SHARE = 0.01
# Weights steer a little inside the tolerance, which costs next to no deviation and saves the long last approach.
AIM = 0.95
WHOLE = Schedule(aim=AIM)
FINISH = Schedule(aim=AIM, balance=10)


def seam_terms(problem: Problem, tolerance: float) -> list[SeamTerm]:
    """Everything that holds seams within `tolerance` mm."""
    return [*problem.corner_gaps(tolerance), *problem.curve_gaps(tolerance)]


class _Walker:
    """Walks the panels once for all that ask at the same unknowns, one after the other."""

    def __init__(self, problem: Problem) -> None:
        self._problem = problem
        self._last: tuple[Array, State] | None = None

    def state(self, unknowns: Array) -> State:
        if self._last is None or self._last[0] is not unknowns:
            self._last = (unknowns, self._problem.state(unknowns))
        return self._last[1]


class _HeldTerm:
    """A held term as the solver sees it: by the model's unknowns."""

    def __init__(self, walker: _Walker, term: HeldTerm) -> None:
        self.hold = term.hold
        self._walker, self._term = walker, term

    def vectors_at(self, unknowns: Array) -> Array:
        return self._term.vectors(self._walker.state(unknowns))


def balanced(
    problem: Problem,
    model: Objective | Frozen,
    held: Sequence[HeldTerm],
    start: Array,
    *,
    local: Array,
    progress: Progress | None = None,
    schedule: Schedule = WHOLE,
) -> Fitted:
    """Hold every held term within its tolerance, at the smallest deviation.

    Args:
        problem: the panels.
        model: the objective whose unknowns are moved.
        held: seams and limits, each with its tolerance.
        start: (panels, size) unknowns to begin from.
        local: (panels, size) the local fits; no result may deviate beyond a multiple of theirs.
        progress: told the round and the largest excess over a tolerance.
        schedule: how tolerances are steered at.
    """
    walker = _Walker(problem)
    terms = [_HeldTerm(walker, term) for term in held]

    def deviation(unknowns: Array) -> float:
        return float(problem.deviation.cost(walker.state(unknowns)).sum())

    best_alone = float(problem.deviation.cost(problem.state(local)).sum())
    most = max(_MOST_MULTIPLE**2 * best_alone, 0.5 * problem.panels * _MOST_SHARE**2)
    solution = hold_tolerances(model, terms, deviation, start, schedule, most_cost=most, progress=progress)
    return Fitted(solution.unknowns, solution.iterations, solution.stopped)
