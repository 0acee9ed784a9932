"""Lengths that must not fall below a least one: what they lack is a held number, 0 where they lack nothing."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING

import numpy as np

from cadpanel.arrays import Array
from cadpanel.features.layout import Group
from cadpanel.features.rulings import Points, Walk
from cadpanel.solver.tolerance_weights import Hold
from cadpanel.terms.rows import Rows, add_rows
from cadpanel.terms.state import State

if TYPE_CHECKING:
    from cadpanel.solver.blocks import Normal  # SciPy takes its time, and settings ask limits for their ranges

# The held number may be as large as this share of the least length, so that much more is asked for.
_SPARE = 0.1
# Weight of a squared lack against the mean squared deviation before any tolerance is steered to.
_FIRST_WEIGHT = 1.0


class LackTerm(ABC):
    """Holds lengths of the panels of one group above a least one; a kind of length is one subclass."""

    def __init__(self, group: Group, place: int, panels: int, least: float, count: int) -> None:
        """Hold them above `least`, in units of the solver's length.

        Args:
            group: the panels.
            place: which group of the layout it is.
            panels: number of all panels.
            least: the least length.
            count: lengths a panel.
        """
        self._group, self._place, self._panels = group, place, panels
        self._least = (1.0 + _SPARE) * least
        self.hold = Hold(np.full((len(group.panels), count), _SPARE * least), weight=_FIRST_WEIGHT, least=_FIRST_WEIGHT)

    @abstractmethod
    def lengths(self, walked: Walk, corners: Points, *, derivatives: bool) -> tuple[Array, Array]:
        """The lengths (n, count), and how they follow the numbers (n, count, N; empty unless asked for)."""

    def vectors(self, state: State) -> Array:
        """(panels of the group, count, 1) what the lengths lack."""
        return self._lacks(state)[0][..., None]

    def cost(self, state: State) -> Array:
        """See `Term.cost`."""
        cost = np.zeros(self._panels)
        residual = self.hold.roots() * self._lacks(state)[0]
        cost[self._group.panels] = 0.5 * np.einsum("pq,pq->p", residual, residual)
        return cost

    def rows(self, state: State) -> list[Rows]:
        """See `Term.rows`."""
        lack, slope = self._lacks(state, derivatives=True)
        roots = self.hold.roots()
        jacobian = np.zeros((*lack.shape, state.layout.size))
        own = self._group.feature.by_unknowns(slope)
        jacobian[..., : own.shape[-1]] = roots[..., None] * own
        return [Rows(roots * lack, (self._group.panels,), (jacobian,))]

    def add_to(self, normal: Normal, state: State) -> Array:
        """See `Term.add_to`; mostly there is nothing to add."""
        if not self._lacks(state)[0].any():
            return np.zeros(self._panels)
        return add_rows(self.rows(state), normal, self._panels)

    def _lacks(self, state: State, *, derivatives: bool = False) -> tuple[Array, Array]:
        walked = state.walks[self._place]
        lengths, slopes = self.lengths(walked, self._group.feature.corners(walked), derivatives=derivatives)
        lack = self._least - lengths
        return np.maximum(lack, 0.0), np.where(lack[..., None] > 0.0, -slopes, 0.0) if derivatives else slopes
