"""The kink across seams: how far two neighbouring skins may differ in direction, which people see in reflections."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from cadpanel.arrays import Array
from cadpanel.solver.hold import Hold
from cadpanel.terms.limits.limit import Limit, Measured, Panels, Row, of_both_panels
from cadpanel.terms.placement import Placement
from cadpanel.terms.seams import SeamBatch
from cadpanel.terms.state import State, slopes
from cadpanel.terms.term import HeldTerm


class Kink(Limit):
    """The largest angle between two skins across a seam, degrees."""

    name = "max_kink"
    what = "largest kink"
    default = 180.0
    least, most = 0.01, 180.0
    unit = "degrees"
    help = "Largest angle between neighbouring skins across a seam; 180 for any."
    remedy = "a larger kink"
    rows = (Row("max_kink", "Largest kink, degrees", "{:.2f}"),)

    def held(self, panels: Panels, allowed: Mapping[str, float], margin: float) -> list[HeldTerm]:
        """See `Limit.held`; where it cannot be held, it gives way like gaps."""
        if allowed[self.name] >= self.most:
            return []
        chord = 2.0 * np.sin(0.5 * (1.0 - margin) * np.radians(allowed[self.name]))
        return [
            KinkTerm(batch, panels.place, panels.lengths[batch.panels].min(axis=1), chord) for batch in panels.seams
        ]

    def measure(self, measured: Measured) -> Array:
        """See `Limit.measure`."""
        return of_both_panels(measured, np.degrees(measured.kink))

    def missed(self, panel: str, value: float, allowed: float, length: float) -> str:
        """See `Limit.missed`."""
        del length
        return f"panel '{panel}' meets a neighbour at a kink of {value:.2f} degrees, where {allowed:g} are allowed"


class KinkTerm(HeldTerm):
    """Holds the chord between the two skins' normals at the corners that meet, in the length of their panels."""

    def __init__(self, seams: SeamBatch, place: Placement, lengths: Array, chord: float) -> None:
        """Hold the seams of a batch, with these lengths (seams,) in the solver's unit; a chord of 2 sin(angle / 2)."""
        self.seams, self.place = seams, place
        self.blocks, self.pair, self.panels = seams.blocks, seams.pair, len(place.origins)
        self._far = lengths[:, None, None, None]
        self.hold = Hold(
            np.repeat(chord * lengths[:, None], seams.corners.shape[2], axis=1), weight=0.0, gives_way=True
        )

    def vectors(self, state: State) -> Array:
        """(seams, corners, 3) from the second panel's normal to the first's, times lengths."""
        return (
            self._turned(state.normals.position[..., None], 0)[..., 0]
            - self._turned(state.normals.position[..., None], 1)[..., 0]
        )

    def linear(self, state: State) -> tuple[Array, tuple[Array, ...]]:
        """See `HeldTerm.linear`."""
        moved = slopes(state.normals)
        return self.vectors(state), (self._turned(moved, 0), -self._turned(moved, 1))

    def _turned(self, values: Array, which: int) -> Array:
        """(seams, corners, 3, columns) of values (panels, corners, 3, columns) in the panels' own frames."""
        panels, corners = self.seams.panels[:, which], self.seams.corners[:, which]
        turned: Array = self._far * (self.place.axes[panels][:, None] @ values[panels[:, None], corners])
        return turned
