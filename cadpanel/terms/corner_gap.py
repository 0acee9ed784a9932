"""Gaps between the corners of neighbours, and where panels stand."""

from __future__ import annotations

import numpy as np

from cadpanel.arrays import Array
from cadpanel.solver.blocks import Normal
from cadpanel.solver.tolerance_weights import Hold
from cadpanel.terms.placement import Placement
from cadpanel.terms.rows import Rows, add_rows, booked_cost
from cadpanel.terms.seams import SeamBatch
from cadpanel.terms.state import State, slopes


class CornerGap:
    """Holds corresponding corners of the two panels at every seam of a batch within a tolerance: Table 1's measure."""

    def __init__(self, seams: SeamBatch, place: Placement, *, tolerance: float) -> None:
        """Hold the corners that meet within `tolerance`, in units of the solver's length."""
        self.seams, self.place = seams, place
        self.hold = Hold(np.full(seams.corners[:, 0].shape, tolerance), weight=1.0, least=1e-9)

    def vectors(self, state: State) -> Array:
        """(seams, corners, 3) from the second panel's corner to the first's."""
        return self._position(state, 0) - self._position(state, 1)

    def cost(self, state: State) -> Array:
        """See `Term.cost`."""
        residual = self.hold.roots()[..., None] * self.vectors(state)
        return booked_cost(residual, tuple(self.seams.panels.T), len(self.place.origins))

    def rows(self, state: State) -> list[Rows]:
        """See `Term.rows`."""
        groups = len(self.seams.panels)
        roots = self.hold.roots()[..., None]
        residual = (roots * self.vectors(state)).reshape(groups, -1)
        jacobians = (roots[..., None] * self._jacobian(state, 0), -roots[..., None] * self._jacobian(state, 1))
        flat = tuple(part.reshape(*residual.shape, -1) for part in jacobians)
        return [Rows(residual, (self.seams.panels[:, 0], self.seams.panels[:, 1]), flat, self.seams.pair)]

    def add_to(self, normal: Normal, state: State) -> Array:
        """See `Term.add_to`."""
        return add_rows(self.rows(state), normal, len(self.place.origins))

    def _position(self, state: State, which: int) -> Array:
        panels, corners = self.seams.panels[:, which], self.seams.corners[:, which]
        return self.place.to_world(state.corners.position[panels[:, None], corners], panels)

    def _jacobian(self, state: State, which: int) -> Array:
        panels, corners = self.seams.panels[:, which], self.seams.corners[:, which]
        turned: Array = self.place.axes[panels][:, None] @ slopes(state.corners)[panels[:, None], corners]
        return turned
