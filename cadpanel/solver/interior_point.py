"""Least squares with vectors held within distances: an elastic primal-dual interior point on the Gauss-Newton model.

One linearization and one factorization a step. Distances begin as wide as the vectors are long and narrow to what is
asked for while the steps go on: what is far open cannot be closed at once, for the way there is curved. Where the
vectors turned out other than a step foretold, the step is bent once with the same factors (a second-order correction;
Nocedal and Wright, Numerical Optimization, 2nd ed. 2006, section 18.3): a tube of a millimetre about a curved way lets
straight steps go but a few centimetres.

Each connected component has its own damping, and what a step spoils in one place is not undone in another, see
`solver.levenberg_marquardt`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array, BoolArray
from cadpanel.solver.barrier import Barrier
from cadpanel.solver.blocks import Normal
from cadpanel.solver.bounds import bounded_step
from cadpanel.solver.held_model import HeldModel, Point
from cadpanel.solver.nielsen import FIRST_GROWTH, Nielsen

# Damping: a share of the free cost's own Gauss-Newton matrix, and how much of its diagonal's unit stands in for rows of
# zeros. It never falls below the first: constraints that change sides from step to step would let it oscillate.
_DAMPING = Nielsen(least=0.03, most=1e6, drop=0.2, rise=2.0)
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
_GAIN, _HARMFUL, _READY, _SHARE_LEFT = 0.25, 1e-3, 0.1, 3e-4
# A correction longer than this share of the step is none.
_BENT = 0.5
# Promises below this share of the cost are rounding; a cost of this size is none.
_ROUNDING, _TINY = 1e-9, 1e-30
# The cost of a start that costs nothing itself is taken for this share of the squares of what is too long.
_OPEN = 0.005

Told = Callable[[int, float, float], bool]
"""Told the step, the largest |v| / tau and the cost; whether to go on."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Limits:
    """When to stop.

    Attributes:
        steps: at most.
        feasibility: by which share a vector may be too long.
        least_cost: below which nothing is left to gain.
    """

    steps: int = 100
    feasibility: float = 1e-9
    least_cost: float = 0.0


@dataclass(frozen=True, slots=True)
class Ended:
    """Where the steps ended.

    Attributes:
        now: the last point.
        best: unknowns (count, size) of the best point: of those in which what must not give way holds the one that
            exceeds the other distances least, and of those that exceed none the one with the least cost.
        multipliers: for each batch (groups, vectors) the weight w of |v|^2 / 2 in the cost that holds the vector.
        steps: linear systems solved.
        settled: whether it came to rest with everything held.
        told_to_stop: whether it was told to.
        barriers, mu, damping: to go on from.
    """

    now: Best
    best: Best
    multipliers: tuple[Array, ...]
    steps: int
    settled: bool
    told_to_stop: bool
    barriers: tuple[Barrier, ...]
    mu: float
    damping: Array


@dataclass(frozen=True, slots=True)
class Best:
    """A point, and what it is worth beside others.

    Attributes:
        unknowns: (count, size).
        firm: by how much what must not give way exceeds its distances, at most; 1 where it holds.
        excess: the same of what may give way.
        cost: the cost of what is not held.
    """

    unknowns: Array
    firm: float
    excess: float
    cost: float

    def beaten_by(self, other: Best) -> bool:
        """Whether the other is better, or as good and later."""
        mine, its = ((max(one.firm, 1.0), max(one.excess, 1.0)) for one in (self, other))
        return its <= mine


def interior_point(
    model: HeldModel,
    start: Array,
    limits: Limits,
    *,
    ease: float = 1.0,
    after: Ended | None = None,
    tell: Told | None = None,
) -> Ended:
    """The smallest cost at which all held vectors stay within their distances.

    Args:
        model: cost and held vectors.
        start: (count, size) unknowns to begin with.
        limits: when to stop.
        ease: distances that may give way count so many times as wide.
        after: an end of the same model with slightly other distances, to begin with its multipliers.
        tell: told of every step.
    """
    return _Run(model, start, limits, ease, after, tell).ended()


class _Run:
    """The steps from one start."""

    def __init__(
        self, model: HeldModel, start: Array, limits: Limits, ease: float, after: Ended | None, tell: Told | None
    ) -> None:
        self.model, self.limits, self.tell, self.ease = model, limits, tell, ease
        self.pattern, self.bounds = model.pattern, model.bounds
        self.point = model.at(self.bounds.clip(start))
        self.vectors_held = sum(one.hold.radius.size for one in model.held)
        self.growth = np.full(self.pattern.components, FIRST_GROWTH)
        self.lag = _LAG
        if after is None:
            self._begin()
        else:
            self._resume(after)
        self.now = self.best = self._worth(self.point)

    def _begin(self) -> None:
        giving = [(one, v) for one, v in zip(self.model.held, self.point.vectors, strict=True) if one.hold.gives_way]
        count = sum(one.hold.radius.size for one, _ in giving) or self.vectors_held
        # A start that costs nothing says nothing of what holding the vectors will cost: a part of their squares does.
        beyond = (
            np.maximum(np.sqrt(one.hold.squares(v)) - one.hold.radius, 0.0)
            for one, v in zip(self.model.held, self.point.vectors, strict=True)
        )
        scale = max(self._cost(), _OPEN * sum(float(np.sum(far**2)) for far in beyond), self.limits.least_cost, _TINY)
        self.mu = _BARRIER * scale / max(count, 1)
        self.barriers = tuple(Barrier(one, most=_ELASTIC * self.mu, ease=self.ease) for one in self.model.held)
        self.widest = max((float(np.linalg.norm(v, axis=-1).max(initial=0.0)) for _, v in giving), default=0.0)
        for barrier, vectors in zip(self.barriers, self.point.vectors, strict=True):
            barrier.open(vectors, self.widest, self.lag, self.mu)
        self.damping = np.full(self.pattern.components, _DAMPING.least)

    def _resume(self, after: Ended) -> None:
        self.mu, self.widest = 4.0 * after.mu, 0.0
        self.damping = np.minimum(after.damping, 1.0)
        self.barriers = tuple(Barrier(one, most=1.0, ease=self.ease) for one in self.model.held)
        for barrier, old in zip(self.barriers, after.barriers, strict=True):
            barrier.resume(old)

    def ended(self) -> Ended:
        steps, settled, stopped = 0, False, False
        while steps < self.limits.steps and not settled and not stopped:
            steps += 1
            settled = self._step()
            if self.tell is not None:
                stopped = not self.tell(steps, max(self.now.firm, self.now.excess * self.ease), self.now.cost)
        return Ended(
            now=self.now,
            best=self.best,
            multipliers=tuple(barrier.weight / barrier.tau**2 for barrier in self.barriers),
            steps=steps,
            settled=settled,
            told_to_stop=stopped,
            barriers=self.barriers,
            mu=self.mu,
            damping=self.damping,
        )

    def _step(self) -> bool:
        """One step; whether nothing is left to do."""
        point, pattern = self.point, self.pattern
        damping = self.damping[pattern.component]
        normal = Normal(
            point.normal.gradient.copy(),
            point.normal.diagonal * (1.0 + damping)[:, None, None],
            point.normal.coupling.copy(),
        )
        i = np.arange(pattern.size)
        normal.diagonal[:, i, i] += (_IDLE * damping)[:, None]
        parts = list(zip(self.barriers, point.vectors, point.jacobians, strict=True))
        work = [barrier.add_to(normal, vectors, rates, self.mu, damping) for barrier, vectors, rates in parts]
        bounded = bounded_step(pattern, normal, np.zeros_like(point.unknowns), point.unknowns, self.bounds)
        if bounded is None:
            self.damping = np.minimum(10.0 * self.damping, _DAMPING.most)
            return bool((self.damping >= _DAMPING.most).all())
        moved = [barrier.moved(rates, bounded.step) for barrier, _, rates in parts]
        with np.errstate(all="ignore"):
            gradient = np.zeros_like(normal.gradient)
            there = self.model.vectors(self.bounds.clip(point.unknowns + bounded.step))
            for (barrier, vectors, _), part, move, ahead in zip(parts, work, moved, there, strict=True):
                barrier.bend(gradient, part, ahead - vectors - move)
            bent = bounded.factors.solve(-np.where(bounded.blocked, 0.0, gradient))
        step = bounded.step
        if np.abs(bent).max() <= _BENT * np.abs(step).max():  # also where it is no number
            step = step + bent
        taken, gain, failed = self._take(step, bounded.promised)
        promised = abs(float(bounded.promised.sum()))
        far = float(np.abs(step).max())
        if failed.any():
            self.lag = min(_MOST_LAG, self.lag**0.5)
        else:
            self.lag = float(np.clip(self.lag * (far / _STEP) ** _LAG_POWER, _LEAST_LAG, _MOST_LAG))
        self.damping, self.growth = _DAMPING.after(self.damping, self.growth, gain, failed)
        cost = self._cost()
        settled = bool(
            not failed.any()
            and gain.min(initial=1.0) > _GAIN
            and promised <= _READY * self.vectors_held * self.mu + _SHARE_LEFT * cost + self.limits.least_cost
        )
        stuck = failed & (self.growth >= _STUCK)
        for barrier, part, move, vectors in zip(self.barriers, work, moved, self.point.vectors, strict=True):
            whole = np.all([taken[blocks] for blocks in barrier.held.blocks], axis=0)
            barrier.renew(part, move, whole)
            if stuck.any():
                barrier.recentre(vectors, self.mu, stuck[pattern.component])
            if settled:
                barrier.raise_most(vectors, whole, _ELASTIC_RISE)
        self.now = self._worth(self.point)
        if self.best.beaten_by(self.now):
            self.best = self.now
        return self._narrow(settled, failed, promised, cost, max(self.now.firm, self.now.excess))

    def _narrow(self, settled: bool, failed: BoolArray, promised: float, cost: float, excess: float) -> bool:
        """Narrow distances and barrier as far as the steps have settled; whether nothing is left to do."""
        target = min((float(b.goal.min(initial=np.inf)) for b in self.barriers if b.held.hold.gives_way), default=0.0)
        lagging = max((barrier.lagging for barrier in self.barriers), default=1.0)
        if settled and self.widest <= target and lagging <= 1.0:
            end = max(_BARRIER_END * cost, self.limits.least_cost, _TINY) / max(self.vectors_held, 1)
            rest = max(_SHARE_LEFT * cost, self.limits.least_cost, _TINY)
            if self.mu <= end and excess <= 1.0 + self.limits.feasibility and promised <= rest:
                return True
            self.mu = max(self.mu * _BARRIER_DROP, 0.5 * end)
        if settled or not failed.any():
            self.widest = max(self.widest * self.lag, target)
            for barrier, vectors in zip(self.barriers, self.point.vectors, strict=True):
                barrier.follow(vectors, self.widest, self.lag)
        return False

    def _take(self, step: Array, promised: Array) -> tuple[BoolArray, Array, BoolArray]:
        """Go where a step leads, wherever it does no harm.

        Returns:
            which blocks (count,) moved; the share of its promise (components,) that the step kept; and which
            components failed.
        """
        pattern, point = self.pattern, self.point
        before = self._merit(point)
        ahead, after = self._tried(self.bounds.clip(point.unknowns + step))
        hoped, was = self._by_component(promised), self._by_component(before)
        gain = (was - self._by_component(after)) / np.maximum(np.abs(hoped), 1e-300)
        nothing = _ROUNDING * self._by_component(point.cost) + self.limits.least_cost
        gain = np.where(np.abs(hoped) <= nothing, 1.0, gain)
        failed = ~(gain > _HARMFUL)
        taken = np.ones(pattern.count, dtype=bool)
        if failed.any():
            harm = ~(pattern.around(before) - pattern.around(after) > 0.0)
            taken = ~(failed[pattern.component] & harm)
            ahead, after = self._part(ahead.unknowns, taken)
            stuck = failed & ~(self._by_component(after) < was)
            if (stuck[pattern.component] & taken).any():
                taken &= ~stuck[pattern.component]
                ahead, _ = self._part(ahead.unknowns, taken)
        self.point = ahead
        return taken, gain, failed

    def _part(self, trial: Array, taken: BoolArray) -> tuple[Point, Array]:
        """Where only some blocks moved."""
        if not taken.any():
            return self.point, self._merit(self.point)
        return self._tried(np.where(taken[:, None], trial, self.point.unknowns))

    def _tried(self, trial: Array) -> tuple[Point, Array]:
        with np.errstate(all="ignore"):
            ahead = self.model.at(trial)
            merit = self._merit(ahead)
        return ahead, np.where(np.isfinite(merit), merit, np.inf)

    def _merit(self, point: Point) -> Array:
        """(count,) the cost with all penalties."""
        merit = point.cost.copy()
        for barrier, vectors in zip(self.barriers, point.vectors, strict=True):
            share = barrier.cost(vectors, self.mu) / len(barrier.held.blocks)
            for blocks in barrier.held.blocks:
                merit += np.bincount(blocks, share, minlength=len(merit))
        return merit

    def _cost(self) -> float:
        parts = zip(self.model.held, self.point.vectors, strict=True)
        own = (one.hold.weight * one.hold.squares(vectors) for one, vectors in parts)
        return float(self.point.cost.sum()) + 0.5 * sum(float(part.sum()) for part in own)

    def _by_component(self, values: Array) -> Array:
        component = self.pattern.component
        return np.bincount(component, values, minlength=self.pattern.components).astype(np.float64, copy=False)

    def _worth(self, point: Point) -> Best:
        firm, excess = (
            max(
                (
                    barrier.violation(vectors)
                    for barrier, vectors in zip(self.barriers, point.vectors, strict=True)
                    if barrier.held.hold.gives_way is giving
                ),
                default=0.0,
            )
            for giving in (False, True)
        )
        return Best(point.unknowns, firm, excess, float(point.cost.sum()))
