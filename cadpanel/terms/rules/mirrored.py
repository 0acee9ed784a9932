"""Panels that are mirror images of others: every corner, and the points on the arcs of their ends."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.solver.hold import Hold
from cadpanel.terms.placement import Placement
from cadpanel.terms.state import State, slopes
from cadpanel.terms.term import HeldTerm


@dataclass(frozen=True, slots=True, kw_only=True)
class Images:
    """Pairs of panels, each the mirror image of the other.

    Attributes:
        first, second: (g,) the lower and the higher panels.
        pair: (g,) which pair of coupled panels they are.
        places: (2, g, q) points of the panels' boundaries that are images of each other.
        points, normals: (g, 3) of the planes between them, in the solver's length from the common origin.
    """

    first: IntArray
    second: IntArray
    pair: IntArray
    places: IntArray
    points: Array
    normals: Array


class MirrorTerm(HeldTerm):
    """Holds the images of the second panels' points within a distance of the first panels' points."""

    def __init__(self, images: Images, place: Placement, within: float, panels: int) -> None:
        """`within` in the solver's length, of `panels` panels in all."""
        self._images, self._place = images, place
        self.blocks, self.pair, self.panels = (images.first, images.second), images.pair, panels
        turned = np.eye(3) - 2.0 * images.normals[:, :, None] * images.normals[:, None, :]
        self._turned = turned
        self._moved = 2.0 * np.einsum("gx,gx->g", images.points, images.normals)[:, None] * images.normals
        self.hold = Hold(np.full(images.places[0].shape, within), weight=0.0, gives_way=True)

    def vectors(self, state: State) -> Array:
        """(g, q, 3)."""
        first, second = (self._taken(state.boundary.position, side) for side in (0, 1))
        there = self._place.to_world(second, self.blocks[1]) @ self._turned + self._moved[:, None]
        found: Array = self._place.to_world(first, self.blocks[0]) - there
        return found

    def linear(self, state: State) -> tuple[Array, tuple[Array, ...]]:
        """See `HeldTerm.linear`; the matrix that mirrors is its own transpose."""
        rates = slopes(state.boundary)
        first = self._place.axes[self.blocks[0]][:, None] @ self._taken(rates, 0)
        second = (self._turned @ self._place.axes[self.blocks[1]])[:, None] @ self._taken(rates, 1)
        return self.vectors(state), (first, -second)

    def _taken(self, values: Array, side: int) -> Array:
        return np.asarray(values[self.blocks[side][:, None], self._images.places[side]])
