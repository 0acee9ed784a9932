"""Corner drift: how far a panel's corners may move from the reference's, along the strip and across its free edges.

Drift along the strip only shifts a joint and nobody sees it; drift across a free edge makes the roof's edge ragged. The
two directions therefore have limits of their own. Without them the gap can be gamed by panels that shrink or slide.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from cadpanel.geometry.frames import dot
from cadpanel.solver.blocks import Normal
from cadpanel.solver.hold import Hold
from cadpanel.terms.rows import Rows, add_rows
from cadpanel.terms.state import State

Array = NDArray[np.float64]

# Weight of a squared drift against the mean squared deviation: 100 mm of drift count like 1 mm of deviation.
LEAST_PULL = 1e-4


class Outline:
    """The reference's corners as the drift limits see them.

    Inside the fold a panel has corners too, where its flanges begin. Where across the fold they lie is a matter of the
    fit, but along the strip they belong on the reference's end like the outer ones: otherwise a cut plane could tilt
    far out of the end while its outer corners stay. How far they are from the end is told in the direction of the
    strip, so that a corner may slide along an end that runs askew.

    Attributes:
        corners: (panels, 2, k + 1, 3) points on the reference's ends [end, ruling] in the panels' own frames and the
            solver's length; the first and the last are the outline's corners.
        along: (panels, 2, k + 1, 3) unit direction of the strip there; that of the free edge at the outer corners.
        gauge: (panels, 2, k + 1, 3) vectors whose inner product with a drift is the drift along the strip: `along`
            itself at the outer corners, at the inner ones the normal m of the end's plane over m . along.
    """

    def __init__(self, corners: Array, along: Array, end_normals: Array) -> None:
        """Besides the attributes takes the normals (panels, 2, 3) of planes through the reference's ends."""
        self.corners, self.along = corners, along
        self.gauge = along.copy()
        inner = along[:, :, 1:-1]
        self.gauge[:, :, 1:-1] = end_normals[:, :, None] / dot(end_normals[:, :, None], inner)[..., None]

    def drift(self, state: State) -> Array:
        """(panels, 2, k + 1, 3) from the reference's corners to the panels'."""
        return state.corners.position - self.corners


class DriftLimit:
    """Holds the drift of corners within a limit: of all corners along the strip, or of outer ones across free edges.

    Even where the limit is far away a weak pull towards the reference's corners stays: what neither deviation nor gaps
    decide, such as the ends of a strip, is decided by the outline.
    """

    def __init__(self, outline: Outline, limit: Array, *, across: bool) -> None:
        """`limit` (panels,) in units of the solver's length."""
        self.outline = outline
        rulings = outline.corners.shape[2]
        self._rulings = np.array([0, rulings - 1]) if across else np.arange(rulings)
        along = outline.along[:, :, self._rulings]
        gauge = outline.gauge[:, :, self._rulings][..., None, :]
        # Rows that take from a drift what is limited: one number along the strip, three components across it.
        self._part = np.eye(3) - along[..., :, None] * gauge if across else gauge
        held = 2 * len(self._rulings)
        self.hold = Hold(np.repeat(limit[:, None], held, axis=1), weight=LEAST_PULL, least=LEAST_PULL)

    def vectors(self, state: State) -> Array:
        """(panels, corners, 1 or 3) the part of the corners' drift that is limited."""
        drift = self.outline.drift(state)[:, :, self._rulings]
        return (self._part @ drift[..., None]).reshape(len(drift), -1, self._part.shape[-2])

    def cost(self, state: State) -> Array:
        """See `Term.cost`."""
        residual = self.hold.roots()[..., None] * self.vectors(state)
        cost: Array = 0.5 * np.einsum("pqx,pqx->p", residual, residual)
        return cost

    def rows(self, state: State) -> list[Rows]:
        """See `Term.rows`."""
        if state.corners.jacobian is None:
            raise ValueError("the state was walked without derivatives")
        roots = self.hold.roots()[..., None]
        residual = roots * self.vectors(state)
        panels, corners, size = residual.shape
        moved = self._part @ state.corners.jacobian[:, :, self._rulings][..., state.walked.feature.free]
        jacobian = roots[..., None] * moved.reshape(panels, corners, size, -1)
        jacobian = jacobian.reshape(panels, corners * size, -1)
        return [Rows(residual.reshape(panels, -1), (np.arange(panels),), (jacobian,))]

    def add_to(self, normal: Normal, state: State) -> Array:
        """See `Term.add_to`."""
        return add_rows(self.rows(state), normal, len(self._part))
