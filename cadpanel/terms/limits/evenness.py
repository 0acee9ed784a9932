"""Evenness: seams follow one another at even steps, and rows go on straight across the panels beside.

The turn of a seam and the drift of its corners may be small and yet change sign from seam to seam: a zigzag, which
people see at once. What is held is half the second difference of the corners' drifts along the lines that go on across
a seam: by how much a corner lies off the middle between the one before and the one after, against the drawing.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.geometry.vectors import cross, unit
from cadpanel.reference.across_seams import AcrossSeams
from cadpanel.solver.hold import Hold
from cadpanel.terms.limits.corner_drift import TIES
from cadpanel.terms.limits.limit import Limit, Measured, Panels, Row, of_both_panels
from cadpanel.terms.state import State, slopes
from cadpanel.terms.term import HeldTerm


class Evenness(Limit):
    """Of all corners on seams between panels that have ends and sides, as a share of the panels' length."""

    name = "evenness"
    what = "unevenness of seams"
    default = 0.0025
    least, most = 1e-4, 0.5
    percent = True
    help = "How far corners on seams may lie off the middle between the seams before and after."
    yields = True
    remedy = "less even seams"
    rows = (
        Row("max_unevenness", "Largest unevenness of seams, mm", "{:.1f}", "seams off an even row"),
        Row("unevenness_percent", "  of the panel's length", "{:.2f} %"),
    )

    def held(self, panels: Panels, allowed: Mapping[str, float], margin: float) -> list[HeldTerm]:
        """See `Limit.held`."""
        if not len(panels.across.index):
            return []
        lengths = panels.lengths[panels.across.panels].min(axis=1)
        return [EvennessTerm(panels, (1.0 - margin) * allowed[self.name] * lengths)]

    def measure(self, measured: Measured) -> Array:
        """See `Limit.measure`."""
        return of_both_panels(measured, measured.uneven) / measured.lengths

    def missed(self, panel: str, value: float, allowed: float, length: float) -> str:
        """See `Limit.missed`."""
        return (
            f"a seam of panel '{panel}' lies {value * length:.1f} mm off the middle between those before and after it, "
            f"where {allowed * length:.1f} mm are allowed"
        )


class EvennessTerm(HeldTerm):
    """Holds how far the corners on seams lie off the middle between those across."""

    def __init__(self, panels: Panels, limit: Array) -> None:
        """`limit` (s,) in units of the solver's length, of the seams that `panels.across` has."""
        met, self._outline = panels.across, panels.outline
        self.blocks, self.pair = (met.panels[:, 0], met.panels[:, 1]), panels.pair_of[met.index]
        self.panels = len(panels.lengths)
        self._on, self._across = (_places(panels, met, corners) for corners in (met.on, met.across))
        # Two directions in the skin at each corner, for either panel in its own frame.
        drawn = met.normals
        least = np.eye(3)[np.abs(drawn).argmin(axis=2)]
        first = unit(cross(drawn, least))
        skin = np.stack([first, cross(drawn, first)], axis=2)
        self._skin = [0.5 * skin @ panels.place.axes[own][:, None] for own in self.blocks]
        self.hold = Hold(np.repeat(limit[:, None], 2, axis=1), weight=0.0, ties=TIES)

    def vectors(self, state: State) -> Array:
        """(s, 2, 2) in the skin."""
        drift = self._outline.drift(state)
        return np.asarray((self._off(drift[..., None], 0) + self._off(drift[..., None], 1))[..., 0])

    def linear(self, state: State) -> tuple[Array, tuple[Array, ...]]:
        """See `HeldTerm.linear`."""
        moved = slopes(state.corners)
        return self.vectors(state), tuple(self._off(moved, side) for side in (0, 1))

    def _off(self, values: Array, side: int) -> Array:
        """(s, 2, 2, columns) one panel's share, of values (panels, corners, 3, columns) that turn with its frame."""
        own = self.blocks[side][:, None]
        told: Array = self._skin[side] @ (values[own, self._on[:, side]] - values[own, self._across[:, side]])
        return told


def _places(panels: Panels, met: AcrossSeams, corners: IntArray) -> IntArray:
    """(s, 2, 2) outer corners, by their places among the panels' corners."""
    features = panels.layout.feature_of
    rulings = np.array([features[p].corner_count // 2 for p in range(len(features))], dtype=np.intp)[met.panels]
    end, side = corners // 2, corners % 2
    return end * rulings[:, :, None] + side * (rulings[:, :, None] - 1)
