"""Gaps between the corners of neighbours, and where seams and panels stand."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cadpanel.solver.blocks import Normal
from cadpanel.solver.hold import Hold
from cadpanel.terms.rows import Rows, add_rows, booked_cost
from cadpanel.terms.state import State

Array = NDArray[np.float64]
IntArray = NDArray[np.intp]


@dataclass(frozen=True, slots=True, kw_only=True)
class Seams:
    """Seams as index arrays, each with the lower panel first.

    Attributes:
        panels: (seams, 2).
        ends: (seams, 2) which end of each panel.
        reversed: (seams,) True where side 0 of one meets side 1 of the other.
        pair: (seams,) which pair of coupled blocks.
    """

    panels: IntArray
    ends: IntArray
    reversed: NDArray[np.bool_]
    pair: IntArray

    def in_first_order(self, values: Array) -> Array:
        """Values (seams, R, ...) of the second panels' points, put in the order of the first panels' points."""
        if self.reversed.any():
            values[self.reversed] = values[self.reversed, ::-1]
        return values


@dataclass(frozen=True, slots=True, kw_only=True)
class Placement:
    """Where the panels' own frames stand.

    Attributes:
        origins: (panels, 3) mm, from the common origin.
        centre: (3,) the common origin in the coordinates of the file, mm.
        axes: (panels, 3, 3) with columns b, t, n.
        length: mm that the solver counts as 1.
    """

    origins: Array
    centre: Array
    axes: Array
    length: float

    def to_world(self, points: Array, panels: IntArray | slice = slice(None)) -> Array:
        """Points (panels, ..., 3) of the panels' own frames, in units of `length` from the common origin."""
        axes, origins = self.axes[panels], self.origins[panels] / self.length
        flat = points.reshape(len(points), math.prod(points.shape[1:-1]), 3)
        return (flat @ np.swapaxes(axes, 1, 2) + origins[:, None, :]).reshape(points.shape)


class CornerGap:
    """Holds corresponding corners of the two panels at every seam within the tolerance: Table 1's measure."""

    def __init__(self, seams: Seams, place: Placement, *, corners: int, tolerance: float) -> None:
        """Hold `corners` on every seam within `tolerance`, in units of the solver's length."""
        self.seams, self.place = seams, place
        self.hold = Hold(np.full((len(seams.panels), corners), tolerance), weight=1.0, least=1e-9)

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
        if not groups:
            return []
        roots = self.hold.roots()[..., None]
        residual = (roots * self.vectors(state)).reshape(groups, -1)
        jacobians = (roots[..., None] * self._jacobian(state, 0), -roots[..., None] * self._jacobian(state, 1))
        flat = tuple(part.reshape(*residual.shape, -1) for part in jacobians)
        panels = (self.seams.panels[:, 0], self.seams.panels[:, 1])
        return [Rows(residual, panels, flat, self.seams.pair)]

    def add_to(self, normal: Normal, state: State) -> Array:
        """See `Term.add_to`."""
        return add_rows(self.rows(state), normal, len(self.place.origins))

    def _position(self, state: State, which: int) -> Array:
        panels, ends = self.seams.panels[:, which], self.seams.ends[:, which]
        position = self.place.to_world(state.corners.position[panels, ends], panels)
        return self.seams.in_first_order(position) if which == 1 else position

    def _jacobian(self, state: State, which: int) -> Array:
        if state.corners.jacobian is None:
            raise ValueError("the state was walked without derivatives")
        panels, ends = self.seams.panels[:, which], self.seams.ends[:, which]
        free = state.walked.feature.free
        turned = self.place.axes[panels][:, None] @ state.corners.jacobian[panels, ends][..., free]
        return self.seams.in_first_order(turned) if which == 1 else turned
