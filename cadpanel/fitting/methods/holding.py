"""The smallest deviation at which seams, drifts and what the shop can make keep to their limits."""

from __future__ import annotations

import numpy as np

from cadpanel.arrays import Array, BoolArray
from cadpanel.fitting.methods.method import Progress
from cadpanel.fitting.objective import HeldObjective
from cadpanel.fitting.problem import Problem, SeamTerm
from cadpanel.solver.components import Components
from cadpanel.solver.ended import Limits
from cadpanel.solver.giving_way import Elsewhere, HeldSolution, hold_or_give_way
from cadpanel.solver.stop import Stop

# Gaps and drifts are held a little inside what the user allows, so that rounding in a file cannot break the promise.
MARGIN = 1e-3
# No gap is closed at an RMS deviation beyond this multiple of the local fits', or this share of a panel's length where
# the local fits are nearly exact: what comes then is no approximation of the reference any more.
_MOST_MULTIPLE = 5.0
_MOST_SHARE = 0.05
# A panel that deviates by no more than this share of its length, RMS, is exact.
EXACT = 1e-8


def seam_terms(problem: Problem, tolerance: float) -> list[SeamTerm]:
    """Everything that holds seams within `tolerance` mm."""
    return [*problem.corner_gaps(tolerance), *problem.curve_gaps(tolerance)]


def gap_price(problem: Problem, model: HeldObjective, found: HeldSolution, tolerance: float) -> float:
    """By how much one mm more of gap tolerance would lower the RMS deviation, mm, to first order.

    A multiplier w is the weight of |v|^2 / 2 that holds the vector v at its distance r: where all distances grow by a
    share, the cost falls by the sum of all w r^2 times that share (the envelope theorem).

    Args:
        problem: the panels.
        model: what was held.
        found: where it ended.
        tolerance: of gaps, mm.
    """
    pull = np.zeros(problem.panels)
    for term, weight in zip(model.held, found.end.multipliers, strict=True):
        if term.hold.gives_way:
            pull += np.bincount(term.blocks[0], np.sum(weight * term.hold.radius**2, axis=1), minlength=problem.panels)
    rms = problem.rms(problem.deviation.cost(problem.state(found.unknowns)))
    fallen = problem.place.length * float(problem.areas @ pull)
    return fallen / (problem.panels * rms * tolerance) if rms > EXACT else 0.0


def held_within(
    problem: Problem,
    model: HeldObjective,
    start: Array,
    *,
    local: Array,
    only: BoolArray | None = None,
    after: HeldSolution | None = None,
    tell: Progress | None = None,
    elsewhere: Elsewhere | None = None,
    costly: bool = True,
) -> HeldSolution:
    """Hold every held term within its tolerance, at the smallest deviation.

    Args:
        problem: the panels.
        model: what is to be small, and what is held.
        start: (panels, size) unknowns to begin from.
        local: (panels, size) the local fits; no result may deviate beyond a multiple of theirs.
        only: (components,) which connected components are to be gone on with; all where it is None.
        after: a solution with slightly other tolerances to go on from.
        elsewhere: see `solver.giving_way`.
        costly: whether a deviation may be too large for any tolerance; not where only what panels must keep to is held.
        tell: told the step, the largest excess over a tolerance, and the RMS deviation in mm; whether to go on.
    """
    blocks = Components.of(model.pattern)
    alone = blocks.total(problem.deviation.cost(problem.state(local)))
    # Half the squares of all panels' lengths: shares of a length count against them.
    lengths = 0.5 * blocks.total(model.lengths**2)
    most = np.maximum(_MOST_MULTIPLE**2 * alone, lengths * _MOST_SHARE**2) if costly else np.inf

    def told(step: int, excess: float, cost: Array) -> bool:
        return tell is None or tell(step, excess, problem.rms(cost) * problem.place.length)

    begin = model.starting_from(start)
    limits = Limits(least_cost=lengths * EXACT**2)
    return hold_or_give_way(
        model, begin, limits, most_cost=most, only=only, after=after, elsewhere=elsewhere, tell=told
    )


def stopped_as(found: HeldSolution) -> Stop:
    """Why all of it stopped: as what exceeds its tolerance most, or else as whatever did not come to rest."""
    if (found.excess > 1.0).any():
        return found.stopped[int(found.excess.argmax())]
    return next((stop for stop in found.stopped if stop is not Stop.HELD), Stop.HELD)
