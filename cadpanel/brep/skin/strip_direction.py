"""Which way a strip runs: by how its normals turn, by its lengths, and by the axes of space."""

from __future__ import annotations

import numpy as np

from cadpanel.arrays import Array
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


def way_along(rates: tuple[float, float], lengths: tuple[float, float]) -> int:
    """Which of two ways over a surface a strip runs: that in which normals turn slowly, or the longer of two alike.

    Args:
        rates: by how much the normals turn per length, either way, radians a mm.
        lengths: how far the surface goes either way, mm.
    """
    slow, fast = sorted(rates)
    alike = fast < STRAIGHT or fast < ALIKE * slow
    return int(lengths[1] > lengths[0]) if alike else int(rates[1] < rates[0])


def runs_back(way: Array, slack: float = 0.0) -> bool:
    """Whether a way (3,) runs against the axis of space that it follows most, by more than the slack in mm."""
    return bool(way[np.abs(way).argmax()] < -slack)
