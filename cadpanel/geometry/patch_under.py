"""Which patch of a chain lies under a point."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array, BoolArray, IntArray
from cadpanel.geometry.cone import beyond
from cadpanel.geometry.frames import rotate_about
from cadpanel.geometry.vectors import cross, dot

# Patches that do not turn at all count this much, radians: where none does, any of them may be the middle.
_NO_TURN = 1e-12


@dataclass(frozen=True, slots=True)
class HalfWay:
    """The rulings at which n panels have turned half of their way.

    Attributes:
        p: (n, 3) a point on each.
        b: (n, 3) its binormal.
        patch: (n,) the patch that it lies on.
    """

    p: Array
    b: Array
    patch: IntArray


def half_way(rulings: tuple[Array, Array, Array], numbers: tuple[Array, Array, Array]) -> HalfWay:
    """The rulings at which panels have turned half of their way, whichever way each patch turns.

    Args:
        rulings: points, directions and normals (n, k, 3) of the rulings that the k patches begin with, or more.
        numbers: radii, half angles and sweeps (n, k); 0 for planes. Some patch is curved.
    """
    radius, half_angle, sweep = numbers
    turned = np.cumsum(np.where(radius != 0.0, np.abs(sweep) + _NO_TURN, 0.0), axis=1)
    half = 0.5 * turned[:, -1:]
    patch = (turned >= half).argmax(axis=1)
    rows = np.arange(len(turned))
    before = np.where(patch > 0, turned[rows, patch - 1], 0.0)
    share = (half[:, 0] - before) / (turned[rows, patch] - before)
    p, t, n = (axis[rows, patch] for axis in rulings)
    own, narrow = radius[rows, patch, None], half_angle[rows, patch, None]
    axis = np.cos(narrow) * t - np.sin(narrow) * n
    turn = share * sweep[rows, patch]
    turned_t, turned_n = rotate_about(axis, turn, np.array([t, n]))
    return HalfWay(p + own * (turned_n - n), cross(turned_t, turned_n), patch)


def patch_under(x: Array, middle: HalfWay, rulings: tuple[Array, Array]) -> IntArray:
    """(panels, m) the patch of each point x (3, panels, m).

    A point belongs to the patch between whose bounding rulings its foot point falls. Walks outwards from the ruling at
    which the panel has turned half of its way: a point that is beyond one ruling may be beyond the next. Asking in this
    order keeps folds of up to half a turn apart, whose far flange lies behind the near ruling's plane. From any other
    ruling, one in the middle of the first of two cones say, a point on a flange further than a quarter turn away would
    change sides, and its distance leap.

    Args:
        x: the points.
        middle: where the walk begins.
        rulings: points and binormals (panels, k + 1, 3) of the rulings that bound the k patches.
    """
    (p, b), right = rulings, beyond(x, middle.p, middle.b)
    # Of each inner ruling whether points are past it.
    inner = b[:, 1:-1]
    past = inner @ x.swapaxes(0, 1) > dot(p[:, 1:-1], inner)[..., None]
    return outwards(right, past, middle.patch)


def outwards(right: BoolArray, past: BoolArray, begin: IntArray, count: IntArray | None = None) -> IntArray:
    """(n, m) the patch of each point, walking outwards from the middle as long as it is past the next ruling.

    Args:
        right: (n, m) on which side of the middle points lie.
        past: (n, k - 1, m) whether they are past the rulings between the k patches.
        begin: (n,) the patch that the middle lies on.
        count: (n,) number of patches, k if not given.
    """
    first, most, rulings = int(begin.min()), int(begin.max()), past.shape[1]
    patch, begin = np.zeros(right.shape, dtype=np.intp) + begin[:, None], begin[:, None]
    passed = right
    for i in range(first + 1, rulings + 1):
        if i > most and count is None:
            passed = passed & past[:, i - 1]
            patch += passed
        else:
            asked = i > begin if count is None else (i > begin) & (i < count[:, None])
            passed = passed & (past[:, i - 1] | ~asked)
            patch += passed & asked
    passed = ~right
    for i in range(most, 0, -1):
        if i <= first:
            passed = passed & ~past[:, i - 1]
            patch -= passed
        else:
            asked = i <= begin
            passed = passed & ~(past[:, i - 1] & asked)
            patch -= passed & asked
    return patch
