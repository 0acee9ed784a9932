"""What every term of the objective can do, and what terms that are held within tolerances have in common."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Protocol

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.solver.hold import Hold
from cadpanel.terms.rows import Into, Rows, add_rows, booked_cost
from cadpanel.terms.state import State

if TYPE_CHECKING:
    from cadpanel.solver.blocks import Normal  # SciPy takes its time, and settings ask limits for their ranges


class Term(Protocol):
    """One part of the objective: half the sum of squares of its residuals."""

    def cost(self, state: State) -> Array:
        """(panels,) the term's cost, each residual booked on one of its panels."""
        ...

    def add_to(self, normal: Normal, state: State) -> Array:
        """Add gradient and J^T J to the model; returns the cost as above."""
        ...

    def rows(self, state: State) -> list[Rows]:
        """The same as plain residual rows with their Jacobians, for checks and for other solvers."""
        ...


class HeldTerm(ABC):
    """A term whose vectors, or numbers, are to stay within tolerances, or have weights.

    Its residuals are the vectors times the roots of their weights.

    Attributes:
        hold: the tolerances, (groups, vectors), and the weights.
        blocks: the panels that each group sees, one or two arrays (groups,).
        pair: (groups,) which pair of coupled panels these are; None where a group sees one panel.
        panels: number of all panels.
    """

    hold: Hold
    blocks: tuple[IntArray, ...]
    pair: IntArray | None
    panels: int
    _into: Into | None = None

    @abstractmethod
    def vectors(self, state: State) -> Array:
        """(groups, vectors, d) what is held; of numbers d is 1, and they may be negative."""

    @abstractmethod
    def linear(self, state: State) -> tuple[Array, tuple[Array, ...]]:
        """The vectors, and how they follow the unknowns of each of the blocks, (groups, vectors, d, unknowns) each.

        Raises:
            ValueError: the state was walked without derivatives.
        """

    def cost(self, state: State) -> Array:
        """See `Term.cost`."""
        residual = np.sqrt(self.hold.weight * self.hold.squares(self.vectors(state)))
        return booked_cost(residual, self.blocks, self.panels)

    def rows(self, state: State) -> list[Rows]:
        """See `Term.rows`; numbers below 0 have no residual."""
        vectors, jacobians = self.linear(state)
        roots = np.sqrt(self.hold.weight)[..., None]
        if self.hold.one_sided:
            roots = np.where(vectors > 0.0, roots, 0.0)
        groups = len(vectors)
        flat = tuple((roots[..., None] * part).reshape(groups, -1, part.shape[-1]) for part in jacobians)
        return [Rows((roots * vectors).reshape(groups, -1), self.blocks, flat, self.pair)]

    def add_to(self, normal: Normal, state: State) -> Array:
        """See `Term.add_to`; mostly numbers add nothing, and then their derivatives are not worked out."""
        if self.hold.one_sided and not (self.vectors(state) > 0.0).any():
            return np.zeros(self.panels)
        if self._into is None:
            self._into = Into.of(self.blocks, self.pair, normal)
        return add_rows(self.rows(state), normal, self.panels, self._into)
