"""Least squares with vectors held within distances: an elastic primal-dual interior point on the Gauss-Newton model.

One linearization and one factorization a step. Distances begin as wide as the vectors are long and narrow to what is
asked for while the steps go on: what is far open cannot be closed at once, for the way there is curved. Where the
vectors turned out other than a step foretold, the step is bent once with the same factors (a second-order correction;
Nocedal and Wright, Numerical Optimization, 2nd ed. 2006, section 18.3): a tube of a millimetre about a curved way lets
straight steps go but a few centimetres.

Each connected component goes its own way: it has a barrier and distances, damping and an end of its own, and ends where
it would end alone. What a step spoils in one place is not undone in another, see `solver.levenberg_marquardt`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from cadpanel.arrays import Array, BoolArray
from cadpanel.solver.barrier import Barriers, Work
from cadpanel.solver.blocks import Normal
from cadpanel.solver.bounds import BoundedStep, bounded_step
from cadpanel.solver.components import Components
from cadpanel.solver.ended import LEAST_DAMPING, Ended, Limits
from cadpanel.solver.held_model import HeldModel
from cadpanel.solver.held_rows import HeldRows
from cadpanel.solver.merit import Merit, Place
from cadpanel.solver.nielsen import FIRST_GROWTH, Nielsen

# Damping: a share of the free cost's own Gauss-Newton matrix, and how much of its diagonal's unit stands in for rows of
# zeros. It never falls below what `Limits` say: constraints that change sides from step to step would let it oscillate.
_DAMPING = Nielsen(least=LEAST_DAMPING, most=1e6, drop=0.2, rise=2.0)
_IDLE = 1e-4
# After so many refusals that damping grows by this factor, multipliers begin anew.
_STUCK = 16.0
# The barrier begins with this share of the cost, falls by this factor whenever the steps settle, and ends where all its
# logarithms together are worth this share of the cost.
_BARRIER, _BARRIER_DROP, _BARRIER_END = 0.15, 0.4, 2e-3
# Multipliers may reach this multiple of the barrier's parameter, and more where that does not suffice.
_ELASTIC, _ELASTIC_RISE = 100.0, 3.0
# Distances follow the vectors down to this share of them a step, such that steps have about this length.
_LAG, _LEAST_LAG, _MOST_LAG, _STEP, _LAG_POWER = 0.8, 0.6, 0.95, 0.1, 0.3
# Steps have settled where they gain at least this share of what they promise, and promise no more than these shares.
_GAIN, _READY, _SHARE_LEFT = 0.25, 0.1, 3e-4
# Damped by this and more, steps lead nowhere: multipliers that rose far beyond what the cost is worth leave no way but
# along what they hold. Barrier and damping begin anew at the best point then, so many times at most.
_WEDGED, _ANEW = 1e5, 3
# The barrier falls where nothing exceeds its distance by more than the first factor. Until then it begins anew where
# the cost has become so many times what it began with.
_NEAR, _TOO_LOW = 1.2, 4.0
# What exceeds its distances by as much as this share of what it did has made no headway.
_NEARER = 0.95
# Distances that may give way are not narrowed while what must hold exceeds its own by more than the first share, unless
# it is this many times too long.
_FIRMLY, _FIRM_YET = 1e-3, 1.5
# A correction longer than this share of the step is none.
_BENT = 0.5
# A cost of this size is none.
_TINY = 1e-30
# The cost of a start that costs nothing itself is taken for this share of the squares of what is too long.
_OPEN = 0.005

Told = Callable[[int, float, Array], bool]
"""Told the step, the largest |v| / tau and the costs (count,) of the blocks; whether to go on."""


def interior_point(
    model: HeldModel,
    start: Array,
    limits: Limits,
    *,
    ease: Array | float = 1.0,
    only: BoolArray | None = None,
    after: Ended | None = None,
    asked: Array | float = 1.0,
    tell: Told | None = None,
) -> Ended:
    """The smallest cost at which all held vectors stay within their distances.

    Args:
        model: cost and held vectors.
        start: (count, size) unknowns to begin with.
        limits: when to stop.
        ease: distances that may give way count so many times as wide; one for each component (components,), or one.
        only: (components,) those that move; all others stay where they start. All move if it is None.
        after: an end of the same model with slightly other distances, to begin with its multipliers.
        asked: the share of their distances, one for each component or one, that what is told of excesses counts by.
        tell: told of every step.
    """
    return _Run(model, start, limits, ease, only, after).ended(asked, tell)


class _Run:
    """The steps from one start.

    Attributes:
        goes_on: (components,) which ones still move.
    """

    def __init__(
        self,
        model: HeldModel,
        start: Array,
        limits: Limits,
        ease: Array | float,
        only: BoolArray | None,
        after: Ended | None,
    ) -> None:
        self.model, self.limits = model, limits
        self.rule = replace(_DAMPING, least=limits.least_damping)
        self.pattern, self.bounds = model.pattern, model.bounds
        self.blocks = Components.of(self.pattern)
        count = self.blocks.count
        self.ease = np.broadcast_to(ease, count).astype(np.float64)
        self.goes_on = np.ones(count, dtype=bool) if only is None else only.copy()
        self.moving = self.goes_on.copy()
        self.settled = np.zeros(count, dtype=bool)
        self.least = np.broadcast_to(limits.least_cost, count)
        point = model.at(np.where(self.blocks.each(self.moving), self.bounds.clip(start), start))
        self.held = HeldRows.of_batches(model.held, point.vectors, self.pattern.count, len(self.pattern.pairs))
        self.place = Place(point, self.held.measured(point.vectors))
        self.of = self.blocks.seen_by(self.held.first)
        self.giving = np.flatnonzero(self.held.gives_way)
        self.of_giving = self.of.seen_by(self.giving)
        self.vectors_held = np.bincount(self.of.label, minlength=count).astype(np.float64)
        giving = np.bincount(self.of_giving.label, minlength=count)
        self.sharing = np.maximum(np.where(giving > 0, giving, self.vectors_held), 1.0)
        self.growth, self.lag = np.full(count, FIRST_GROWTH), np.full(count, _LAG)
        self.anew, self.waited = np.zeros(count, dtype=np.intp), np.zeros(count, dtype=np.intp)
        self.since, self.nearest = np.zeros(count, dtype=np.intp), np.full((2, count), np.inf)
        self.scales = self.model.lengths[:, None] ** self.model.powers
        self.merit = Merit(model, self.blocks, self.held)
        if after is None:
            self._begin()
        else:
            self._resume(after)
        self.target = self.of_giving.smallest(self.barriers.goal[self.giving])
        self.target[np.isinf(self.target)] = 0.0
        self.now = self.best = self.merit.worth(self.place, self.barriers)

    def _begin(self) -> None:
        count, held, at, ease = self.blocks.count, self.held, self.place.at, self.ease[self.of.label]
        # A start that costs nothing says nothing of what holding the vectors will cost: a part of their squares does.
        goal, long = Barriers(held, most=1.0, ease=ease).goal, np.sqrt(at.squares)
        beyond = self.of.total(np.maximum(long - goal, 0.0) ** 2)
        self.widest = self.of_giving.largest(long[self.giving])
        scale = np.maximum.reduce([self.merit.free_cost(self.place), _OPEN * beyond, self.least, np.full(count, _TINY)])
        self.mu = _BARRIER * scale / self.sharing
        mu = self.mu[self.of.label]
        self.barriers = Barriers(held, most=_ELASTIC * mu, ease=ease)
        self.barriers.open(at, self.widest[self.of.label], self.lag[self.of.label], mu)
        self.damping = np.full(count, self.rule.least)

    def _begin_anew(self, where: BoolArray) -> None:
        """Begin again at the best point so far of some components."""
        old = self.barriers, self.mu, self.widest, self.damping
        self.anew += where
        self.place = self.merit.at(np.where(self.blocks.each(where), self.best.unknowns, self.place.point.unknowns))
        self.growth, self.lag = np.where(where, FIRST_GROWTH, self.growth), np.where(where, _LAG, self.lag)
        self._begin()
        self.barriers = old[0].mixed(self.barriers, where[self.of.label])
        self.mu, self.widest, self.damping = (
            np.where(where, new, one) for new, one in zip((self.mu, self.widest, self.damping), old[1:], strict=True)
        )

    def _resume(self, after: Ended) -> None:
        self.mu, self.widest = 4.0 * after.mu, np.zeros(self.blocks.count)
        self.damping = np.minimum(after.damping, 1.0)
        self.barriers = Barriers(self.held, most=1.0, ease=self.ease[self.of.label])
        self.barriers.resume(after.barriers)

    def ended(self, asked: Array | float, tell: Told | None) -> Ended:
        """Step until every component has settled, or nothing is left of the steps, or somebody says so."""
        steps, stopped = 0, False
        while steps < self.limits.steps and self.goes_on.any() and not stopped:
            steps += 1
            self._step()
            wedged = self.goes_on & (self.damping >= _WEDGED) & (self.anew < _ANEW)
            if wedged.any():
                self._begin_anew(wedged)
            self._give_up()
            if tell is not None:
                beyond = np.maximum(self.now.firm, self.now.excess * self.ease / asked)[self.moving].max()
                stopped = not tell(steps, float(beyond), self.place.point.cost)
        return Ended(
            now=self.now,
            best=self.best,
            ease=self.ease,
            steps=steps,
            settled=self.settled,
            told_to_stop=stopped,
            barriers=self.barriers,
            mu=self.mu,
            damping=self.damping,
        )

    def _give_up(self) -> None:
        """End where something does not hold, and too many steps have brought it no nearer."""
        beyond = np.maximum([self.best.firm, self.best.excess], 1.0) - 1.0
        nearer = (beyond < _NEARER * self.nearest).any(axis=0)
        self.since = np.where(nearer, 0, self.since + 1)
        self.nearest = np.where(nearer, beyond, self.nearest)
        self.goes_on = self.goes_on & ~(
            (self.since >= self.limits.idle) & (beyond > self.limits.feasibility).any(axis=0)
        )

    def _step(self) -> None:
        """One step of every component that still moves."""
        (point, at), pattern, goes_on = self.place, self.pattern, self.goes_on
        damping = self.damping[pattern.component]
        normal = Normal(
            point.normal.gradient.copy(),
            point.normal.diagonal * (1.0 + damping)[:, None, None],
            point.normal.coupling.copy(),
        )
        i = np.arange(pattern.size)
        normal.diagonal[:, i, i] += _IDLE * (damping * self.model.lengths**2)[:, None] / self.scales**2
        work = self.barriers.add_to(normal, at, point.jacobians, self.mu[self.of.label], damping)
        bounded = bounded_step(pattern, normal, np.zeros_like(point.unknowns), point.unknowns, self.bounds)
        if bounded is None:
            self.damping = np.where(goes_on, np.minimum(10.0 * self.damping, self.rule.most), self.damping)
            self.goes_on = goes_on & (self.damping < self.rule.most)
            return
        moved = self.barriers.moved(point.jacobians, bounded.step)
        step = bounded.step + self._bent(bounded, work, moved)
        step[~goes_on[pattern.component]] = 0.0
        promise = np.where(goes_on[pattern.component], bounded.promised, 0.0)
        self.place, taken, gain, failed = self.merit.take(
            self.place, step, promise, barriers=self.barriers, mu=self.mu, goes_on=goes_on, least=self.least
        )
        far = self.blocks.largest(np.abs(step) / self.scales)
        calmer = np.clip(self.lag * (far / _STEP) ** _LAG_POWER, _LEAST_LAG, _MOST_LAG)
        self.lag = np.where(failed, np.minimum(_MOST_LAG, self.lag**0.5), calmer)
        damped, growth = self.rule.after(self.damping, self.growth, gain, failed)
        self.damping, self.growth = (
            np.where(goes_on, new, old) for new, old in ((damped, self.damping), (growth, self.growth))
        )
        cost, promised = self.merit.free_cost(self.place), np.abs(self.blocks.total(promise))
        ready = _READY * self.vectors_held * self.mu + _SHARE_LEFT * cost + self.least
        settled = goes_on & ~failed & (gain > _GAIN) & (promised <= ready)
        stuck = failed & (self.growth >= _STUCK)
        self._renew(work, moved, taken, settled, stuck)
        self.now = self.merit.worth(self.place, self.barriers)
        self.best = self.best.mixed(self.now, self.best.beaten_by(self.now), self.blocks)
        self._narrow(settled, failed, promised, cost)

    def _bent(self, bounded: BoundedStep, work: Work, moved: Array) -> Array:
        """(count, size) what bends a step to where the vectors turn out to be; nothing where that is no small part."""
        point, at = self.place
        with np.errstate(all="ignore"):
            gradient = np.zeros_like(point.unknowns)
            there = self.held.told(self.model.vectors(self.bounds.clip(point.unknowns + bounded.step)))
            self.barriers.bend(gradient, work, there - at.rows - moved)
            gradient[bounded.blocked] = 0.0
            known = np.isfinite(self.blocks.total(gradient.sum(axis=1)))
            bent = bounded.factors.solve(-np.where(self.blocks.each(known), gradient, 0.0))
        small = self.blocks.largest(np.abs(bent)) <= _BENT * self.blocks.largest(np.abs(bounded.step))
        return np.where(self.blocks.each(small), bent, 0.0)

    def _renew(self, work: Work, moved: Array, taken: BoolArray, settled: BoolArray, stuck: BoolArray) -> None:
        """Multipliers after a step."""
        label, at = self.of.label, self.place.at
        whole = taken[self.held.first] & taken[self.held.second]
        self.barriers.renew(work, moved, whole & self.goes_on[label])
        if stuck.any():
            self.barriers.recentre(at, self.mu[label], stuck[self.pattern.component])
        if settled.any():
            self.barriers.raise_most(at, whole & settled[label], _ELASTIC_RISE)

    def _narrow(self, settled: BoolArray, failed: BoolArray, promised: Array, cost: Array) -> None:
        """Narrow distances and barrier as far as the steps have settled; and end where nothing is left to do."""
        lagging = self.of.largest(self.barriers.lagging, 1.0)
        through = settled & (self.widest <= self.target) & (lagging <= 1.0)
        end = np.maximum.reduce([_BARRIER_END * cost, self.least, np.full_like(cost, _TINY)])
        end /= np.maximum(self.vectors_held, 1.0)
        rest = np.maximum.reduce([_SHARE_LEFT * cost, self.least, np.full_like(cost, _TINY)])
        held = np.maximum(self.now.firm, self.now.excess) <= 1.0 + self.limits.feasibility
        done = through & (self.mu <= end) & held & (promised <= rest)
        # What is far from holding needs greater multipliers first: with a barrier that is lowered before, steps creep
        # along what holds already. Where the start cost next to nothing, what they are worth shows only by and by.
        near = np.maximum(self.now.firm, self.now.excess) <= _NEAR
        falls = np.maximum(self.mu * _BARRIER_DROP, 0.5 * end)
        worth = _BARRIER * cost / self.sharing
        rises = np.where(worth > _TOO_LOW * self.mu, worth, self.mu)
        self.mu = np.where(through & ~done, np.where(near, falls, rises), self.mu)
        self.settled, self.goes_on = self.settled | done, self.goes_on & ~done
        # What must hold comes first: narrowed while it does not, the others would drive it further off. It may never.
        waits = (
            ~settled
            & (self.now.firm > 1.0 + _FIRMLY)
            & (self.now.firm < _FIRM_YET)
            & (self.waited < self.limits.patience)
        )
        self.waited += waits & ~failed & self.goes_on
        follows = self.goes_on & ~failed & ~waits
        self.widest = np.where(follows, np.maximum(self.widest * self.lag, self.target), self.widest)
        label = self.of.label
        self.barriers.follow(self.place.at, self.widest[label], self.lag[label], follows[label])
