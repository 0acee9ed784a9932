"""How far smooth curves reach that are known by points on them, evenly by their parameter. Millimetres."""

from __future__ import annotations

import numpy as np

from cadpanel.arrays import Array

POINTS = 257
"""Points on each curve: between them a parabola follows a turn of one radian about 1 m to 1e-8 mm."""


def reach(curves: Array, directions: Array) -> tuple[Array, Array]:
    """Least and greatest (d, c) inner product of directions (d, 3) with the points of curves (c, q, 3)."""
    heights = np.einsum("cqx,dx->dcq", curves, directions)
    return _least(heights), -_least(-heights)


def sampled_lengths(curves: Array) -> Array:
    """(c,) lengths of curves (c, q, 3), q odd, by their chords and, so that the error is known, every other point's."""
    fine, coarse = (np.linalg.norm(np.diff(curves[:, ::step], axis=1), axis=-1).sum(axis=-1) for step in (1, 2))
    return np.asarray(fine + (fine - coarse) / 3.0)


def _least(heights: Array) -> Array:
    """Least value of each row, at its points or between three of them, by the parabola through these."""
    if not heights.shape[1]:
        return np.empty(heights.shape[:2])
    middle = np.clip(heights.argmin(axis=-1), 1, heights.shape[-1] - 2)[..., None]
    before, here, after = (np.take_along_axis(heights, middle + step, axis=-1)[..., 0] for step in (-1, 0, 1))
    bend, slope = before - 2.0 * here + after, 0.5 * (after - before)
    inside = np.abs(slope) < bend
    dip = np.where(inside, 0.5 * slope**2 / np.where(inside, bend, 1.0), 0.0)
    return np.asarray(np.minimum(heights.min(axis=-1), here - dip))
