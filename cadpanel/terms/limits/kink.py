"""The kink across seams: how far two neighbouring skins may differ in direction, which people see in reflections."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.features.layout import Layout
from cadpanel.solver.hold import Hold
from cadpanel.terms.limits.limit import Limit, Measured, Panels, Row, of_both_panels
from cadpanel.terms.placement import Placement
from cadpanel.terms.seams import SeamBatch, arc_places
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
    rows = (Row("max_kink", "Largest kink, degrees", "{:.2f}", "between two skins"),)

    def held(self, panels: Panels, allowed: Mapping[str, float], margin: float) -> list[HeldTerm]:
        """See `Limit.held`; where it cannot be held, it gives way like gaps."""
        if allowed[self.name] >= self.most:
            return []
        chord = 2.0 * np.sin(0.5 * (1.0 - margin) * np.radians(allowed[self.name]))
        return [
            KinkTerm(batch, panels.place, panels.layout, panels.lengths[batch.panels].min(axis=1), chord)
            for batch in panels.seams
        ]

    def measure(self, measured: Measured) -> Array:
        """See `Limit.measure`."""
        return of_both_panels(measured, np.degrees(measured.kink))

    def missed(self, panel: str, value: float, allowed: float, length: float) -> str:
        """See `Limit.missed`."""
        del length
        return f"panel '{panel}' meets a neighbour at a kink of {value:.2f} degrees, where {allowed:g} are allowed"


class KinkTerm(HeldTerm):
    """Holds the chord between the two skins' normals at points that meet, in the length of their panels.

    These are the corners, and where edges are alike the arc points between them: arcs that begin and end together pass
    through about the same shares of their sweeps together.
    """

    def __init__(self, seams: SeamBatch, place: Placement, layout: Layout, lengths: Array, chord: float) -> None:
        """Hold the seams of a batch, with these lengths (seams,) in the solver's unit; a chord of 2 sin(angle / 2)."""
        self._places = _meeting(seams, layout)
        self.seams, self.place = seams, place
        self.blocks, self.pair, self.panels = seams.blocks, seams.pair, len(place.origins)
        self._far = lengths[:, None, None, None]
        self.hold = Hold(np.repeat(chord * lengths[:, None], self._places.shape[2], axis=1), weight=0.0, gives_way=True)

    def vectors(self, state: State) -> Array:
        """(seams, points, 3) from the second panel's normal to the first's, times lengths."""
        normals = state.boundary_normals.position[..., None]
        return self._turned(normals, 0)[..., 0] - self._turned(normals, 1)[..., 0]

    def linear(self, state: State) -> tuple[Array, tuple[Array, ...]]:
        """See `HeldTerm.linear`."""
        moved = slopes(state.boundary_normals)
        return self.vectors(state), (self._turned(moved, 0), -self._turned(moved, 1))

    def _turned(self, values: Array, which: int) -> Array:
        """(seams, points, 3, columns) of values (panels, points, 3, columns) in the panels' own frames."""
        panels, places = self.seams.panels[:, which], self._places[:, which]
        turned: Array = self._far * (self.place.axes[panels][:, None] @ values[panels[:, None], places])
        return turned


def _meeting(seams: SeamBatch, layout: Layout) -> IntArray:
    """(seams, 2, points) what meets, by its places among the panels' corners and the arc points after these."""
    if not seams.alike:
        return seams.corners
    first, second = (arc_places(layout, seams, side) for side in (0, 1))
    second = np.where(seams.reversed[:, None], second[:, ::-1], second)
    corners = max(group.feature.corner_count for group in layout.groups)
    return np.concatenate([seams.corners, corners + np.stack([first, second], axis=1)], axis=2)
