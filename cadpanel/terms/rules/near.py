"""Boundary points of single panels that stay near given points: locked corners, and panels that were made already."""

from __future__ import annotations

from cadpanel.arrays import Array, IntArray
from cadpanel.solver.hold import Hold
from cadpanel.terms.limits.corner_drift import TIES
from cadpanel.terms.state import State, slopes
from cadpanel.terms.term import HeldTerm


class NearTerm(HeldTerm):
    """Holds boundary points of panels within a distance of given points; each point is by itself."""

    def __init__(self, own: IntArray, places: IntArray, points: Array, within: Array, panels: int) -> None:
        """Hold points near others.

        Args:
            own: (g,) whose points.
            places: (g,) where they stand in `State.boundary`.
            points: (g, 3) where they belong, in the panels' own frames and the solver's length.
            within: (g,) in the solver's length.
            panels: number of all panels.
        """
        self._places, self._points = places, points
        self.blocks, self.pair, self.panels = (own,), None, panels
        self.hold = Hold(within[:, None], weight=0.0, gives_way=True, ties=TIES)

    def vectors(self, state: State) -> Array:
        """(g, 1, 3) from where they belong."""
        return (state.boundary.position[self.blocks[0], self._places] - self._points)[:, None]

    def linear(self, state: State) -> tuple[Array, tuple[Array, ...]]:
        """See `HeldTerm.linear`."""
        return self.vectors(state), (slopes(state.boundary)[self.blocks[0], self._places][:, None],)
