"""Sums of terms on a problem, as the solver's models."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cadpanel.arrays import Array, BoolArray
from cadpanel.fitting.problem import Problem
from cadpanel.solver.blocks import BlockPattern, Normal
from cadpanel.solver.bounds import Bounds
from cadpanel.solver.components import Components
from cadpanel.solver.held_model import Point
from cadpanel.terms.state import State
from cadpanel.terms.term import HeldTerm, Term


class Objective:
    """A sum of terms on a problem.

    Attributes:
        problem: what the terms are about.
        terms: the terms.
        pattern: which panels are coupled through these terms.
        bounds: of the unknowns.
    """

    def __init__(self, of: Problem, terms: Sequence[Term], *, coupled: bool) -> None:
        """`coupled` where some term sees both panels of a seam."""
        self.problem = of
        self.terms = tuple(terms)
        alone = np.empty((0, 2), dtype=np.intp)
        self.pattern = of.pattern if coupled else BlockPattern(of.panels, of.layout.size, alone)
        self.bounds: Bounds | None = Bounds(*of.bounds)
        self._idle = None if of.layout.used.all() else ~of.layout.used

    def cost(self, unknowns: Array) -> Array:
        """See `solver.Model.cost`."""
        return self.cost_at(self.problem.state(unknowns))

    def cost_at(self, state: State) -> Array:
        """The same at a state."""
        cost = np.zeros(self.problem.panels)
        for term in self.terms:
            cost += term.cost(state)
        return np.where(np.isfinite(cost), cost, np.inf)

    def linearize(self, unknowns: Array) -> tuple[Array, Normal]:
        """See `solver.Model.linearize`."""
        return self.linearize_at(self.problem.state(unknowns, derivatives=True))

    def linearize_at(self, state: State) -> tuple[Array, Normal]:
        """The same at a state that was walked with derivatives."""
        normal = Normal.zero(self.pattern.count, self.pattern.size, len(self.pattern.pairs))
        cost = np.zeros(self.problem.panels)
        for term in self.terms:
            cost += term.add_to(normal, state)
        if self._idle is not None:
            i = np.arange(self.pattern.size)
            normal.diagonal[:, i, i] += self._idle
        return cost, normal


class HeldObjective:
    """A sum of terms on a problem, and vectors that are held within tolerances.

    Attributes:
        problem: what the terms are about.
        held: the terms that are held.
        pattern: which panels are coupled.
        bounds: of the unknowns.
        lengths: (panels,) the mean length of all panels that a panel is connected with.
        powers: (panels, size) the power of a length that each unknown counts in.
    """

    def __init__(
        self, of: Problem, terms: Sequence[Term], held: Sequence[HeldTerm], *, moving: BoolArray | None = None
    ) -> None:
        """What is to be held, and what moves.

        Args:
            of: the panels.
            terms: what is to be small.
            held: what is to stay within tolerances; its weights count besides.
            moving: (panels, size) which unknowns may move; all, or those alone. `at` begins where they start.
        """
        self.problem, self.held = of, tuple(held)
        self._free = Objective(of, terms, coupled=True)
        self.pattern, self.bounds = self._free.pattern, Bounds(*of.bounds)
        self._moving = moving
        blocks = Components.of(self.pattern)
        self.lengths = blocks.each(blocks.mean(of.lengths))[:, 0]
        self.powers = of.layout.powers

    def starting_from(self, start: Array) -> Array:
        """The unknowns to begin with; those that may not move are fixed there from now on."""
        if self._moving is not None:
            lower, upper = (np.where(self._moving, bound, start) for bound in self.problem.bounds)
            self.bounds = Bounds(lower, upper)
        return self.bounds.clip(start)

    def at(self, unknowns: Array) -> Point:
        """See `solver.HeldModel.at`."""
        state = self.problem.state(unknowns, derivatives=True)
        cost, normal = self._free.linearize_at(state)
        linear = [term.linear(state) for term in self.held]
        return Point(unknowns, cost, normal, tuple(v for v, _ in linear), tuple(j for _, j in linear))

    def cost(self, unknowns: Array) -> tuple[Array, tuple[Array, ...]]:
        """See `solver.HeldModel.cost`."""
        state = self.problem.state(unknowns)
        return self._free.cost_at(state), tuple(term.vectors(state) for term in self.held)

    def vectors(self, unknowns: Array) -> tuple[Array, ...]:
        """See `solver.HeldModel.vectors`."""
        state = self.problem.state(unknowns)
        return tuple(term.vectors(state) for term in self.held)
