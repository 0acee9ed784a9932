"""Stretches that cross themselves, parted in every loop: the kernel never looks for where an edge crosses itself.

Where they turn back along themselves they are drawn straight on.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np

from cadpanel.arrays import Array, BoolArray, IntArray
from cadpanel.brep.curves.folds import kept_unfolded
from cadpanel.brep.curves.pcurve_fit import SAME, Stretch
from cadpanel.brep.faces.face_patch import Patch
from cadpanel.geometry.polyline import arc_length
from cadpanel.geometry.vectors import norm, side_of

# Segments in a row that share a box, by which those far from each other are told apart; and pairs of such rows whose
# segments are compared at once.
ROW = 32
ROWS_AT_ONCE = 128
# Ends of an edge this close to each other are one vertex for the kernel, mm; half of its own value.
ONE_POINT = 0.5e-7


def uncrossed(patch: Patch, stretch: Stretch, tolerance: float) -> list[Stretch]:
    """Parts of a stretch, end to end, none of which crosses, touches or follows itself; mostly the stretch alone.

    Args:
        patch: over which it lies.
        stretch: which; where it is closed, its ends may stay one, and where they are not quite one it is halved.
        tolerance: one that ends this close to itself touches itself, mm.
    """
    if _goes_one_way(stretch.line):
        return [stretch]
    kept = kept_unfolded(patch, stretch.line)
    stretch = replace(stretch, places=stretch.places[kept], line=stretch.line[kept])
    line = stretch.line
    if _goes_one_way(line):
        return [stretch]
    reached = arc_length(patch.points(line))
    pairs = crossings(_drawn_on(line, reached, tolerance))
    at_ends = (reached[pairs[:, 0]] <= tolerance) & (reached[-1] - reached[pairs[:, 1] + 1] <= tolerance)
    follows = reached[pairs[:, 1]] - reached[pairs[:, 0] + 1] <= SAME * reached[-1]
    gap = norm(np.diff(patch.points(line[[0, -1]]), axis=0))[0]
    closed = gap <= tolerance
    cuts = _cuts(pairs[~(follows | (at_ends & closed))])
    if closed and gap > ONE_POINT and not cuts:
        # The kernel joins the ends of two edges within its tolerance, but not both ends of one.
        cuts = [int(np.searchsorted(reached, 0.5 * reached[-1]))]
    ends = [0, *cuts, len(line) - 1]
    return [
        replace(stretch, places=stretch.places[first : last + 1], line=line[first : last + 1])
        for first, last in pairwise(ends)
    ]


def _goes_one_way(line: Array) -> bool:
    return bool((np.diff(line, axis=0) @ (line[-1] - line[0]) > 0.0).all())


def _drawn_on(line: Array, reached: Array, length: float) -> Array:
    """A line (k, 2) of parameters, its ends drawn on by a length, where (k,) lengths are reached along it, mm."""
    longer = line.copy()
    for end, beside in ((0, int(np.argmax(reached > 0.0))), (-1, int(np.argmax(reached == reached[-1])) - 1)):
        longer[end] += (line[end] - line[beside]) * length / abs(reached[end] - reached[beside])
    return longer


def crossings(line: Array) -> IntArray:
    """Pairs of segments of a line in the plane that meet without following each other.

    Args:
        line: (k, 2) points.

    Returns:
        (p, 2) numbers of segments, the lesser one first.
    """
    count = len(line) - 1
    starts = np.arange(0, count, ROW)
    rows = np.minimum(starts[:, None] + np.arange(ROW), count - 1)
    # Each row with the point after it.
    points = line[np.concatenate([rows, rows[:, -1:] + 1], axis=1)]
    low, high = points.min(axis=1), points.max(axis=1)
    near = np.array(
        [
            (row, other)
            for row in range(len(rows))
            for other in row + np.flatnonzero(((low[row:] <= high[row]) & (high[row:] >= low[row])).all(axis=1))
        ]
    )
    found = [
        np.stack([rows[pairs[:, 0]][hits[:, 0], hits[:, 1]], rows[pairs[:, 1]][hits[:, 0], hits[:, 2]]], axis=1)
        for pairs in np.split(near, range(ROWS_AT_ONCE, len(near), ROWS_AT_ONCE))
        for hits in [np.argwhere(_meet(line, rows[pairs[:, 0], :, None], rows[pairs[:, 1], None, :]))]
    ]
    pairs = np.unique(np.concatenate(found), axis=0)
    return np.asarray(pairs[pairs[:, 1] - pairs[:, 0] > 1], dtype=np.intp)


def _meet(line: Array, first: IntArray, second: IntArray) -> BoolArray:
    """Whether segments of a line meet, by the numbers of those (..., k) compared."""
    a, b, c, d = line[first], line[first + 1], line[second], line[second + 1]
    apart = (np.maximum(a, b) < np.minimum(c, d)) | (np.maximum(c, d) < np.minimum(a, b))
    crossed = (side_of(a, b, c) * side_of(a, b, d) <= 0.0) & (side_of(c, d, a) * side_of(c, d, b) <= 0.0)
    return np.asarray(crossed & ~apart.any(axis=-1), dtype=np.bool_)


def _cuts(pairs: IntArray) -> list[int]:
    """The fewest points at which to part a line so that no part has both segments of a pair, each amid its loops."""
    cuts: list[int] = []
    first, last = 0, -1
    for before, after in pairs[np.argsort(pairs[:, 1], kind="stable")].tolist():
        if last >= 0 and before + 1 <= last:
            first = max(first, before + 1)
            continue
        if last >= 0:
            cuts.append((first + last) // 2)
        first, last = before + 1, after
    return [*cuts, (first + last) // 2] if last >= 0 else cuts
