"""What every term of the objective can do."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

from cadpanel.arrays import Array
from cadpanel.solver.tolerance_weights import Hold
from cadpanel.terms.rows import Rows
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


class HeldTerm(Term, Protocol):
    """A term whose vectors are to stay within tolerances, or have weights."""

    @property
    def hold(self) -> Hold:
        """The tolerances, (groups, vectors), and the weights that hold them."""
        ...

    def vectors(self, state: State) -> Array:
        """(groups, vectors, d) what is held."""
        ...
