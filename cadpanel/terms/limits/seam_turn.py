"""The turn of seams: how far the edges of panels may turn from the drawing's, in the skin.

Drift limits hold corners, and let both ends of a seam drift to opposite sides: seams would lean to the left and to the
right in turn, and panels become trapezoids. What is held here is the direction of every piece of an edge against the
plane in which the drawing has that edge.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.features.edge_pieces import SHORT, places, turns
from cadpanel.solver.hold import Hold
from cadpanel.terms.limits.corner_drift import TIES
from cadpanel.terms.limits.limit import Limit, Measured, Panels, Row
from cadpanel.terms.outline import Pieces
from cadpanel.terms.state import State, slopes
from cadpanel.terms.term import HeldTerm


class SeamTurn(Limit):
    """Of the ends of panels, and of all their edges that lie on a seam, degrees."""

    name = "seam_turn"
    what = "turn of seams"
    default = 3.0
    least, most = 0.01, 90.0
    unit = "degrees"
    help = "How far seams may turn from the drawn ones."
    yields = True
    remedy = "seams that turn more"
    rows = (Row("max_seam_turn", "Largest turn of a seam, degrees", "{:.2f}", "against the drawn seam"),)

    def held(self, panels: Panels, allowed: Mapping[str, float], margin: float) -> list[HeldTerm]:
        """See `Limit.held`; polygons without seams have nothing that may not turn."""
        if allowed[self.name] >= self.most or not panels.outline.pieces.planes.any():
            return []
        sine = np.sin((1.0 - margin) * np.radians(allowed[self.name]))
        return [TurnTerm(panels.outline.pieces, panels.lengths, sine)]

    def measure(self, measured: Measured) -> Array:
        """See `Limit.measure`."""
        return np.degrees(measured.turn)

    def missed(self, panel: str, value: float, allowed: float, length: float) -> str:
        """See `Limit.missed`."""
        del length
        return (
            f"an edge of panel '{panel}' turns by {value:.2f} degrees from the drawn one, where {allowed:g} are allowed"
        )


class TurnTerm(HeldTerm):
    """Holds the turns of the pieces of panels' edges: how far they would lead aside in the length of their panel."""

    def __init__(self, pieces: Pieces, lengths: Array, sine: float) -> None:
        """Hold them below `sine` in panels with these lengths (panels,), in the solver's unit.

        Each piece is by itself: rows that stand in for pieces would count as something held.
        """
        own, piece = (found[:, None] for found in np.nonzero(pieces.planes.any(axis=2)))
        self._pieces = Pieces(
            points=pieces.points[own, piece], planes=pieces.planes[own, piece], lengths=pieces.lengths[own, piece]
        )
        self.blocks, self.pair, self.panels = (own[:, 0],), None, len(pieces.lengths)
        self._far = lengths[own]
        self._found: tuple[int, IntArray] | None = None
        self.hold = Hold(sine * self._far, weight=0.0, ties=TIES)

    def vectors(self, state: State) -> Array:
        """(pieces, 1, 1) sines times lengths."""
        return (self._far * self._turns(self._ends(state)))[..., None]

    def linear(self, state: State) -> tuple[Array, tuple[Array, ...]]:
        """See `HeldTerm.linear`: with the piece D and its length W the sine is m . D / W."""
        ends = self._ends(state)
        sines = self._turns(ends)
        across = ends[:, :, 1] - ends[:, :, 0]
        size = np.sqrt(np.einsum("npx,npx->np", across, across))
        least = SHORT * self._pieces.lengths
        stretched = np.where(size > least, sines / np.where(size > least, size, 1.0), 0.0)
        counted = np.maximum(np.maximum(size, least), np.finfo(float).tiny)
        by_piece = (self._pieces.planes - stretched[..., None] * across) / counted[..., None]
        rates = slopes(state.boundary)[self.blocks[0][:, None, None], self._places(state)]
        by_piece = self._far[..., None] * by_piece
        return (self._far * sines)[..., None], (by_piece[:, :, None, :] @ (rates[:, :, 1] - rates[:, :, 0]),)

    def _places(self, state: State) -> IntArray:
        corners = state.corners.position.shape[1]
        if self._found is None or self._found[0] != corners:
            self._found = corners, places(self._pieces.points, corners)
        return self._found[1]

    def _ends(self, state: State) -> Array:
        """(pieces, 1, 2, 3) in the panels' own frames."""
        ends: Array = state.boundary.position[self.blocks[0][:, None, None], self._places(state)]
        return ends

    def _turns(self, ends: Array) -> Array:
        return turns(ends, self._pieces.planes, self._pieces.lengths)
