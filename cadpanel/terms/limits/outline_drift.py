"""Outline drift: how far the free outline of the surface may leave the drawn one anywhere along it.

Corners may lie on the drawing while the straight or conic edges between them do not: what people see of a roof is its
line. Distances are square to the drawn line, so panels may slide along it.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from cadpanel.arrays import Array
from cadpanel.geometry.line_feet import line_feet
from cadpanel.solver.hold import Hold
from cadpanel.terms.limits.corner_drift import TIES
from cadpanel.terms.limits.limit import Limit, Measured, Panels, Row
from cadpanel.terms.outline import Line
from cadpanel.terms.state import State, slopes
from cadpanel.terms.term import HeldTerm

# Between the places that are held edges part a little further, and arcs more than segments.
_SEGMENTS, _ARCS = 0.98, 0.8


class DriftOutline(Limit):
    """Of all edges that lie on no seam, as a share of the panel's length."""

    name = "drift_outline"
    what = "drift of the free outline"
    default = 0.5
    least, most = 1e-4, 0.5
    percent = True
    help = "How far the free outline may leave the drawn one anywhere; 50 % for any."
    yields = True
    remedy = "an outline that leaves the drawn one further"
    rows = (
        Row("max_outline_drift", "Free outline off the drawn, mm", "{:.1f}", "anywhere along the outline"),
        Row("outline_drift_percent", "  of the panel's length", "{:.2f} %"),
    )

    def held(self, panels: Panels, allowed: Mapping[str, float], margin: float) -> list[HeldTerm]:
        """See `Limit.held`."""
        line = panels.outline.line
        if allowed[self.name] >= self.most or not len(line.panels):
            return []
        return [OutlineTerm(line, (1.0 - margin) * allowed[self.name] * panels.lengths)]

    def measure(self, measured: Measured) -> Array:
        """See `Limit.measure`."""
        return np.asarray(measured.outline_drift / measured.lengths)

    def missed(self, panel: str, value: float, allowed: float, length: float) -> str:
        """See `Limit.missed`."""
        return (
            f"the free outline of panel '{panel}' is {value * length:.1f} mm off the drawn one, where "
            f"{allowed * length:.1f} mm are allowed"
        )


class OutlineTerm(HeldTerm):
    """Holds points of free edges near the drawn lines."""

    def __init__(self, line: Line, limit: Array) -> None:
        """`limit` (panels,) in units of the solver's length."""
        self._line = line
        self.blocks, self.pair, self.panels = (line.panels,), None, len(limit)
        held = np.where(line.straight, _SEGMENTS, _ARCS) * limit[line.panels]
        radius = np.repeat(held[:, None], line.places.shape[1], axis=1)
        self.hold = Hold(radius, weight=0.0, ties=TIES)

    def vectors(self, state: State) -> Array:
        """(f, m, 3) from the drawn lines to the points."""
        points = self._taken(state.boundary.position)
        return points - line_feet(points, self._line.drawn)[0]

    def linear(self, state: State) -> tuple[Array, tuple[Array, ...]]:
        """See `HeldTerm.linear`: a foot follows its point along the line."""
        rates = slopes(state.boundary)
        points = self._taken(state.boundary.position)
        feet, along = line_feet(points, self._line.drawn)
        moved = self._taken(rates)
        moved = moved - along[..., None] * (along[..., None, :] @ moved)
        return points - feet, (moved,)

    def _taken(self, values: Array) -> Array:
        """(f, m, 3, ...) values (panels, points, 3, ...) of the boundary where the held points are."""
        own = self._line.panels[:, None]
        first, second = (values[own, self._line.places[..., end]] for end in (0, 1))
        share = self._line.shares.reshape(*self._line.shares.shape, *(1,) * (first.ndim - 2))
        return np.asarray(first + share * (second - first))
