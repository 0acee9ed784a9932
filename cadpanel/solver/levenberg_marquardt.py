"""Levenberg-Marquardt on sparse blocks, each connected component with its own damping.

A component accepts or refuses its step by itself, so a thousand separate local fits, or many restarts of one coupled
problem, run in one call and each behaves as if it were alone. Where a step fails as a whole it is undone only where it
did harm: otherwise one difficult spot would hold up a strip of thousands of panels. Damping every block by itself was
tried and given up: it converges linearly where this converges quadratically.

Method: Nielsen's damping (H. B. Nielsen, Damping parameter in Marquardt's method, IMM-REP-1999-05) with Marquardt's
scaling by the diagonal, on the normal equations.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from cadpanel.arrays import Array, BoolArray
from cadpanel.solver.blocks import BlockPattern, Normal
from cadpanel.solver.bounds import Bounds, bounded_step
from cadpanel.solver.nielsen import FIRST_GROWTH, Nielsen
from cadpanel.solver.one_thread import on_one_thread
from cadpanel.solver.stop import Stop

# Marquardt's scale of an unknown that no residual sees is 0; this share of the block's largest keeps the step finite.
_LEAST_SCALE = 1e-9
_DAMPING = Nielsen(least=1e-15, most=1e12, drop=1.0 / 3.0)
# A decrease below this share of the cost is lost in rounding.
_ROUNDING = 1e-11


class Model(Protocol):
    """A sum of squares over blocks of unknowns."""

    @property
    def pattern(self) -> BlockPattern:
        """Which blocks are coupled."""
        ...

    def cost(self, unknowns: Array) -> Array:
        """(count,) the cost at the unknowns (count, size), each residual booked on one of its blocks.

        A trial that makes no sense has an infinite cost, or one that is no number.
        """
        ...

    @property
    def bounds(self) -> Bounds | None:
        """Least and greatest values of the unknowns, or None where all are free."""
        ...

    def linearize(self, unknowns: Array) -> tuple[Array, Normal]:
        """The cost as above, and its Gauss-Newton model."""
        ...


@dataclass(frozen=True, slots=True, kw_only=True)
class Stopping:
    """When a component is done.

    Attributes:
        cost: relative decrease that the model still promises, below which it stops.
        iterations: steps tried at most.
        least: steps tried before it stops for what is promised.
    """

    cost: float = 1e-10
    iterations: int = 100
    least: int = 0


@dataclass(frozen=True, slots=True)
class Solution:
    """What was reached.

    Attributes:
        unknowns: (count, size).
        cost: (components,) per connected component.
        converged: (components,) whether it stopped by itself within the iterations.
        iterations: linear systems solved.
        damping: (components,) at the end, to go on with.
    """

    unknowns: Array
    cost: Array
    converged: BoolArray
    iterations: int
    damping: Array

    @property
    def stopped(self) -> Stop:
        """Why all of it stopped: one component that ran out of steps is not at rest."""
        return Stop.AT_REST if self.converged.all() else Stop.STEP_LIMIT


@on_one_thread
def levenberg_marquardt(model: Model, start: Array, stopping: Stopping, damping: float | Array = 1e-3) -> Solution:
    """Minimise the model's cost from `start` (count, size).

    Args:
        model: the sum of squares.
        start: where to begin; its cost must be finite.
        stopping: when to stop.
        damping: the first damping, relative to the diagonal of J^T J; one for all, or one a component (components,).
    """
    pattern = model.pattern
    component, count = pattern.component, pattern.components

    def per_component(values: Array) -> Array:
        return np.bincount(component, values, minlength=count).astype(np.float64, copy=False)

    bounds = model.bounds
    unknowns = start.copy() if bounds is None else bounds.clip(start)
    now = _Tried(unknowns, *model.linearize(unknowns))
    mu, growth = np.zeros(count) + damping, np.full(count, FIRST_GROWTH)
    done = np.zeros(count, dtype=bool)
    iterations = 0
    while iterations < stopping.iterations and not done.all():
        iterations += 1
        unknowns, booked, normal = now.unknowns, now.cost, now.normal
        scale = np.einsum("bii->bi", normal.diagonal)
        scale = mu[component, None] * np.maximum(scale, _LEAST_SCALE * scale.max(axis=1, keepdims=True))
        bounded = bounded_step(pattern, normal, scale, unknowns, bounds)
        if bounded is None:
            mu, growth = mu * growth, growth * 2.0
            continue
        bounded.step[done[component]] = 0.0
        before, hoped = per_component(booked), per_component(bounded.promised)
        # Cut at a bound a long step may lead uphill; that is too little damping and no sign of rest.
        hoped[(hoped <= 0.0) & (per_component(bounded.cut) > 0.0)] = np.inf
        # Most steps are good, so the next model is worked out at once: it costs little more than the cost alone.
        last = iterations == stopping.iterations
        ahead = _tried(model, unknowns + bounded.step, last)
        gain = _gain(before, per_component(ahead.cost), hoped)
        failed = (gain <= 0.0) & ~done
        if failed.any():
            ahead = _spared(model, now, ahead, failed, bounded.promised, last)
        better = (per_component(ahead.cost) < before) & ~done
        mu, growth = _DAMPING.after(mu, growth, gain, failed)
        # Refused again and again: rounding is all that is left of this component.
        done |= (mu >= _DAMPING.most) | ((hoped <= stopping.cost * before) & (iterations >= stopping.least))
        if better.any():
            now = ahead
    return Solution(now.unknowns, per_component(now.cost), done, iterations, mu)


@dataclass(frozen=True, slots=True)
class _Tried:
    """Unknowns (count, size), their cost (count,), infinite where they make no sense, and their model.

    After the last step nobody asks for a model any more, and there is none.
    """

    unknowns: Array
    cost: Array
    model: Normal | None

    @property
    def normal(self) -> Normal:
        """The model."""
        assert self.model is not None, "there are no steps after the last one"
        return self.model


def _tried(model: Model, trial: Array, last: bool) -> _Tried:
    with np.errstate(all="ignore"):
        cost, normal = (model.cost(trial), None) if last else model.linearize(trial)
    return _Tried(trial, np.where(np.isfinite(cost), cost, np.inf), normal)


def _spared(model: Model, now: _Tried, ahead: _Tried, failed: BoolArray, promised: Array, last: bool) -> _Tried:
    """Where a step leads that is undone in components (components,) in which it failed, wherever it did harm."""
    pattern = model.pattern
    component = pattern.component
    if not len(pattern.pairs):
        # Every block is a component and was tried by itself: nothing has to be worked out again.
        back = failed[component]
        unknowns = np.where(back[:, None], now.unknowns, ahead.unknowns)
        kept = None if ahead.model is None else ahead.model.where(back, now.normal)
        return _Tried(unknowns, np.where(back, now.cost, ahead.cost), kept)
    harm = _gain(pattern.around(now.cost), pattern.around(ahead.cost), pattern.around(promised)) <= 0.0
    unknowns = np.where((failed[component] & harm)[:, None], now.unknowns, ahead.unknowns)
    # Mostly this does no good either, and its model is of no use.
    spared = _tried(model, unknowns, last=True)
    costs = (np.bincount(component, one.cost, minlength=pattern.components) for one in (spared, now))
    stuck = failed & ~np.less(*costs)
    if stuck.all():
        return spared
    return _tried(model, np.where(stuck[component, None], now.unknowns, unknowns), last)


def _gain(before: Array, after: Array, promised: Array) -> Array:
    """Share of the promised decrease that came true; 1 where rounding is all that there is to gain."""
    with np.errstate(invalid="ignore", divide="ignore"):
        gain = np.where(promised > _ROUNDING * before, (before - after) / promised, 1.0)
    return np.where(np.isfinite(gain), gain, 0.0)
