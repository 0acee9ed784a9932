"""Sums of terms on a problem, as the solver's models."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cadpanel.arrays import Array, BoolArray
from cadpanel.fitting.problem import Problem
from cadpanel.solver.blocks import BlockPattern, Normal
from cadpanel.solver.levenberg_marquardt import Bounds
from cadpanel.terms.term import Term


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
        pairs = of.pairs if coupled else np.empty((0, 2), dtype=np.intp)
        self.pattern = BlockPattern(of.panels, of.layout.size, pairs)
        self.bounds: Bounds | None = Bounds(*of.bounds)
        self._idle = None if of.layout.used.all() else ~of.layout.used

    def cost(self, unknowns: Array) -> Array:
        """See `solver.Model.cost`."""
        state = self.problem.state(unknowns)
        cost = np.zeros(self.problem.panels)
        for term in self.terms:
            cost += term.cost(state)
        return np.where(np.isfinite(cost), cost, np.inf)

    def linearize(self, unknowns: Array) -> tuple[Array, Normal]:
        """See `solver.Model.linearize`."""
        state = self.problem.state(unknowns, derivatives=True)
        normal = Normal.zero(self.pattern.count, self.pattern.size, len(self.pattern.pairs))
        cost = np.zeros(self.problem.panels)
        for term in self.terms:
            cost += term.add_to(normal, state)
        if self._idle is not None:
            i = np.arange(self.pattern.size)
            normal.diagonal[:, i, i] += self._idle
        return cost, normal


class Frozen:
    """A model of which only some unknowns may move.

    Attributes:
        pattern: which panels are coupled.
        bounds: of the unknowns.
    """

    def __init__(self, model: Objective, moving: BoolArray) -> None:
        """`moving` (panels, size) says which unknowns may move; the others stay where they start."""
        self.pattern, self.bounds = model.pattern, model.bounds
        self._model, self._held = model, ~moving

    def cost(self, unknowns: Array) -> Array:
        """See `solver.Model.cost`."""
        return self._model.cost(unknowns)

    def linearize(self, unknowns: Array) -> tuple[Array, Normal]:
        """See `solver.Model.linearize`."""
        cost, normal = self._model.linearize(unknowns)
        return cost, normal.without(self._held, self.pattern.pairs)
