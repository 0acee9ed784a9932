"""Where steps of the interior point ended, component by component, and when they are to."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array, BoolArray
from cadpanel.solver.barrier import Barriers
from cadpanel.solver.components import Components

LEAST_DAMPING = 0.03
"""See `Limits`."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Limits:
    """When to stop.

    Attributes:
        steps: at most.
        feasibility: by which share a vector may be too long.
        least_cost: below which nothing is left to gain; one for each component (components,), or one for all.
        idle: so many steps may bring what does not hold no nearer to holding.
        patience: for so many steps what may give way waits for what must hold; of thousands of panels one is always
            over, and waiting for it takes longer than it saves.
        least_damping: the least share of the cost's own matrix that steps are damped by. Less lets long strips come to
            rest as wholes sooner, where hardly anything that is held binds.
    """

    steps: int = 100
    feasibility: float = 1e-9
    least_cost: Array | float = 0.0
    idle: float = math.inf
    patience: int = 0
    least_damping: float = LEAST_DAMPING


@dataclass(frozen=True, slots=True)
class Best:
    """A point, and what it is worth beside others, for each connected component (components,).

    Attributes:
        unknowns: (count, size).
        firm: by how much what must not give way exceeds its distances, at most; 1 where it holds.
        excess: the same of what may give way.
        cost: the cost of what is not held.
    """

    unknowns: Array
    firm: Array
    excess: Array
    cost: Array

    def beaten_by(self, other: Best) -> BoolArray:
        """(components,) where the other is better, or as good and later."""
        firm, excess = np.maximum(self.firm, 1.0), np.maximum(self.excess, 1.0)
        its_firm, its_excess = np.maximum(other.firm, 1.0), np.maximum(other.excess, 1.0)
        return np.asarray((its_firm < firm) | ((its_firm == firm) & (its_excess <= excess)))

    def mixed(self, other: Best, where: BoolArray, component: Components) -> Best:
        """The other one in some components, this one in the rest."""
        return Best(
            np.where(component.each(where), other.unknowns, self.unknowns),
            *(np.where(where, getattr(other, what), getattr(self, what)) for what in ("firm", "excess", "cost")),
        )


@dataclass(frozen=True, slots=True)
class Ended:
    """Where the steps ended.

    Attributes:
        now: the last point.
        best: the best point of each component: of those in which what must not give way holds the one that exceeds the
            other distances least, and of those that exceed none the last one.
        ease: (components,) so many times as wide distances were that may give way.
        steps: linear systems solved.
        settled: (components,) whether it came to rest with everything held.
        told_to_stop: whether it was told to.
        barriers, mu, damping: to go on from.
    """

    now: Best
    best: Best
    ease: Array
    steps: int
    settled: BoolArray
    told_to_stop: bool
    barriers: Barriers
    mu: Array
    damping: Array

    @property
    def multipliers(self) -> tuple[Array, ...]:
        """For each batch (groups, vectors) the weight w of |v|^2 / 2 in the cost that holds the vector."""
        return self.barriers.multipliers

    def mixed(self, other: Ended, where: BoolArray, component: Components) -> Ended:
        """The other one in some components, this one in the rest; the steps of both."""
        return Ended(
            now=self.now.mixed(other.now, where, component),
            best=self.best.mixed(other.best, where, component),
            ease=np.where(where, other.ease, self.ease),
            steps=self.steps + other.steps,
            settled=np.where(where, other.settled, self.settled),
            told_to_stop=self.told_to_stop or other.told_to_stop,
            barriers=self.barriers.mixed(other.barriers, where[component.label[self.barriers.held.first]]),
            mu=np.where(where, other.mu, self.mu),
            damping=np.where(where, other.damping, self.damping),
        )
