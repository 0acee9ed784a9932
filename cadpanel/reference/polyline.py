"""Lengths, positions and resampling of polylines whose points lie exactly on smooth curves."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# Points of the local cubic that carries values between two points of a curve.
STENCIL = 4


def arc_length(points: Array) -> Array:
    """Return the (q,) lengths from the first point to each of the (q, 3) points along the polyline."""
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    lengths: Array = np.concatenate([[0.0], np.cumsum(steps)])
    return lengths


def interpolate(lengths: Array, values: Array, positions: Array) -> Array:
    """Return the (k, d) values at `positions` on the cubic through the four nearest of the (q, d) `values`.

    The curve between two points is met to the fourth power of their distance, where straight segments would be off by
    the sagitta.

    Args:
        lengths: (q,) rising positions of the values, q >= 4.
        values: (q, d) values there.
        positions: (k,) where to evaluate, within the range of `lengths`.
    """
    first = np.clip(np.searchsorted(lengths, positions, side="right") - 2, 0, len(lengths) - STENCIL)
    stencil = first[:, None] + np.arange(STENCIL)
    knots = lengths[stencil]
    basis = np.ones_like(knots)
    for own in range(STENCIL):
        for other in range(STENCIL):
            if other != own:
                basis[:, own] *= (positions - knots[:, other]) / (knots[:, own] - knots[:, other])
    result: Array = np.einsum("ks,ksd->kd", basis, values[stencil])
    return result


def unit(vectors: Array) -> Array:
    """Return the (..., 3) vectors at length 1; those without length stay zero."""
    sizes = np.linalg.norm(vectors, axis=-1, keepdims=True)
    scaled: Array = vectors / np.where(sizes > 0.0, sizes, 1.0)
    return scaled


def end_tangents(points: Array) -> tuple[Array, Array]:
    """Return the unit tangents (3,) of a curve at its first and last point, from the parabola through three points."""
    return unit(_parabola_slope(points[:3])), unit(-_parabola_slope(points[:-4:-1]))


def _parabola_slope(points: Array) -> Array:
    """Return the slope (3,) at the first of three points of the parabola through them."""
    first, second = points[1] - points[0], points[2] - points[0]
    near, far = np.linalg.norm(first), np.linalg.norm(second)
    slope: Array = first * (far / near) - second * (near / far)
    return slope


def distances_to_polylines(points: Array, polylines: Array) -> Array:
    """Return the (m, q) distances of points to polylines, pair by pair.

    Args:
        points: (m, q, 3), for each pair the points to measure from.
        polylines: (m, k, 3), for each pair the polyline to measure to.
    """
    starts, steps = polylines[:, :-1], np.diff(polylines, axis=1)
    squares = np.einsum("mkd,mkd->mk", steps, steps)
    offsets = points[:, :, None] - starts[:, None]
    along = np.einsum("mqkd,mkd->mqk", offsets, steps) / np.where(squares > 0.0, squares, 1.0)[:, None]
    feet = np.clip(along, 0.0, 1.0)[..., None] * steps[:, None]
    distances: Array = np.linalg.norm(offsets - feet, axis=-1).min(axis=-1)
    return distances
