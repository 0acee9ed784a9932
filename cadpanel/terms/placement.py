"""Where the panels' own frames stand in the model."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array, IntArray


@dataclass(frozen=True, slots=True, kw_only=True)
class Carrying:
    """How g frames stand in g others; worked out once, for frames stand still.

    Attributes:
        turn: (g, 3, 3) which turns vectors of the first into the others.
        shift: (g, 1, 3) their origins in the others, in the solver's length.
    """

    turn: Array
    shift: Array

    def points(self, points: Array) -> Array:
        """Points (g, q, 3) of the first frames in the others."""
        return np.asarray(points @ np.swapaxes(self.turn, 1, 2) + self.shift)

    def slopes(self, gradients: Array, rates: Array) -> Array:
        """(g, q, d, unknowns) how numbers follow unknowns through points (g, q) of the first frames.

        Args:
            gradients: (g, q, d, 3) of the numbers by the points in the other frames.
            rates: (g, q, 3, unknowns) of the points in their own frames.
        """
        # It is a few gradients that are turned, not the rates for every unknown.
        return np.asarray((gradients @ self.turn[:, None]) @ rates)

    def after(self, other: Carrying) -> Carrying:
        """The same, and after it another's frames."""
        return Carrying(turn=np.concatenate([self.turn, other.turn]), shift=np.concatenate([self.shift, other.shift]))


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

    def carrying(self, source: IntArray, target: IntArray) -> Carrying:
        """From the frames `source` (g,) into the frames `target` (g,)."""
        back = self.axes[target]
        apart = (self.origins[source] - self.origins[target])[:, None] / self.length
        return Carrying(turn=np.swapaxes(back, 1, 2) @ self.axes[source], shift=apart @ back)
