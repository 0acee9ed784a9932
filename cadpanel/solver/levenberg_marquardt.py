"""Levenberg-Marquardt on sparse blocks, each block with its own damping.

A connected component accepts or refuses its step by itself, so a thousand separate local fits, or many restarts of one
coupled problem, run in one call and each behaves as if it were alone. Within a component every block is damped by how
well the model did around it, and a step is undone where it did harm: otherwise one difficult spot would hold up a strip
of thousands of panels.

Method: Nielsen's damping (H. B. Nielsen, Damping parameter in Marquardt's method, IMM-REP-1999-05) with Marquardt's
scaling by the diagonal, on the normal equations.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from cadpanel.solver.blocks import BlockPattern, Normal

Array = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

# Marquardt's scale of an unknown that no residual sees is 0; this share of the block's largest keeps the step finite.
_LEAST_SCALE = 1e-9
_LEAST_DAMPING, _MOST_DAMPING, _MOST_GROWTH = 1e-15, 1e12, 64.0
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

        A trial that makes no sense has an infinite cost.
        """
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
    """

    cost: float = 1e-10
    iterations: int = 100


@dataclass(frozen=True, slots=True)
class Solution:
    """What was reached.

    Attributes:
        unknowns: (count, size).
        cost: (components,) per connected component.
        converged: (components,) whether it stopped by itself within the iterations.
        iterations: linear systems solved.
    """

    unknowns: Array
    cost: Array
    converged: BoolArray
    iterations: int


def levenberg_marquardt(model: Model, start: Array, stopping: Stopping, damping: float = 1e-3) -> Solution:
    """Minimise the model's cost from `start` (count, size).

    Args:
        model: the sum of squares.
        start: where to begin; its cost must be finite.
        stopping: when to stop.
        damping: the first damping, relative to the diagonal of J^T J.
    """
    pattern = model.pattern
    component, count = pattern.component, pattern.components

    def per_component(values: Array) -> Array:
        return np.bincount(component, values, minlength=count).astype(np.float64, copy=False)

    unknowns = start.copy()
    booked, normal = model.linearize(unknowns)
    mu = np.full(pattern.count, damping)
    growth = np.full(pattern.count, 2.0)
    done = np.zeros(count, dtype=bool)
    iterations = 0
    while iterations < stopping.iterations and not done.all():
        iterations += 1
        scale = np.einsum("bii->bi", normal.diagonal)
        scale = np.maximum(scale, _LEAST_SCALE * scale.max(axis=1, keepdims=True))
        step = pattern.solve(normal, mu[:, None] * scale)
        if step is None:
            mu, growth = mu * growth, growth * 2.0
            continue
        step[done[component]] = 0.0
        # The decrease that the damped model promises is s . (damping s - gradient) / 2.
        promised = 0.5 * np.sum(step * (mu[:, None] * scale * step - normal.gradient), axis=1)
        trial = unknowns + step
        cost = model.cost(trial)
        near_gain = _gain(pattern.around(booked), pattern.around(cost), pattern.around(promised))
        worse = near_gain <= 0.0
        if worse.any() and not worse.all():
            # Keep the step only where the cost fell around a block, if that is better for the component.
            partial = np.where(worse[:, None], unknowns, trial)
            partial_cost = model.cost(partial)
            take = (per_component(partial_cost) < per_component(cost))[component]
            trial, cost = np.where(take[:, None], partial, trial), np.where(take, partial_cost, cost)
        better = (per_component(cost) < per_component(booked)) & ~done
        done |= per_component(promised) <= stopping.cost * per_component(booked)
        # Nielsen: shrink smoothly with the gain, grow ever faster on refusals.
        falling = ~worse & better[component]
        shrink = np.maximum(1.0 / 3.0, 1.0 - (2.0 * np.clip(near_gain, 0.0, 1.0) - 1.0) ** 3)
        mu = np.clip(np.where(falling, mu * shrink, mu * growth), _LEAST_DAMPING, _MOST_DAMPING)
        growth = np.where(falling, 2.0, np.minimum(growth * 2.0, _MOST_GROWTH))
        # Refused again and again: rounding is all that is left of this component.
        done |= per_component((mu < _MOST_DAMPING).astype(np.float64)) == 0.0
        if better.any():
            unknowns = np.where(better[component, None], trial, unknowns)
            booked, normal = (
                model.linearize(unknowns) if not done.all() else (np.where(better[component], cost, booked), normal)
            )
    return Solution(unknowns, per_component(booked), done, iterations)


def _gain(before: Array, after: Array, promised: Array) -> Array:
    """Share of the promised decrease that came true; 1 where rounding is all that there is to gain."""
    with np.errstate(invalid="ignore", divide="ignore"):
        gain = np.where(promised > _ROUNDING * before, (before - after) / promised, 1.0)
    return np.where(np.isfinite(gain), gain, 0.0)
