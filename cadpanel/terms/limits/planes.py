"""Boundary points of panels that stay in planes: seams that are level."""

from __future__ import annotations

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.solver.hold import Hold
from cadpanel.terms.limits.corner_drift import TIES
from cadpanel.terms.state import State, slopes
from cadpanel.terms.term import HeldTerm


class PlaneTerm(HeldTerm):
    """Holds boundary points of panels within a distance of planes; each point is by itself."""

    def __init__(
        self,
        own: IntArray,
        places: IntArray,
        normals: Array,
        offsets: Array,
        within: Array,
        panels: int,
        *,
        gives_way: bool = False,
    ) -> None:
        """Hold points in planes.

        Args:
            own: (g,) whose points.
            places: (g,) where they stand in `State.boundary`.
            normals: (g, 3) of the planes, in the panels' own frames.
            offsets: (g,) how far along them the planes lie from the frames' origins, in the solver's length.
            within: (g,) likewise.
            panels: number of all panels.
            gives_way: whether they give way as gaps do.
        """
        self._places, self._normals, self._offsets = places, normals, offsets
        self.blocks, self.pair, self.panels = (own,), None, panels
        self.hold = Hold(within[:, None], weight=0.0, gives_way=gives_way, ties=TIES)

    def vectors(self, state: State) -> Array:
        """(g, 1, 1) how far off its plane each point lies."""
        points = state.boundary.position[self.blocks[0], self._places]
        return np.asarray(np.einsum("gx,gx->g", self._normals, points) - self._offsets)[:, None, None]

    def linear(self, state: State) -> tuple[Array, tuple[Array, ...]]:
        """See `HeldTerm.linear`."""
        moved = slopes(state.boundary)[self.blocks[0], self._places]
        return self.vectors(state), ((self._normals[:, None, :] @ moved)[:, None],)
