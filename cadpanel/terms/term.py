"""What every term of the objective can do."""

from __future__ import annotations

from typing import Protocol

from cadpanel.arrays import Array
from cadpanel.solver.blocks import Normal
from cadpanel.terms.rows import Rows
from cadpanel.terms.state import State


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
