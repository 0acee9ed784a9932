"""The nearest points of polylines, and which way a line goes there."""

from __future__ import annotations

import numpy as np

from cadpanel.arrays import Array
from cadpanel.geometry.vectors import norm

# Points and segments looked at together: what is needed on the way stays in the processor's cache.
_TOGETHER = 4096


def line_feet(points: Array, lines: Array) -> tuple[Array, Array]:
    """The points of lines nearest to points, pair by pair.

    Args:
        points: (m, q, 3).
        lines: (m, r, 3); a line may stand still from some point on.

    Returns:
        the feet (m, q, 3), and the unit vectors (m, q, 3) along the line there: zero where a corner of the line is the
        foot, which then does not move with the point.
    """
    each = max(1, _TOGETHER // max(1, points.shape[1] * lines.shape[1]))
    if len(points) <= each:
        return _feet(points, lines)
    found, ways = np.empty_like(points), np.empty_like(points)
    for first in range(0, len(points), each):
        part = slice(first, first + each)
        found[part], ways[part] = _feet(points[part], lines[part])
    return found, ways


def _feet(points: Array, lines: Array) -> tuple[Array, Array]:
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
    return found, np.where(inside[..., None], way / np.where(size > 0.0, size, 1.0)[..., None], 0.0)
