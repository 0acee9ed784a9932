"""Gaps between the corners of neighbours, and where panels stand."""

from __future__ import annotations

import numpy as np

from cadpanel.arrays import Array
from cadpanel.solver.hold import Hold
from cadpanel.terms.placement import Placement
from cadpanel.terms.seams import SeamBatch
from cadpanel.terms.state import State, slopes
from cadpanel.terms.term import HeldTerm


class CornerGap(HeldTerm):
    """Holds corresponding corners of the two panels at every seam of a batch within a tolerance: Table 1's measure."""

    def __init__(self, seams: SeamBatch, place: Placement, *, tolerance: float) -> None:
        """Hold the corners that meet within `tolerance`, in units of the solver's length."""
        self.seams, self.place = seams, place
        self.blocks, self.pair, self.panels = seams.blocks, seams.pair, len(place.origins)
        self.hold = Hold(np.full(seams.corners[:, 0].shape, tolerance), weight=1.0, gives_way=True)

    def vectors(self, state: State) -> Array:
        """(seams, corners, 3) from the second panel's corner to the first's."""
        return self._position(state, 0) - self._position(state, 1)

    def linear(self, state: State) -> tuple[Array, tuple[Array, ...]]:
        """See `HeldTerm.linear`."""
        return self.vectors(state), (self._jacobian(state, 0), -self._jacobian(state, 1))

    def _position(self, state: State, which: int) -> Array:
        panels, corners = self.seams.panels[:, which], self.seams.corners[:, which]
        return self.place.to_world(state.corners.position[panels[:, None], corners], panels)

    def _jacobian(self, state: State, which: int) -> Array:
        panels, corners = self.seams.panels[:, which], self.seams.corners[:, which]
        turned: Array = self.place.axes[panels][:, None] @ slopes(state.corners)[panels[:, None], corners]
        return turned
