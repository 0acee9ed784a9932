"""What gives way where not everything can be held: the order, and the search for how little.

Bounds of the unknowns and vectors that do not give way always hold. Then the largest |v| / tau of those that do is made
as small as possible: all of their distances are widened by one factor, which is narrowed down between one that can be
held and one that cannot. Only what holds is compared by its cost. Each connected component has a factor of its own:
what cannot be held in one opens nothing in another.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from cadpanel.arrays import Array, BoolArray
from cadpanel.solver.components import Components
from cadpanel.solver.ended import Best, Ended, Limits
from cadpanel.solver.held_model import HeldModel
from cadpanel.solver.interior_point import Told, interior_point
from cadpanel.solver.stop import Stop

# The factor is known closely enough where the next one would be nearer than this, and is looked for this often.
_CLOSE, _TRIES = 1.1, 16
# Steps at most for one factor, from the last one that held; no more than this is gained by a single one.
_STEPS, _MOST_NARROWED = 80, 1.7
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
        end: the unknowns, the multipliers, and what to go on from where distances change a little.
        stopped: why each connected component was not gone on with.
        iterations: linear systems solved, with those before it that it went on from.
    """

    end: Ended
    stopped: tuple[Stop, ...]
    iterations: int

    @property
    def unknowns(self) -> Array:
        """(count, size)."""
        return self.end.best.unknowns

    @property
    def excess(self) -> Array:
        """(components,) the largest |v| / tau of all; up to 1 where everything holds."""
        return np.maximum(self.end.best.firm, self.end.best.excess * self.end.ease)

    @property
    def held(self) -> bool:
        """Whether everything is held everywhere."""
        return all(stop is Stop.HELD for stop in self.stopped)

    def saying(self, why: Stop, where: BoolArray) -> HeldSolution:
        """The same with another reason in some components (components,)."""
        return replace(self, stopped=tuple(why if new else old for old, new in zip(self.stopped, where, strict=True)))


def hold_or_give_way(
    model: HeldModel,
    start: Array,
    limits: Limits,
    *,
    most_cost: Array | float = np.inf,
    only: BoolArray | None = None,
    after: HeldSolution | None = None,
    tell: Told | None = None,
) -> HeldSolution:
    """The smallest cost at which all held vectors stay within their distances, or those that must and the rest nearly.

    Args:
        model: cost and held vectors.
        start: (count, size) unknowns to begin with.
        limits: when to stop.
        most_cost: free cost that no distance is worth which may give way; of each component (components,), or one.
        only: (components,) those that move; all others stay as `after` left them. All move if it is None.
        after: a solution of the same model with slightly other distances, to go on from.
        tell: told of every step.
    """
    return _Search(model, limits, most_cost, tell).run(start, only, after)


class _Search:
    """The search for the least factors by which distances must be widened, in all components at once.

    Attributes:
        steps: linear systems solved so far.
        told: whether it was told to stop.
    """

    def __init__(self, model: HeldModel, limits: Limits, most_cost: Array | float, tell: Told | None) -> None:
        self._model, self._limits, self._tell = model, limits, tell
        self._blocks = Components.of(model.pattern)
        self._most_cost = most_cost
        self.steps, self.told = 0, False

    def run(self, start: Array, only: BoolArray | None, after: HeldSolution | None) -> HeldSolution:
        """See `hold_or_give_way`."""
        moving = np.ones(self._blocks.count, dtype=bool) if only is None else only
        first = self._steps_from(start, 1.0, moving, self._limits, after=None if after is None else after.end)
        if after is not None:
            first = after.end.mixed(first, moving, self._blocks)
        cheap = self._cheap(first.best)
        held = _holds(first.best) & cheap
        rest = moving & ~held
        told, kept = self.told, first
        if rest.any():
            kept = self._ended_early(start, first, rest) if told else self._opened(start, first, rest)
        why = [] if after is None else list(after.stopped)
        if not why:
            why = [Stop.HELD] * self._blocks.count
        for component in np.flatnonzero(moving):
            if held[component]:
                reason = Stop.HELD if first.settled[component] else Stop.STEP_LIMIT
                why[component] = Stop.TOLD if told else reason
            elif self.told:
                why[component] = Stop.TOLD
            elif _holds(kept.best, kept.ease)[component]:
                why[component] = Stop.HELD
            else:
                why[component] = Stop.TOO_COSTLY if _holds(first.best)[component] else Stop.STALLED
        before = 0 if after is None else after.iterations
        return HeldSolution(kept, tuple(why), before + self.steps)

    def _opened(self, start: Array, first: Ended, rest: BoolArray) -> Ended:
        """What holds with the narrowest distances in those components that do not hold them as they are."""
        search = replace(self._limits, steps=_STEPS)
        kept = first.mixed(self._steps_from(start, _FREE, rest, search), rest, self._blocks)
        lost = rest & (kept.best.firm > _HOLDS)
        if lost.any() and not self.told:  # from elsewhere it may be nearer
            other = self._steps_from(first.now.unknowns, _FREE, lost, search)
            kept = kept.mixed(other, lost & (other.best.firm < kept.best.firm), self._blocks)
            lost = rest & (kept.best.firm > _HOLDS)
        # What must hold cannot: whatever comes nearest.
        back = lost & (first.best.firm <= kept.best.firm)
        open_ = rest & ~lost
        nearer = first.best.excess < kept.best.excess * kept.ease
        back |= open_ & (first.best.firm <= _HOLDS) & self._cheap(first.best) & nearer
        return self._narrowed(kept.mixed(first, back, self._blocks), open_)

    def _narrowed(self, kept: Ended, open_: BoolArray) -> Ended:
        """The end with the narrowest distances that hold in some components."""
        search = replace(self._limits, steps=_STEPS)
        least, widest = np.zeros(self._blocks.count), np.maximum(kept.best.excess * kept.ease, 1.0)
        for _ in range(_TRIES):
            tried = open_ & (widest > np.maximum(_CLOSE * least, 1.0))
            if self.told or not tried.any():
                break
            trial = np.maximum.reduce([np.sqrt(least * widest), widest / _MOST_NARROWED, np.ones_like(widest)])
            end = self._steps_from(kept.best.unknowns, trial, tried, search)
            good = tried & _holds(end.best) & self._cheap(end.best)
            kept = kept.mixed(end, good, self._blocks)
            least = np.where(tried & ~good, trial, least)
            widest = np.where(good, np.maximum(trial * end.best.excess, 1.0), widest)
        return kept

    def _ended_early(self, start: Array, first: Ended, rest: BoolArray) -> Ended:
        """The best so far, after a few more steps that bring back what must not give way."""
        self._tell = None
        now = np.maximum(first.now.excess, 1.0)
        kept = self._better(first, self._steps_from(first.now.unknowns, now, rest, self._few(_LAST_STEPS)), rest)
        lost = rest & (kept.best.firm > _HOLDS)
        if lost.any():
            kept = self._better(kept, self._steps_from(start, _FREE, lost, self._few(_STEPS)), lost)
        return kept

    def _better(self, one: Ended, other: Ended, where: BoolArray) -> Ended:
        """The one in which what must hold is nearer to holding, or as near and the rest exceeded less."""
        firm, its_firm = (np.maximum(end.best.firm, _HOLDS) for end in (one, other))
        excess, its_excess = (end.best.excess * end.ease for end in (one, other))
        better = (its_firm < firm) | ((its_firm == firm) & (its_excess < excess))
        return one.mixed(other, where & better, self._blocks)

    def _few(self, steps: int) -> Limits:
        return replace(self._limits, steps=steps)

    def _cheap(self, best: Best) -> BoolArray:
        return np.asarray(best.cost <= self._most_cost)

    def _steps_from(
        self, start: Array, ease: Array | float, only: BoolArray, limits: Limits, after: Ended | None = None
    ) -> Ended:
        """Steps of some components with distances so many times as wide."""
        end = interior_point(self._model, start, limits, ease=ease, only=only, after=after, tell=self._tell)
        self.steps += end.steps
        self.told |= end.told_to_stop
        return end


def _holds(best: Best, ease: Array | float = 1.0) -> BoolArray:
    """(components,) where nothing exceeds distances that were widened by a factor, or nothing once it is 1."""
    return np.asarray(np.maximum(best.firm, best.excess) * ease <= _HOLDS)
