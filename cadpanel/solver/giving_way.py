"""What gives way where not everything can be held: the order, and the search for how little.

Bounds of the unknowns and vectors that do not give way always hold. Then the largest |v| / tau of those that do is made
as small as possible: all of their distances are widened by one factor, which is narrowed down between one that can be
held and one that cannot. Only what holds is compared by its cost.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from cadpanel.arrays import Array
from cadpanel.solver.held_model import HeldModel
from cadpanel.solver.interior_point import Ended, Limits, Told, interior_point
from cadpanel.solver.stop import Stop

# The factor is known closely enough where the next one would be nearer than this, and is looked for this often.
_CLOSE, _TRIES = 1.1, 16
# Steps at most for one factor, from the last one that held; no more than this is gained by a single one.
_STEPS, _MOST_NARROWED = 80, 1.7
# Steps at most where it goes on from an end: a dozen do, or none will, and it has to begin anew.
_RESUMED = 30
# Steps after it was told to end.
_LAST_STEPS = 12
# So wide that nothing which may give way is held at all.
_FREE = 1e6
# A result that exceeds its distances by less holds them: what is asked for is asked for with a margin.
_HOLDS = 1.0 + 1e-6


@dataclass(frozen=True, slots=True)
class HeldSolution:
    """What was reached.

    Attributes:
        unknowns: (count, size).
        excess: the largest |v| / tau of all; up to 1 where everything holds.
        iterations: linear systems solved.
        stopped: why it was not gone on.
        end: the multipliers, and what to go on from where distances change a little.
    """

    unknowns: Array
    excess: float
    iterations: int
    stopped: Stop
    end: Ended


def hold_or_give_way(
    model: HeldModel,
    start: Array,
    limits: Limits,
    *,
    most_cost: float = np.inf,
    after: Ended | None = None,
    tell: Told | None = None,
) -> HeldSolution:
    """The smallest cost at which all held vectors stay within their distances, or those that must and the rest nearly.

    Args:
        model: cost and held vectors.
        start: (count, size) unknowns to begin with.
        limits: when to stop.
        most_cost: free cost that no distance is worth which may give way.
        after: an end of the same model with slightly other distances, to go on from.
        tell: told of every step.
    """
    ready = limits if after is None else replace(limits, steps=min(limits.steps, _RESUMED))
    first = interior_point(model, start, ready, after=after, tell=tell)
    best, cheap = first.best, first.best.cost <= most_cost
    holds, firm = max(best.firm, best.excess) <= _HOLDS, best.firm <= _HOLDS
    if holds and cheap:
        why = Stop.HELD if first.settled else Stop.STEP_LIMIT
        return _solution(first, 1.0, first.steps, Stop.TOLD if first.told_to_stop else why)
    if first.told_to_stop:
        return _ended_early(model, start, limits, first)
    search = _Search(model, replace(limits, steps=_STEPS), tell, first.steps)
    kept, ease = search.run(start, _FREE), _FREE
    if kept.best.firm > _HOLDS and not search.stopped:  # from elsewhere it may be nearer
        other = search.run(first.now.unknowns, _FREE)
        kept = other if other.best.firm < kept.best.firm else kept
    if kept.best.firm > _HOLDS:  # what must hold cannot: whatever comes nearest
        nearer = first if best.firm <= kept.best.firm else kept
        return _solution(nearer, 1.0 if nearer is first else ease, search.steps, Stop.STALLED)
    if firm and cheap and best.excess < kept.best.excess * ease:
        kept, ease = first, 1.0
    kept, ease = search.narrowed(kept, ease, most_cost)
    why = Stop.TOO_COSTLY if holds else Stop.STALLED
    if ease * max(kept.best.excess, kept.best.firm) <= _HOLDS:
        why = Stop.HELD
    return _solution(kept, ease, search.steps, Stop.TOLD if search.stopped else why)


def _ended_early(model: HeldModel, start: Array, limits: Limits, first: Ended) -> HeldSolution:
    """The best so far, after a few more steps that bring back what must not give way."""
    search = _Search(model, replace(limits, steps=_LAST_STEPS), None, first.steps)
    now = max(first.now.excess, 1.0)
    ends = [(first, 1.0), (search.run(first.now.unknowns, now), now)]
    if all(end.best.firm > _HOLDS for end, _ in ends):
        search = _Search(model, replace(limits, steps=_STEPS), None, search.steps)
        ends.append((search.run(start, _FREE), _FREE))
    end, ease = min(ends, key=lambda one: (max(one[0].best.firm, _HOLDS), one[0].best.excess * one[1]))
    return _solution(end, ease, search.steps, Stop.TOLD)


def _solution(end: Ended, ease: float, steps: int, stopped: Stop) -> HeldSolution:
    best = end.best
    return HeldSolution(best.unknowns, max(best.firm, best.excess * ease), steps, stopped, end)


class _Search:
    """The search for the least factor by which distances must be widened.

    Attributes:
        steps: linear systems solved so far.
        stopped: whether it was told to stop.
    """

    def __init__(self, model: HeldModel, limits: Limits, tell: Told | None, steps: int) -> None:
        self.steps, self.stopped = steps, False
        self._model, self._limits, self._tell = model, limits, tell

    def narrowed(self, kept: Ended, ease: float, most_cost: float) -> tuple[Ended, float]:
        """The end with the narrowest distances that hold, and by which factor they are widened; 1 if it found a way."""
        least, widest = 0.0, max(kept.best.excess * ease, 1.0)
        for _ in range(_TRIES):
            if self.stopped or widest <= max(_CLOSE * least, 1.0):
                break
            trial = max(float(np.sqrt(least * widest)), widest / _MOST_NARROWED, 1.0)
            end = self.run(kept.best.unknowns, trial)
            if max(end.best.firm, end.best.excess) <= _HOLDS and end.best.cost <= most_cost:
                kept, ease, widest = end, trial, max(trial * end.best.excess, 1.0)
            else:
                least = trial
        return kept, ease

    def run(self, start: Array, ease: float) -> Ended:
        """Steps with distances so many times as wide."""
        end = interior_point(self._model, start, self._limits, ease=ease, tell=self._tell)
        self.steps += end.steps
        self.stopped |= end.told_to_stop
        return end
