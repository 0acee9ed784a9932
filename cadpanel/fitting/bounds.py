"""Bounds that keep panels makeable while they are fitted: no fold turns inside out, no patch shrinks to nothing.

What a feature's author has bounded keeps the author's bounds. Signs are those of the start: a radius cannot pass
through infinity on its way from a convex patch to a concave one.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cadpanel.arrays import Array
from cadpanel.features.layout import Layout
from cadpanel.features.numbers import Number
from cadpanel.terms.limits.catalogue import LIMITS

# Cones open by no more than this, radians: sheet is rolled to cones, not to discs.
STEEPEST = np.radians(30.0)
# Radius and sweep of a patch keep this share of what they start with, and a sweep stays below half a turn.
LEAST_SHARE = 0.1
WIDEST_SWEEP = np.radians(175.0)
# Slopes of a cut plane against the panel's own frame; flat panels may have corners of 11 degrees.
MOST_SLOPE = 2.0
MOST_FLAT_SLOPE = 5.0
LARGEST_RADIUS = 1e7
"""mm; beyond it a patch is flat to within rounding."""


def natural_bounds(layout: Layout, starts: Sequence[Array], length: float) -> tuple[Array, Array]:
    """(panels, size) least and greatest unknowns.

    Args:
        layout: the panels' features, in units of `length` mm.
        starts: arrays (panels, size) that the fits begin with, the likeliest first.
        length: mm.
    """
    lower, upper = np.full(starts[0].shape, -np.inf), np.full(starts[0].shape, np.inf)
    for group in layout.groups:
        for column, index in enumerate(group.feature.free):
            number = group.feature.numbers[index]
            begun = np.array([start[group.panels, column] for start in starts])
            low, high = _natural(number, begun, length, flat=not any(group.feature.curved))
            lower[group.panels, column] = number.lower if np.isfinite(number.lower) else np.minimum(low, number.upper)
            upper[group.panels, column] = number.upper if np.isfinite(number.upper) else np.maximum(high, number.lower)
    return lower, upper


def _natural(number: Number, begun: Array, length: float, *, flat: bool) -> tuple[Array, Array]:
    """(n,) bounds of one number of n panels, from what it starts with (starts, n)."""
    what = number.name.rpartition(" ")[2]
    free = np.full(begun.shape[1], np.inf)
    least = [bound for limit in LIMITS if (bound := limit.bound(number)) is not None]
    if least:
        return np.full(begun.shape[1], max(least) / length), free
    if what == "half_angle":
        return np.full(begun.shape[1], -STEEPEST), np.full(begun.shape[1], STEEPEST)
    if what in ("radius", "sweep"):
        sign = np.sign(begun[0])
        least = LEAST_SHARE * np.abs(begun).min(axis=0)
        most = WIDEST_SWEEP if what == "sweep" else LARGEST_RADIUS / length
        return np.where(sign < 0.0, -most, least), np.where(sign < 0.0, -least, most)
    if number.name.startswith("cut") and what in ("skew", "tilt"):
        most = np.full(begun.shape[1], MOST_FLAT_SLOPE if flat else MOST_SLOPE)
        return -most, most
    return -free, free
