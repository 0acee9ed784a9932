"""Bounds that keep panels makeable while they are fitted: no fold turns inside out, no patch shrinks to nothing.

What a feature's author has bounded keeps the author's bounds. Signs are those of the start: a radius cannot pass
through infinity on its way from a convex patch to a concave one.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import numpy as np

from cadpanel.arrays import Array
from cadpanel.features.layout import Layout
from cadpanel.features.patches import DIMENSIONS, Kind, Patch
from cadpanel.features.rulings import PanelFeature
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
        feature = group.feature
        low, high = _natural(feature, [_expanded(feature, start[group.panels]) for start in starts], length)
        for column, index in enumerate(feature.free):
            number = feature.numbers[index]
            least, most = low[:, index], high[:, index]
            lower[group.panels, column] = number.lower if np.isfinite(number.lower) else np.minimum(least, number.upper)
            upper[group.panels, column] = number.upper if np.isfinite(number.upper) else np.maximum(most, number.lower)
    return lower, upper


def _expanded(feature: PanelFeature, unknowns: Array) -> Array:
    return feature.expand(unknowns[:, : len(feature.free)])


def _natural(feature: PanelFeature, begun: Sequence[Array], length: float) -> tuple[Array, Array]:
    """(n, numbers) bounds of all numbers of n panels, from arrays (n, numbers) that they start with."""
    upper = np.full(begun[0].shape, np.inf)
    lower = -upper
    for i, patch in enumerate(feature.patches):
        own = feature.patch_slice(i)
        if own.start < own.stop:
            dimensions = np.array([patch.dimensions(start[:, own]).values for start in begun])
            lower[:, own], upper[:, own] = _told(patch, *_of_dimensions(patch.kind, dimensions, length))
    slopes = feature.cut_numbers[:, 1:].reshape(-1)
    upper[:, slopes] = MOST_SLOPE if any(feature.curved) else MOST_FLAT_SLOPE
    lower[:, slopes] = -upper[:, slopes]
    return lower, upper


def _of_dimensions(kind: Kind, begun: Array, length: float) -> tuple[Array, Array]:
    """(n, d) bounds of what patches measure, from what they start with (starts, n, d)."""
    upper = np.full(begun.shape[1:], np.inf)
    lower = -upper
    for column, what in enumerate(DIMENSIONS[kind]):
        least = [bound for limit in LIMITS if (bound := limit.bound(what)) is not None]
        if least:
            lower[:, column] = max(least) / length
        if what == "half_angle":
            lower[:, column], upper[:, column] = -STEEPEST, STEEPEST
        if what in ("radius", "sweep"):
            concave = begun[0, :, column] < 0.0
            smallest = LEAST_SHARE * np.abs(begun[:, :, column]).min(axis=0)
            most = WIDEST_SWEEP if what == "sweep" else LARGEST_RADIUS / length
            lower[:, column] = np.where(concave, -most, smallest)
            upper[:, column] = np.where(concave, -smallest, most)
    return lower, upper


def _told(patch: Patch, lower: Array, upper: Array) -> tuple[Array, Array]:
    """(n, numbers) the least and greatest numbers of patches at the corners of a box of dimensions (n, d).

    Where each number tells of one dimension, that is the box itself; where one tells of several, a box about it.
    """
    sides = np.stack([lower, upper])
    columns = np.arange(lower.shape[1])
    with np.errstate(all="ignore"):
        corners = np.array(
            [patch.numbers_for(sides[which, :, columns].T) for which in itertools.product((0, 1), repeat=len(columns))]
        )
    unknown = np.isnan(corners)
    return np.where(unknown, -np.inf, corners).min(axis=0), np.where(unknown, np.inf, corners).max(axis=0)
