"""Boundary points of panels that stay at one height: seams that are level."""

from __future__ import annotations

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.solver.hold import Hold
from cadpanel.terms.limits.corner_drift import TIES
from cadpanel.terms.placement import Placement
from cadpanel.terms.state import State, slopes
from cadpanel.terms.term import HeldTerm

UP = np.array([0.0, 0.0, 1.0])


class HeightTerm(HeldTerm):
    """Holds boundary points of panels within a distance of a height; each point is by itself."""

    def __init__(self, own: IntArray, places: IntArray, heights: Array, within: Array, place: Placement) -> None:
        """Hold points at heights.

        Args:
            own: (g,) whose points.
            places: (g,) where they stand in `State.boundary`.
            heights: (g,) over the common origin, in the solver's length.
            within: (g,) likewise.
            place: the panels' frames.
        """
        self._places = places
        # In a panel's own frame: which way is up, and how high its origin lies below the height.
        self._up = UP @ place.axes[own]
        self._level = heights - place.origins[own] @ UP / place.length
        self.blocks, self.pair, self.panels = (own,), None, len(place.origins)
        self.hold = Hold(within[:, None], weight=0.0, gives_way=True, ties=TIES)

    def vectors(self, state: State) -> Array:
        """(g, 1, 1) how far above its height each point lies."""
        points = state.boundary.position[self.blocks[0], self._places]
        return np.asarray(np.einsum("gx,gx->g", self._up, points) - self._level)[:, None, None]

    def linear(self, state: State) -> tuple[Array, tuple[Array, ...]]:
        """See `HeldTerm.linear`."""
        moved = slopes(state.boundary)[self.blocks[0], self._places]
        return self.vectors(state), ((self._up[:, None, :] @ moved)[:, None],)
