"""Where panels stand in the coordinates of the reference's file, and how long the solver's unit of length is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array


@dataclass(frozen=True, slots=True, kw_only=True)
class Placed:
    """The frames of n panels.

    Attributes:
        names: of the panels.
        origins: (n, 3) in the file, mm.
        axes: (n, 3, 3) columns b, t, n.
        length: mm.
    """

    names: Sequence[str]
    origins: Array
    axes: Array
    length: float

    def points(self, local: Array) -> Array:
        """(n, m, 3) points in the file, mm, from those in the panels' frames."""
        return self.vectors(local * self.length) + self.origins[:, None]

    def vectors(self, local: Array) -> Array:
        """(n, m, 3) vectors in the directions of the file."""
        turned: Array = local @ np.swapaxes(self.axes, 1, 2)
        return turned

    def directions(self, local: Array) -> Array:
        """(n, m, 3) the same, of unit length."""
        turned = self.vectors(local)
        unit: Array = turned / np.linalg.norm(turned, axis=-1, keepdims=True)
        return unit
