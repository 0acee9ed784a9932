"""Where along an end one patch of a chain gives way to the next, told by how the normals turn.

Walking along an end from side 0 to side 1, the normals stand still on planes and turn evenly on cones and cylinders.
The places of change are those for which this fits best: least squares over all ways to cut the walk into the chain's
patches, found exactly by dynamic programming (R. Bellman, Communications of the ACM 4, 1961, p. 284), for all panels at
once.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from cadpanel.arrays import Array, BoolArray, IntArray

# No patch is shorter than so many steps, unless there are too many patches for that.
SHORTEST = 2
# What turns away from the places around it, the middle one of so many, by more than this angle (radians) and back again
# is a blemish of the drawn surface: no fold turns to and fro.
_AROUND = 17
_BLEMISH = np.radians(30.0)

# Walks that are cut at a time.
_CHUNK = 16


@dataclass(frozen=True, slots=True)
class Profile:
    """How walks are cut into patches.

    Attributes:
        knots: (n, k + 1) steps at which patches begin and end; the first is 0.
        angles: (n, k + 1) angles of the normals there, the same on both sides of a plane, radians.
    """

    knots: IntArray
    angles: Array


def cut_profile(
    turned: Array,
    curved: Sequence[bool],
    *,
    even: bool = False,
    held: Array | None = None,
    best: IntArray | None = None,
) -> Profile:
    """Cut walks into patches.

    Args:
        turned: (n, q) angle by which the normals have turned at q evenly spaced places, radians.
        curved: for each patch whether it turns.
        even: give curved patches that follow each other equal parts of their stretch, instead of the best.
        held: (n, 2) steps, with fractions, at which the only stretch of curved patches is to begin and end; nan where
            it is to be found.
        best: (n, k + 1) what `best_knots` found for these walks, where that is known already.
    """
    knots = best_knots(turned, curved) if best is None else best.copy()
    if even:
        _even_out(knots, curved)
    if held is not None and not np.all(np.isnan(held)):
        _hold(knots, curved, held)
    return Profile(knots, _angles(turned, knots, curved))


def best_knots(turned: Array, curved: Sequence[bool]) -> IntArray:
    """(n, k + 1) the steps at which patches begin and end that fit walks (n, q) best."""
    # A few walks at a time: all places against all others stay in the processor's cache.
    parts = [_best_knots(turned[i : i + _CHUNK], curved) for i in range(0, len(turned), _CHUNK)]
    return np.concatenate(parts) if parts else np.empty((0, len(curved) + 1), dtype=np.intp)


def without_blemishes(turned: Array) -> Array:
    """Walks (n, q) without narrow hooks, as faces have them beside a crease that their modeller did not fair.

    Where the angle lies far off the median of the places around, that is put in its place. A walk that turns one way
    only is its own median, so that folds stay as they are, however sharp.

    Args:
        turned: angles by which the normals have turned, radians, of features that turn one way.
    """
    half = _AROUND // 2
    around = sliding_window_view(np.pad(turned, ((0, 0), (half, half)), mode="edge"), _AROUND, axis=1)
    median = np.median(around, axis=2)
    return np.where(np.abs(turned - median) > _BLEMISH, median, turned)


def _best_knots(turned: Array, curved: Sequence[bool]) -> IntArray:
    """(n, k + 1) the steps at which patches that cost least begin and end."""
    count, places = turned.shape
    last = places - 1
    least = max(1, min(SHORTEST, last // len(curved)))
    costs = {kind: _costs(turned, kind, least) for kind in set(curved)}
    best = np.full((count, places), np.inf)
    best[:, 0] = 0.0
    origins = []
    for kind in curved:
        # From which place j the patch that ends in k begins: cost of all before j, and of j to k as one patch.
        whole = best[:, :, None] + costs[kind]
        origin = np.argmin(whole, axis=1)
        best = np.take_along_axis(whole, origin[:, None], axis=1)[:, 0]
        origins.append(origin)
    knots = np.empty((count, len(curved) + 1), dtype=np.intp)
    knots[:, -1] = last
    rows = np.arange(count)
    for patch in range(len(curved) - 1, -1, -1):
        knots[:, patch] = origins[patch][rows, knots[:, patch + 1]]
    return knots


def _even_out(knots: IntArray, curved: Sequence[bool]) -> None:
    """Spread the knots between curved patches that follow each other evenly over their stretch."""
    for start, stop in curved_runs(curved):
        first, last = knots[:, start].copy(), knots[:, stop].copy()
        for knot in range(start + 1, stop):
            knots[:, knot] = np.round(first + (last - first) * (knot - start) / (stop - start))


def _hold(knots: IntArray, curved: Sequence[bool], held: Array) -> None:
    """Lay the stretch of curved patches between given steps, its patches evenly, and leave every patch a step."""
    ((start, stop),) = curved_runs(curved)
    rows = np.flatnonzero(~np.isnan(held).any(axis=1))
    last, patches = knots[0, -1], len(curved)
    begin = np.clip(np.round(held[rows, 0]), start, last - (patches - start))
    end = np.clip(np.round(held[rows, 1]), begin + stop - start, last - (patches - stop))
    for knot in range(start, stop + 1):
        knots[rows, knot] = np.round(begin + (end - begin) * (knot - start) / (stop - start))


def curved_runs(curved: Sequence[bool]) -> list[tuple[int, int]]:
    """First patch of, and first patch after, every stretch of curved patches that follow each other."""
    runs, start = [], None
    for patch, kind in enumerate((*curved, False)):
        if kind and start is None:
            start = patch
        elif not kind and start is not None:
            runs.append((start, patch))
            start = None
    return runs


def ambiguous(curved: Sequence[bool]) -> bool:
    """Whether curved patches follow each other, such that normals tell only roughly where they part."""
    return any(stop - start > 1 for start, stop in curved_runs(curved))


def _costs(turned: Array, curved: bool, least: int) -> Array:
    """(n, q, q) sums of squares about the mean or the best line of the places j to k; infinite where too short."""
    of = _stretches(turned.shape[1], least)
    sy = _sums(turned)
    cost = _sums(turned**2) - sy**2 / of.number
    if curved:
        cost -= (_sums(of.x * turned) - of.mean * sy) ** 2 / of.spread
    return np.where(of.allowed, np.maximum(cost, 0.0), np.inf)


@dataclass(frozen=True, slots=True)
class _Stretches:
    """What all walks of q places have in common, (1, q, q) of the places j to k.

    Attributes:
        x: (q,) where the places are.
        allowed: whether a patch may be so short.
        number: how many places, 1 where it may not.
        mean: of x.
        spread: sum of squares of x about its mean, 1 where a patch may not be so short.
    """

    x: Array
    allowed: BoolArray
    number: Array
    mean: Array
    spread: Array


@lru_cache
def _stretches(places: int, least: int) -> _Stretches:
    x, one = np.linspace(-1.0, 1.0, places), np.ones((1, places))
    allowed = (np.arange(places)[None, :] - np.arange(places)[:, None] >= least)[None]
    number, sx = np.where(allowed, _sums(one), 1.0), _sums(x[None])
    spread = np.where(allowed, _sums(x[None] ** 2) - sx**2 / number, 1.0)
    return _Stretches(x, allowed, number, sx / number, spread)


def _sums(values: Array) -> Array:
    """(n, q, q) sums of values (n, q) from the place j to k."""
    total = np.zeros((len(values), values.shape[1] + 1))
    np.cumsum(values, axis=1, out=total[:, 1:])
    return np.asarray(total[:, None, 1:] - total[:, :-1, None])


def _angles(turned: Array, knots: IntArray, curved: Sequence[bool]) -> Array:
    """(n, k + 1) the angle at each knot: the mean of a plane that it bounds, else the mean of the two lines' ends."""
    count, places = turned.shape
    place = np.arange(places)
    low, high = np.zeros((count, len(curved))), np.zeros((count, len(curved)))
    for patch, kind in enumerate(curved):
        inside = (place >= knots[:, patch, None]) & (place <= knots[:, patch + 1, None])
        number = inside.sum(axis=1)
        mean = np.sum(turned * inside, axis=1) / number
        low[:, patch] = high[:, patch] = mean
        if kind:
            middle = np.sum(place * inside, axis=1) / number
            off = (place - middle[:, None]) * inside
            slope = np.sum(off * turned, axis=1) / np.maximum(np.sum(off**2, axis=1), np.finfo(float).tiny)
            low[:, patch] += slope * (knots[:, patch] - middle)
            high[:, patch] += slope * (knots[:, patch + 1] - middle)
    angles = np.empty((count, len(curved) + 1))
    angles[:, 0], angles[:, -1] = low[:, 0], high[:, -1]
    for knot in range(1, len(curved)):
        before, after = high[:, knot - 1], low[:, knot]
        if curved[knot - 1] == curved[knot]:
            angles[:, knot] = 0.5 * (before + after)
        else:
            angles[:, knot] = after if curved[knot - 1] else before
    return angles
