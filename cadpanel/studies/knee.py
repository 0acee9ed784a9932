"""The knee of a curve that falls: where it stops to be worth much to go on."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

# A curve has a knee where it passes below the chord between its ends by this part of its height, at least, and is no
# line; of two places that are as far below the first one counts.
LEAST = 0.1
ALIKE = 1e-6
FEWEST = 3
# A curve that falls by less than this part of its highest value is level.
LEVEL = 0.05


def knee(gaps: Sequence[float], values: Sequence[float]) -> int | None:
    """The index of the knee; None where there are too few points, or the curve is straight or level.

    It is the point that lies farthest below the chord between the first and the last one, with the logarithm of the gap
    as the abscissa and both scaled to 1 (Satopaa et al. 2011).

    Args:
        gaps: rising, above 0.
        values: what is paid at them, not rising.
    """
    if len(gaps) < FEWEST:
        return None
    x, y = np.log(np.asarray(gaps, dtype=float)), np.asarray(values, dtype=float)
    height = float(y[0] - y[-1])
    if height <= LEVEL * float(y[0]):
        return None
    below = 1.0 - (x - x[0]) / (x[-1] - x[0]) - (y - y[-1]) / height
    if below.max() < LEAST:
        return None
    return int(np.argmax(below >= below.max() - ALIKE))
