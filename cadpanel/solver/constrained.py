"""Least squares with held vectors: Levenberg-Marquardt inside, weights adapted outside."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Protocol

import numpy as np

from cadpanel.arrays import Array
from cadpanel.solver.levenberg_marquardt import Model, Stopping, levenberg_marquardt
from cadpanel.solver.stop import Stop
from cadpanel.solver.tolerance_weights import Hold


class Held(Protocol):
    """Vectors of the model that are to stay within distances."""

    hold: Hold

    def vectors_at(self, unknowns: Array) -> Array:
        """(groups, vectors, d) at the unknowns."""
        ...


@dataclass(frozen=True, slots=True, kw_only=True)
class Schedule:
    """How long the weights are adapted, and by which residuals of the Karush-Kuhn-Tucker conditions they come to rest.

    The conditions are stationarity of the cost and feasibility of what is held (Nocedal and Wright, Numerical
    Optimization, 2nd ed. 2006, chapters 12 and 17).

    Attributes:
        balance: rounds at most in which weights rise and fall.
        close: rounds at most after these in which weights only rise, until everything holds.
        stationarity: relative change of the free cost between two rounds below which it is at rest.
        feasibility: how far above its distance a vector may be for the balance to end.
        aim: share of the distances that the weights steer to.
        patience: rounds without a smaller total violation after which it moves on: from balance to close, from close to
            an end.
        inner: stopping of the solve in a round.
    """

    balance: int = 60
    close: int = 40
    stationarity: float = 2e-3
    feasibility: float = 1e-3
    aim: float = 1.0
    patience: int = 20
    inner: Stopping = field(default_factory=lambda: Stopping(cost=1e-3, iterations=5))


@dataclass(frozen=True, slots=True)
class HeldSolution:
    """What was reached.

    Attributes:
        unknowns: (count, size).
        iterations: linear systems solved in all rounds.
        rounds: the round it was reached in.
        excess: the largest |v| / tau that is left; up to 1 where everything holds.
        stopped: why no further round was made.
    """

    unknowns: Array
    iterations: int
    rounds: int
    excess: float
    stopped: Stop


def hold_tolerances(
    model: Model,
    held: Sequence[Held],
    free_cost: Callable[[Array], float],
    start: Array,
    schedule: Schedule,
    *,
    most_cost: float = np.inf,
    progress: Callable[[int, float], None] | None = None,
) -> HeldSolution:
    """The smallest free cost at which all held vectors stay within their distances.

    Args:
        model: free cost and held terms together.
        held: the held terms.
        free_cost: the cost without the held terms, to see when it comes to rest.
        start: unknowns to begin with.
        schedule: how long to go on.
        most_cost: free cost that no tolerance is worth. Where the vectors cannot be held below it, the result is the
            best that was found below it.
        progress: called after every round with its number and the largest |v| / tau.
    """
    unknowns, iterations, last = start, 0, np.inf
    best: HeldSolution | None = None
    closing_from, improved, least = schedule.balance, 0, np.inf
    stopped = Stop.STEP_LIMIT
    for round_ in range(1, schedule.balance + schedule.close + 1):
        solution = levenberg_marquardt(model, unknowns, schedule.inner)
        unknowns, iterations = solution.unknowns, iterations + solution.iterations
        vectors = [term.vectors_at(unknowns) for term in held]
        excess, cost = _excess(held, vectors), free_cost(unknowns)
        if progress is not None:
            progress(round_, excess)
        if cost > most_cost:
            stopped = Stop.TOO_COSTLY
            break
        closing = round_ > closing_from
        at_rest = abs(cost - last) <= schedule.stationarity * cost
        if excess <= 1.0 + (0.0 if closing else schedule.feasibility) and (closing or at_rest):
            return HeldSolution(unknowns, iterations, round_, excess, Stop.HELD)
        # All that holds is equally good; of these the last one is the most settled.
        violation = sum(term.hold.violation(v) for term, v in zip(held, vectors, strict=True))
        if violation < least:
            least, improved = violation, round_
        if best is None or max(excess, 1.0) <= max(best.excess, 1.0):
            best = HeldSolution(unknowns, iterations, round_, excess, stopped)
        if round_ - max(improved, closing_from if closing else 0) >= schedule.patience:
            if closing:
                stopped = Stop.STALLED
                break
            closing_from = round_
        last = cost
        for term, v in zip(held, vectors, strict=True):
            term.hold.adapt(v, only_grow=closing, aim=schedule.aim)
    if best is None:
        best = HeldSolution(start, 0, 0, _excess(held, [term.vectors_at(start) for term in held]), stopped)
    return replace(best, iterations=iterations, stopped=stopped)


def _excess(held: Sequence[Held], vectors: Sequence[Array]) -> float:
    return max((term.hold.excess(v) for term, v in zip(held, vectors, strict=True)), default=0.0)
