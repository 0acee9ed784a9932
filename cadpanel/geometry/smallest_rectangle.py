"""The smallest rectangle about an outline: the blank that a flat part is cut from."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import ConvexHull

from cadpanel.arrays import Array

# Rectangles whose areas differ by no more than this part are alike, and the most oblong of them is taken.
_ALIKE = 1e-9
# A part larger by no more than this is as large as the sheet, mm.
_TOUCHING = 1e-6


@dataclass(frozen=True, slots=True, kw_only=True)
class Rectangle:
    """A rectangle in the plane.

    Attributes:
        length, width: its sides, the longer one first, mm.
        direction: (2,) unit vector along its length.
    """

    length: float
    width: float
    direction: Array

    def fits(self, length: float, width: float) -> bool:
        """Whether it fits on a sheet of that size, laid along it or across."""
        return self.length <= max(length, width) + _TOUCHING and self.width <= min(length, width) + _TOUCHING


def smallest_rectangle(points: Array) -> Rectangle:
    """The rectangle of least area about points (m, 2); one of its sides lies along an edge of their hull.

    Source: H. Freeman and R. Shapira, Determining the minimum-area encasing rectangle for an arbitrary closed curve,
    Communications of the ACM 18 (1975).
    """
    corners = points[ConvexHull(points).vertices]
    ways = np.roll(corners, -1, axis=0) - corners
    along = ways / np.linalg.norm(ways, axis=-1)[:, None]
    across = np.stack([-along[:, 1], along[:, 0]], axis=-1)
    sizes = np.stack([np.ptp(corners @ axes.T, axis=0) for axes in (along, across)], axis=-1)
    areas = sizes.prod(axis=-1)
    alike = np.flatnonzero(areas <= areas.min() * (1.0 + _ALIKE))
    best = alike[sizes[alike].max(axis=-1).argmax()]
    length, width = sizes[best].max(), sizes[best].min()
    direction = along[best] if sizes[best, 0] >= sizes[best, 1] else across[best]
    return Rectangle(length=float(length), width=float(width), direction=direction)
