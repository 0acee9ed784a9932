"""Which patch of a chain lies under a point."""

from __future__ import annotations

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.geometry.cone import beyond


def patch_under(x: Array, middle: tuple[Array, Array], rulings: tuple[Array, Array], anchor: int) -> IntArray:
    """(panels, m) the patch of each point x (3, panels, m).

    A point belongs to the patch between whose bounding rulings its foot point falls. Walks outwards from the ruling in
    the middle of the anchor patch: a point that is beyond one ruling may be beyond the next. Asking in this order keeps
    folds of up to half a turn apart, whose far flange lies behind the near ruling's plane.

    Args:
        x: the points.
        middle: points and binormals (panels, 3) of the rulings in the middle of the anchor patch.
        rulings: points and binormals (panels, k + 1, 3) of the rulings that bound the k patches.
        anchor: index of the anchor patch.
    """
    p, b = rulings
    right = beyond(x, *middle)
    patch = np.full(right.shape, anchor, dtype=np.intp)
    passed = right
    for i in range(anchor + 1, p.shape[1] - 1):
        passed = passed & beyond(x, p[:, i], b[:, i])
        patch += passed
    passed = ~right
    for i in range(anchor, 0, -1):
        passed = passed & ~beyond(x, p[:, i], b[:, i])
        patch -= passed
    return patch
