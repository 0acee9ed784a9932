"""Which direction, axis or place comes first, so that rounding does not tell.

Symmetric panels are full of ties: rows as long as columns, strips at 45 degrees to the axes, rings without a first
panel. Another processor adds in another order and breaks such a tie the other way. So what is alike counts as equal
here, and a rule of space decides.
"""

from __future__ import annotations

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.geometry.vectors import norm

# Lengths that differ by less than this part are alike: by rounding, or by what drawing leaves of symmetry.
EQUAL = 1e-4


def goes_backwards(way: Array, least: float = 0.0) -> bool:
    """Whether a (3,) direction goes against the axis of space that it follows most, by more than a length.

    Of axes that it follows alike, the first one counts.
    """
    return bool(way[_first_largest(np.abs(way))] < -least)


def first_way(ways: Array) -> int:
    """Which of (k, 3) directions follows the first axis of space most; of those alike, the second one, then the third.

    Either way counts alike. Where that tells nothing, it is the one that goes farthest along the first axis, then the
    second, then the third, once all are turned to go forwards.
    """
    forwards = np.array([-way if goes_backwards(way) else way for way in ways / norm(ways)[:, None]])
    left = np.arange(len(ways))
    for sizes in (*np.abs(forwards).T, *forwards.T):
        left = left[sizes[left] >= sizes[left].max() - EQUAL]
    return int(left[0])


def principal_axes(points: Array) -> Array:
    """(3, 3) the directions in which (n, 3) points extend most, next and least, each along the axis it follows most.

    Directions in which they extend alike are those nearest to the axes of space.
    """
    _, found, rows = np.linalg.svd(points - points.mean(axis=0), full_matrices=True)
    sizes = np.zeros(3)
    sizes[: len(found)] = np.where(found > EQUAL * found.max(initial=0.0), found, 0.0)
    axes: list[Array] = []
    while len(axes) < 3:
        first = len(axes)
        alike = rows[first:][sizes[first:] >= (1.0 - EQUAL) * sizes[first]]
        for _ in range(len(alike)):
            beside = np.array(axes[first:]).reshape(-1, 3)
            within = alike - alike @ beside.T @ beside
            nearest = within.T @ within
            axis = nearest[_first_largest(np.diag(nearest))]
            axes.append(axis / norm(axis))
    return np.array(axes)


def levels(values: Array, tolerance: float) -> IntArray:
    """(n,) the rank of values, in which those that follow each other within a tolerance share one.

    Rounding would part two that lie on either side of a half.
    """
    order = np.argsort(values, kind="stable")
    steps = np.concatenate([[0], np.cumsum(np.diff(values[order]) > tolerance)])
    levels = np.empty(len(values), dtype=np.intp)
    levels[order] = steps
    return levels


def order_in_space(points: Array, tolerance: float) -> IntArray:
    """The numbers of (n, 3) points by the first coordinate, then the second, then the third, each to a tolerance."""
    return np.asarray(np.lexsort([levels(points[:, axis], tolerance) for axis in (2, 1, 0)]), dtype=np.intp)


def _first_largest(sizes: Array) -> int:
    """The first of sizes that are alike the largest one."""
    return int((sizes >= (1.0 - EQUAL) * sizes.max()).argmax())
