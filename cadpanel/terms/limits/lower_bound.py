"""Lengths that must not fall below a least one: what they lack is a held number."""

from __future__ import annotations

from abc import abstractmethod

import numpy as np

from cadpanel.arrays import Array
from cadpanel.features.layout import Group
from cadpanel.features.rulings import Points, Walk
from cadpanel.solver.hold import Hold
from cadpanel.terms.state import State
from cadpanel.terms.term import HeldTerm

# The held number may be as large as this share of the least length, so that much more is asked for.
_SPARE = 0.1
# Weight of a squared lack against the mean squared deviation.
_WEIGHT = 1.0


class LackTerm(HeldTerm):
    """Holds lengths of the panels of one group above a least one; a kind of length is one subclass."""

    def __init__(self, group: Group, place: int, panels: int, least: Array | float, count: int) -> None:
        """Hold them above `least`, in units of the solver's length.

        Args:
            group: the panels.
            place: which group of the layout it is.
            panels: number of all panels.
            least: the least length, one for all or (panels of the group, 1).
            count: lengths a panel.
        """
        self._group, self._place = group, place
        self.blocks, self.pair, self.panels = (group.panels,), None, panels
        self._least = (1.0 + _SPARE) * least
        scale = np.broadcast_to(least, (len(group.panels), count)).astype(np.float64)
        self.hold = Hold(_SPARE * scale, weight=_WEIGHT, scale=scale, one_sided=True)

    @abstractmethod
    def lengths(self, walked: Walk, corners: Points, *, derivatives: bool) -> tuple[Array, Array]:
        """The lengths (n, count), and how they follow the numbers (n, count, N; empty unless asked for)."""

    def vectors(self, state: State) -> Array:
        """(panels of the group, count, 1) what the lengths lack; below 0 where they lack nothing."""
        return (self._least - self._lengths(state, derivatives=False)[0])[..., None]

    def linear(self, state: State) -> tuple[Array, tuple[Array, ...]]:
        """See `HeldTerm.linear`."""
        lengths, slopes = self._lengths(state, derivatives=True)
        own = self._group.feature.by_unknowns(slopes)
        if own.shape[-1] == state.layout.size:
            return (self._least - lengths)[..., None], (-own[..., None, :],)
        jacobian = np.zeros((*lengths.shape, 1, state.layout.size))
        jacobian[..., 0, : own.shape[-1]] = -own
        return (self._least - lengths)[..., None], (jacobian,)

    def _lengths(self, state: State, *, derivatives: bool) -> tuple[Array, Array]:
        return self.lengths(state.walks[self._place], state.own_corners[self._place], derivatives=derivatives)
