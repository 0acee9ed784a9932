"""Which way a strip runs: by how its normals turn, by its lengths, and by the axes of space."""

from __future__ import annotations

import numpy as np

from cadpanel.arrays import Array
from cadpanel.geometry.order import EQUAL, first_way
from cadpanel.geometry.vectors import norm

# Two ways turn alike when their rates differ by less than this factor; then the longer one is along the strip.
ALIKE = 1.5
# Rates below this count as straight, radians a millimetre: 1 degree in 100 m.
STRAIGHT = 2e-7


def turning_angles(normals: Array) -> Array:
    """(..., q - 1) angles between each of (..., q, 3) unit normals along lines and the next one, radians."""
    steps = norm(np.diff(normals, axis=-2))
    angles: Array = 2.0 * np.arcsin(np.clip(0.5 * steps, 0.0, 1.0))
    return angles


def way_along(rates: tuple[float, float], lengths: tuple[float, float], ways: Array | None = None) -> int:
    """Which of two ways over a surface a strip runs: that in which normals turn slowly, or the longer of two alike.

    Args:
        rates: by how much the normals turn per length, either way, radians a mm.
        lengths: how far the surface goes either way, mm.
        ways: (2, 3) where both lead, for surfaces as long one way as the other; None where the first one is to count.
    """
    slow, fast = sorted(rates)
    if fast >= STRAIGHT and fast >= ALIKE * slow:
        return int(rates[1] < rates[0])
    if ways is not None and min(lengths) >= (1.0 - EQUAL) * max(lengths):
        return first_way(ways)
    return int((1.0 - EQUAL) * lengths[1] > lengths[0])
