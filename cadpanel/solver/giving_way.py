"""What gives way where not everything can be held: the order, and the search for how little.

Bounds of the unknowns and vectors that do not give way always hold. Then the largest |v| / tau of those that do is made
as small as possible: all of their distances are widened by one factor, which is narrowed down between one that can be
held and one that cannot. Only what holds is compared by its cost. Each connected component has a factor of its own:
what cannot be held in one opens nothing in another.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from cadpanel.arrays import Array, BoolArray
from cadpanel.solver.components import Components
from cadpanel.solver.ended import Best, Ended, Limits
from cadpanel.solver.held_model import HeldModel
from cadpanel.solver.interior_point import Told, interior_point
from cadpanel.solver.one_thread import on_one_thread
from cadpanel.solver.stop import Stop

# The factor is known closely enough where the next one would be nearer than this, and is looked for this often.
_CLOSE, _TRIES = 1.05, 20
# Steps at most for one factor, from the last one that held; no more than this is gained by a single one.
_STEPS, _MOST_NARROWED = 80, 1.7
# After so many that bring it no nearer, what must hold is given up where nothing can give way.
IDLE = 20
# Steps at most where it goes on from an end: a dozen do, or none will, and it has to begin anew.
_RESUMED = 30
# Steps after it was told to end.
_LAST_STEPS = 12
# By which factor the cost may rise that holding what must hold takes by itself.
_AGAIN = 2.0
# So many of a component's lengths wide, nothing which may give way is held at all.
_FREE = 1e4
# To so many digits distances are what they are beside each other.
_DIGITS = 9
# A result that exceeds its distances by less holds them: what is asked for is asked for with a margin.
_HOLDS = 1.0 + 1e-6


Elsewhere = Callable[[BoolArray, Array], tuple[Array, int]]
"""Told which blocks (count,) do not hold what they must, and unknowns; other unknowns at which these do, as far as they
can by themselves, and how many linear systems were solved for them."""


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

    def mixed(self, other: HeldSolution, where: BoolArray, blocks: Components) -> HeldSolution:
        """Another one of the same vectors in some components (components,), this one in the rest."""
        stopped = tuple(two if new else one for one, two, new in zip(self.stopped, other.stopped, where, strict=True))
        return HeldSolution(self.end.mixed(other.end, where, blocks), stopped, self.iterations + other.iterations)


@on_one_thread
def hold_or_give_way(
    model: HeldModel,
    start: Array,
    limits: Limits,
    *,
    most_cost: Array | float = np.inf,
    only: BoolArray | None = None,
    after: HeldSolution | None = None,
    elsewhere: Elsewhere | None = None,
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
        elsewhere: where to begin anew if what must hold does not.
        tell: told of every step.
    """
    return _Search(model, limits, most_cost, elsewhere, tell).run(start, only, after)


class _Search:
    """The search for the least factors by which distances must be widened, in all components at once.

    Attributes:
        steps: linear systems solved so far.
        told: whether it was told to stop.
        costly: (components,) where something narrower held, but cost too much.
    """

    def __init__(
        self,
        model: HeldModel,
        limits: Limits,
        most_cost: Array | float,
        elsewhere: Elsewhere | None,
        tell: Told | None,
    ) -> None:
        self._model, self._limits, self._elsewhere, self._tell = model, limits, elsewhere, tell
        self._blocks = Components.of(model.pattern)
        self._gives_way = any(one.hold.gives_way for one in model.held)
        self._most_cost = most_cost
        self._asked: Array | float = 1.0
        self.steps, self.told = 0, False
        self.costly = np.zeros(self._blocks.count, dtype=bool)

    def run(self, start: Array, only: BoolArray | None, after: HeldSolution | None) -> HeldSolution:
        """See `hold_or_give_way`."""
        moving = np.ones(self._blocks.count, dtype=bool) if only is None else only
        if after is None:
            first = self._steps_from(start, 1.0, moving, self._limits)
        else:
            few = self._few(min(self._limits.steps, _RESUMED))
            first = after.end.mixed(self._steps_from(start, 1.0, moving, few, after=after.end), moving, self._blocks)
        held = _holds(first.best) & self._cheap(first.best)
        rest = moving & ~held
        self.costly |= rest & _holds(first.best)
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
                why[component] = Stop.TOO_COSTLY if self.costly[component] else Stop.STALLED
        before = 0 if after is None else after.iterations
        return HeldSolution(kept, tuple(why), before + self.steps)

    def _opened(self, start: Array, first: Ended, rest: BoolArray) -> Ended:
        """What holds with the narrowest distances in those components that do not hold them as they are."""
        if not self._gives_way:
            return first if self._elsewhere is None else self._brought_back(first, first.now.unknowns, rest)
        with _AskedNothing(self._model, self._blocks) as self._asked:
            kept = first.mixed(self._steps_from(start, _FREE, rest, self._few(_STEPS)), rest, self._blocks)
            kept = self._brought_back(kept, first.now.unknowns, rest)
            # Where what must hold costs more by itself, the rest may cost as much again.
            self._most_cost = np.where(rest, np.maximum(self._most_cost, _AGAIN * kept.best.cost), self._most_cost)
            lost = kept.best.firm > _HOLDS
            kept = self._narrowed(kept, rest & ~lost, self._asked)
        self._asked = 1.0
        # As it is beside what was asked for; and where what must hold cannot, whatever comes nearest.
        kept = first.mixed(self._steps_from(kept.best.unknowns, 1.0, rest, self._few(0)), rest, self._blocks)
        return kept.mixed(first, rest & lost & (first.best.firm <= kept.best.firm), self._blocks)

    def _brought_back(self, kept: Ended, now: Array, where: BoolArray) -> Ended:
        """The same, from elsewhere where what must hold does not: the caller knows where, or else from `now`."""
        lost = where & (kept.best.firm > _HOLDS)
        if not lost.any():
            return kept
        if self._elsewhere is not None:
            now, steps = self._elsewhere(lost[self._blocks.label], kept.now.unknowns)
            self.steps += steps
        return self._better(kept, self._steps_from(now, _FREE, lost, self._few(_STEPS)), lost)

    def _narrowed(self, kept: Ended, open_: BoolArray, asked: Array) -> Ended:
        """The end with the narrowest distances that hold in some components, or those that were asked for."""
        least, widest = np.zeros(self._blocks.count), kept.best.excess * kept.ease
        for _ in range(_TRIES):
            tried = open_ & (widest > np.maximum(_CLOSE * least, asked))
            if self.told or not tried.any():
                break
            trial = np.maximum(np.sqrt(least * widest), widest / _MOST_NARROWED)
            end = self._steps_from(kept.best.unknowns, trial, tried, self._few(_STEPS))
            reached = trial * end.best.excess
            nearer = tried & (end.best.firm <= _HOLDS) & (reached < widest)
            self.costly |= nearer & ~self._cheap(end.best)
            nearer &= self._cheap(end.best)
            # What came much nearer without holding had too few steps: it is gone on with from there.
            much = nearer & ((reached <= _HOLDS * trial) | (_CLOSE * reached < widest))
            least = np.where(tried & ~much, trial, least)
            kept = kept.mixed(end, nearer, self._blocks)
            widest = np.where(nearer, reached, widest)
        return kept

    def _ended_early(self, start: Array, first: Ended, rest: BoolArray) -> Ended:
        """The best so far, after a few more steps that bring back what must not give way."""
        self._tell = None
        now = np.maximum(first.now.excess, 1.0)
        kept = self._better(first, self._steps_from(first.now.unknowns, now, rest, self._few(_LAST_STEPS)), rest)
        lost = rest & (kept.best.firm > _HOLDS)
        if lost.any():
            kept = self._better(kept, self._steps_from(start, _FREE, lost, self._few(_STEPS)), lost)
        return self._brought_back(kept, first.now.unknowns, rest)

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
        end = interior_point(
            self._model, start, limits, ease=ease, only=only, after=after, asked=self._asked, tell=self._tell
        )
        self.steps += end.steps
        self.told |= end.told_to_stop
        return end


class _AskedNothing:
    """Distances that may give way as long as the components themselves, in place of those that were asked for.

    The search for the least widening is the same then to the last digit whatever was asked for: who holds narrow
    distances holds wide ones, and what cannot be held is exceeded by as much. Only what they are beside each other
    stays.
    """

    def __init__(self, model: HeldModel, blocks: Components) -> None:
        self._giving = [one for one in model.held if one.hold.gives_way]
        self._radii = [one.hold.radius for one in self._giving]
        self._of = [blocks.seen_by(one.blocks[0]) for one in self._giving]
        self._lengths, narrowest = blocks.mean(model.lengths), np.full(blocks.count, np.inf)
        for of, radius in zip(self._of, self._radii, strict=True):
            narrowest = np.minimum(narrowest, of.smallest(radius))
        self._narrowest = np.where(np.isfinite(narrowest), narrowest, self._lengths)

    def __enter__(self) -> Array:
        """(components,) what was asked for, by the lengths of the components."""
        for one, of, radius in zip(self._giving, self._of, self._radii, strict=True):
            beside = np.round(radius / of.each(self._narrowest), _DIGITS)
            one.hold.radius = beside * of.each(self._lengths)
        return np.asarray(self._narrowest / self._lengths)

    def __exit__(self, *_: object) -> None:
        """Ask for the same as before."""
        for one, radius in zip(self._giving, self._radii, strict=True):
            one.hold.radius = radius


def _holds(best: Best, ease: Array | float = 1.0) -> BoolArray:
    """(components,) where nothing exceeds its distance, though those that give way were widened by a factor."""
    return np.asarray(np.maximum(best.firm, best.excess * ease) <= _HOLDS)
