"""Corner drift: how far a panel's corners may move from the reference's, along the strip and across its free edges.

Drift along the strip only shifts a joint and nobody sees it; drift across a free edge makes the roof's edge ragged. The
two directions therefore have limits of their own. Without them the gap can be gamed by panels that shrink or slide.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from cadpanel.arrays import Array
from cadpanel.solver.hold import Hold
from cadpanel.terms.limits.limit import Limit, Measured, Panels, Row
from cadpanel.terms.outline import Outline
from cadpanel.terms.state import State, slopes
from cadpanel.terms.term import HeldTerm

# Weight of a squared drift against the mean squared deviation: 100 mm of drift count like 1 mm of deviation.
LEAST_PULL = 1e-4
# Corners slide far along their seams on the way to a solution: damped as gaps are, they would only crawl.
TIES = 1e-3


class CornerDrift(Limit):
    """What both directions have in common: shares of the panel's length, which the paper's objective weighs."""

    weight = "drift"
    percent = True
    least, most = 1e-4, 0.5
    remedy = "more drift"
    way: str
    """The direction in a sentence, "along" or "across"."""

    def missed(self, panel: str, value: float, allowed: float, length: float) -> str:
        """See `Limit.missed`."""
        return (
            f"the drift limits are not met: panel '{panel}' leaves its outline by {value * length:.1f} mm {self.way} "
            f"its free edges, where {allowed * length:.1f} mm are allowed"
        )


class DriftAlong(CornerDrift):
    """Of all corners along the strip; of a panel whose ends cannot be told from its sides the whole drift."""

    name = "drift_along"
    what = "drift along the strip"
    way = "along"
    default = 0.02
    help = "How far corners may move along the strip, of the panel's length."
    rows = (
        Row("max_drift_along", "Largest drift along, mm", "{:.1f}", "corners along the strip"),
        Row("drift_along_percent", "  of the panel's length", "{:.2f} %"),
    )

    def held(self, panels: Panels, allowed: Mapping[str, float], margin: float) -> list[HeldTerm]:
        """See `Limit.held`."""
        return [DriftTerm(panels.outline, _lengths(panels, allowed, margin, self.name), across=False)]

    def measure(self, measured: Measured) -> Array:
        """See `Limit.measure`."""
        return np.asarray(measured.drift_along / measured.lengths)


class DriftAcross(CornerDrift):
    """Of outer corners across their free edges."""

    name = "drift_across"
    what = "drift across the free edges"
    way = "across"
    default = 0.02
    help = "How far corners may move across the free edges, which people see, of the length."
    rows = (
        Row("max_free_edge_drift", "Largest drift across, mm", "{:.1f}", "corners off the free edges"),
        Row("drift_across_percent", "  of the panel's length", "{:.2f} %"),
    )

    def held(self, panels: Panels, allowed: Mapping[str, float], margin: float) -> list[HeldTerm]:
        """See `Limit.held`; where ends cannot be told from sides it is the whole drift that the first limit allows."""
        across, along = (_lengths(panels, allowed, margin, name) for name in (self.name, DriftAlong.name))
        return [DriftTerm(panels.outline, np.where(panels.outline.sided, across, along), across=True)]

    def measure(self, measured: Measured) -> Array:
        """See `Limit.measure`."""
        return np.asarray(measured.drift_across / measured.lengths)


def _lengths(panels: Panels, allowed: Mapping[str, float], margin: float, name: str) -> Array:
    """(panels,) how far corners may move, in units of the solver's length."""
    return np.asarray((1.0 - margin) * allowed[name] * panels.lengths)


class DriftTerm(HeldTerm):
    """Holds the drift of corners within a limit: of all corners along the strip, or of outer ones across free edges.

    Even where the limit is far away a weak pull towards the reference's corners stays: what neither deviation nor gaps
    decide, such as the ends of a strip, is decided by the outline.
    """

    def __init__(self, outline: Outline, limit: Array, *, across: bool) -> None:
        """`limit` (panels,) in units of the solver's length."""
        self.outline = outline
        self.limited = outline.across if across else outline.along
        corners = self.limited.corners
        held = corners.shape[1]
        # Where it is all corners in their order, none need be picked out.
        whole = bool((corners == np.arange(held)).all())
        self._picked = (slice(None), slice(held)) if whole else (np.arange(len(limit))[:, None], corners)
        self.blocks, self.pair, self.panels = (np.arange(len(limit)),), None, len(limit)
        self.hold = Hold(np.repeat(limit[:, None], held, axis=1), weight=LEAST_PULL, ties=TIES)

    def vectors(self, state: State) -> Array:
        """(panels, L, d) the part of the corners' drift that is limited."""
        drift = self.outline.drift(state)[self._picked]
        part: Array = (self.limited.part @ drift[..., None])[..., 0]
        return part

    def linear(self, state: State) -> tuple[Array, tuple[Array, ...]]:
        """See `HeldTerm.linear`."""
        moved = slopes(state.corners)[self._picked]
        return self.vectors(state), (self.limited.part @ moved,)
