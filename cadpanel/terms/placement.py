"""Where the panels' own frames stand in the model."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array, IntArray


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

    def carry(self, points: Array, source: IntArray, target: IntArray) -> Array:
        """Points (g, q, 3) of the frames `source` (g,), in the frames `target` (g,)."""
        local: Array = (self.to_world(points, source) - self.origins[target, None] / self.length) @ self.axes[target]
        return local

    def turn(self, source: IntArray, target: IntArray) -> Array:
        """(g, 3, 3) which turns vectors of the frames `source` into the frames `target`."""
        return np.swapaxes(self.axes[target], 1, 2) @ self.axes[source]
