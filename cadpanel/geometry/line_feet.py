"""The nearest points of polylines, and which way a line goes there."""

from __future__ import annotations

import numpy as np

from cadpanel.arrays import Array
from cadpanel.geometry.vectors import norm


def line_feet(points: Array, lines: Array) -> tuple[Array, Array]:
    """The points of lines nearest to points, pair by pair.

    Args:
        points: (m, q, 3).
        lines: (m, r, 3); a line may stand still from some point on.

    Returns:
        the feet (m, q, 3), and the unit vectors (m, q, 3) along the line there: zero where a corner of the line is the
        foot, which then does not move with the point.
    """
    start, step = lines[:, None, :-1], (lines[:, 1:] - lines[:, :-1])[:, None]
    square = np.einsum("mqrx,mqrx->mqr", step, step)
    away = points[:, :, None] - start
    share = np.einsum("mqrx,mqrx->mqr", away, np.broadcast_to(step, away.shape)) / np.where(square > 0.0, square, 1.0)
    kept = np.clip(share, 0.0, 1.0)
    off = away - kept[..., None] * step
    nearest = np.einsum("mqrx,mqrx->mqr", off, off).argmin(axis=2)
    row, column = np.indices(nearest.shape)
    found = points - off[row, column, nearest]
    way = np.broadcast_to(step, away.shape)[row, column, nearest]
    inside = kept[row, column, nearest] == share[row, column, nearest]
    size = norm(way)
    return found, np.where((inside & (size > 0.0))[..., None], way / np.where(size > 0.0, size, 1.0)[..., None], 0.0)
