"""Corner drift: how far a panel's corners may move from the reference's, along the strip and across its free edges.

Drift along the strip only shifts a joint and nobody sees it; drift across a free edge makes the roof's edge ragged. The
two directions therefore have limits of their own. Without them the gap can be gamed by panels that shrink or slide.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array, BoolArray, IntArray
from cadpanel.solver.blocks import Normal
from cadpanel.solver.tolerance_weights import Hold
from cadpanel.terms.rows import Rows, add_rows
from cadpanel.terms.state import State, slopes

# Weight of a squared drift against the mean squared deviation: 100 mm of drift count like 1 mm of deviation.
LEAST_PULL = 1e-4


@dataclass(frozen=True, slots=True, kw_only=True)
class Limited:
    """Which corners are limited in one direction, and what of their drift counts.

    Attributes:
        corners: (panels, L) their places among the panels' corners.
        part: (panels, L, d, 3) rows that take from a drift what is limited; zero where a panel has fewer corners.
    """

    corners: IntArray
    part: Array

    def take(self, panels: IntArray) -> Limited:
        """Those of some panels, as many to a panel as they need."""
        part = self.part[panels]
        held = part.any(axis=(0, 2, 3))
        return Limited(corners=self.corners[panels][:, held], part=part[:, held])


@dataclass(frozen=True, slots=True, kw_only=True)
class Outline:
    """The reference's corners as the drift limits see them.

    Inside the fold a panel has corners too, where its flanges begin. Where across the fold they lie is a matter of the
    fit, but along the strip they belong on the reference's end like the outer ones: otherwise a cut plane could tilt
    far out of the end while its outer corners stay. How far they are from the end is told in the direction of the
    strip, so that a corner may slide along an end that runs askew.

    Attributes:
        corners: (panels, corners, 3) points on the reference's outline in the panels' own frames and the solver's
            length: its corners, and between them points on its ends.
        along: all corners, one number each: the drift along the strip.
        across: outer corners, three numbers each: the drift across the free edge. A panel whose ends cannot be told
            from its sides has only these, and they are its whole drift.
        sided: (panels,) whether ends can be told from sides.
    """

    corners: Array
    along: Limited
    across: Limited
    sided: BoolArray

    def take(self, panels: IntArray) -> Outline:
        """The outlines of some panels, with as many corners as the largest of them has: every corner is limited."""
        along, across = self.along.take(panels), self.across.take(panels)
        count = 1 + max(int(limited.corners.max(initial=0)) for limited in (along, across))
        return Outline(corners=self.corners[panels, :count], along=along, across=across, sided=self.sided[panels])

    def drift(self, state: State) -> Array:
        """(panels, corners, 3) from the reference's corners to the panels'."""
        return state.corners.position - self.corners


class DriftLimit:
    """Holds the drift of corners within a limit: of all corners along the strip, or of outer ones across free edges.

    Even where the limit is far away a weak pull towards the reference's corners stays: what neither deviation nor gaps
    decide, such as the ends of a strip, is decided by the outline.
    """

    def __init__(self, outline: Outline, limit: Array, *, across: bool) -> None:
        """`limit` (panels,) in units of the solver's length."""
        self.outline = outline
        self.limited = outline.across if across else outline.along
        self._rows = np.arange(len(limit))[:, None]
        held = self.limited.corners.shape[1]
        self.hold = Hold(np.repeat(limit[:, None], held, axis=1), weight=LEAST_PULL, least=LEAST_PULL)

    def vectors(self, state: State) -> Array:
        """(panels, L, d) the part of the corners' drift that is limited."""
        drift = self.outline.drift(state)[self._rows, self.limited.corners]
        part: Array = (self.limited.part @ drift[..., None])[..., 0]
        return part

    def cost(self, state: State) -> Array:
        """See `Term.cost`."""
        residual = self.hold.roots()[..., None] * self.vectors(state)
        cost: Array = 0.5 * np.einsum("pqx,pqx->p", residual, residual)
        return cost

    def rows(self, state: State) -> list[Rows]:
        """See `Term.rows`."""
        roots = self.hold.roots()[..., None]
        residual = roots * self.vectors(state)
        panels, corners, size = residual.shape
        weighted = roots[..., None] * self.limited.part
        jacobian = weighted @ slopes(state.corners)[self._rows, self.limited.corners]
        jacobian = jacobian.reshape(panels, corners * size, jacobian.shape[-1])
        return [Rows(residual.reshape(panels, -1), (np.arange(panels),), (jacobian,))]

    def add_to(self, normal: Normal, state: State) -> Array:
        """See `Term.add_to`."""
        return add_rows(self.rows(state), normal, len(self._rows))
