"""Many drawings on one sheet, in rows."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from cadpanel.arrays import Array
from cadpanel.delivery.drawing.entities import Drawing, extents

# Space between two drawings, as a part of the largest one.
_SPACE = 0.05


def in_rows(drawings: Sequence[Drawing]) -> list[Array]:
    """Shifts (2,) that lay drawings out in rows from the top, in their order, about as wide as high altogether."""
    boxes = [extents(drawing) for drawing in drawings]
    sizes = np.array([high - low for low, high in boxes])
    space = _SPACE * float(sizes.max())
    wide = max(float(sizes[:, 0].max()), math.sqrt(float((sizes + space).prod(axis=-1).sum())))
    shifts: list[Array] = []
    left, top, tallest = 0.0, 0.0, 0.0
    for (low, _), (width, height) in zip(boxes, sizes.tolist(), strict=True):
        # A hair of room, so that rows do not hang on the last digit.
        if left > 0.0 and left + width > wide * (1.0 + 1e-9):
            left, top, tallest = 0.0, top - tallest - space, 0.0
        shifts.append(np.array([left, top - height]) - low)
        left, tallest = left + width + space, max(tallest, height)
    return shifts
