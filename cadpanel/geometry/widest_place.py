"""Where two curves are widest apart, and where their surfaces' normals lean most: both along whole seams, at once.

How far apart they are has parts. Of the way from a point to the closest point on the other curve, that along the mean
of the two normals is the step, that in the tangent plane and square to the other curve is the width. Where the closest
point is an end of the other curve, what is left lies along the curve, and is no part of either.

Each piece of a curve is cut into a few intervals. What is looked for is known at their ends with its exact derivative,
so that a cubic tells what to expect between; it is taken at its word only as far as it was seen to be right. Intervals
in which the largest value of a seam may still lie are cut again, where the cubic is largest or where the closest point
passes from piece to piece, until none is left.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from typing import NamedTuple

import numpy as np

from cadpanel.arrays import Array, BoolArray, IntArray
from cadpanel.geometry.closest_points import Stations, closest_points, stations
from cadpanel.geometry.conic_chains import ConicChains, followed, followed_twice, inner, joined, seen_from

INTERVALS = 6
"""In each piece to begin with; an even number, as pairs of them are held against each other."""
CLOSE = 1e-5
"""Share of the largest values by which intervals may be doubted and not be looked at again."""
_EXPECTED = 1e-9
"""Share of the largest values by which the cubics may be above them."""
_FLAT = 1e-10
"""Share of a chain's extent, and radians, below which gaps and kinks are not told apart."""
_FADE = 0.125
"""What is left of an interval's doubt in its halves; where the curve is smooth it is 1 / 16."""
_NARROW = 1e-4
"""Share of a piece below which intervals are not cut: the closest point leaps there."""
_MARGIN = 0.02
"""An interval is cut no closer to its ends than this share of it, but for the sake of a piece's end."""
_MET = 1e-5
"""Share of a piece, or of an interval, that is as good as nothing."""
_FACING = 1e-12
"""Least square of the sum of two unit normals: such skins lie back to back, and have no mean normal."""
_KINK = 1
"""The row of the chords between normals among values."""
_LEAP = 4.0
"""A closest point that goes so many times as far as its pace takes it has leaped."""


@dataclass(frozen=True, slots=True)
class Places:
    """Places on curves and what was found there.

    Attributes:
        w: (n,) along the piece.
        values: (4, n) squared distance from the other curve, squared chord between the two unit normals, squared width
            and squared step.
        slopes: (4, n) their derivatives by w.
        column: (n,) of the other curve's piece with the closest point.
        foot: (n,) the closest point, as the number of its piece in the other curve and the share of that piece.
        pace: (n,) its derivative by w; 0 where the closest point stays at the end of the other curve.
    """

    w: Array
    values: Array
    slopes: Array
    column: IntArray
    foot: Array
    pace: Array

    def at(self, index: IntArray | BoolArray) -> Places:
        """Some of the places."""
        return Places(*(getattr(self, of.name)[..., index] for of in fields(self)))

    def beside(self, others: Places) -> Places:
        """These and then the others."""
        both = ((getattr(self, of.name), getattr(others, of.name)) for of in fields(self))
        return Places(*(np.concatenate(pair, axis=-1) for pair in both))


@dataclass(frozen=True, slots=True)
class _Intervals:
    """Intervals of pieces: their columns (n,), both ends, and how far (4, n) a cubic was seen to be off there."""

    column: IntArray
    low: Places
    high: Places
    doubt: Array

    @property
    def width(self) -> Array:
        """(n,) as shares of the pieces."""
        return self.high.w - self.low.w

    def at(self, index: IntArray | BoolArray) -> _Intervals:
        """Some of the intervals."""
        return _Intervals(self.column[index], self.low.at(index), self.high.at(index), self.doubt[:, index])


class Widest(NamedTuple):
    """What s pairs of chains are apart at most.

    Attributes:
        gap: (s,) symmetric Hausdorff distances.
        kink: (s,) largest angles between the normals of a point of either chain and of its closest point, radians.
        width: (s,) largest parts of those distances in the mean tangent plane, square to the curve.
        step: (s,) largest parts along the mean normal.
    """

    gap: Array
    kink: Array
    width: Array
    step: Array


def widest(first: ConicChains, second: ConicChains) -> Widest:
    """What s pairs of chains are apart at most, along all of either of them; lengths in the chains' own unit."""
    on = stations(joined(first, second))
    seams, pieces = first.count, on.chains.pieces
    column, places = _first_places(on)
    largest = places.values.reshape(len(places.values), 2, seams, -1).max(axis=(1, 3))
    flat = _FLAT * np.ptp(on.points.reshape(3, 2, seams, -1), axis=(1, 3)).max(axis=0)
    intervals = _first_intervals(on, column, places)
    while len(intervals.column):
        seam = intervals.column // pieces % seams
        level, doubtful = (_missable(largest, flat, share)[:, seam] for share in (_EXPECTED, CLOSE))
        peak, at = _expected(intervals)
        passing = _passing(intervals)
        may_hold = ((peak > level) | (peak + intervals.doubt > doubtful)).any(axis=0) | (passing > 0.0)
        cut = np.flatnonzero(may_hold & (intervals.width > _NARROW))
        share = np.select(list(peak > level), list(at), 0.5)
        share = np.where(passing > 0.0, passing, np.clip(share, _MARGIN, 1.0 - _MARGIN))
        intervals, values = _halves(on, intervals.at(cut), share[cut])
        for row, found in zip(largest, values, strict=True):
            np.maximum.at(row, seam[cut], found)
    return Widest(*told(largest))


def told(values: Array) -> Array:
    """(4, ...) distances, angles, widths and steps from their squares, the angles' from those of their chords."""
    found = np.sqrt(values)
    found[_KINK] = 2.0 * np.arcsin(np.minimum(0.5 * found[_KINK], 1.0))
    return found


def _missable(values: Array, flat: Array, share: float) -> Array:
    """(4, s) squares that are larger than those found (4, s) by a share that may be missed."""
    found = told(values)
    squares = (found * (1.0 + share) + flat) ** 2
    angles = np.minimum(found[_KINK] * (1.0 + share) + _FLAT, np.pi)
    squares[_KINK] = 4.0 * np.sin(0.5 * angles) ** 2
    return squares


def _first_places(on: Stations) -> tuple[IntArray, Places]:
    """The ends (n,) of all first intervals, piece by piece, and their columns."""
    w = np.linspace(0.0, 1.0, INTERVALS + 1)
    column = np.repeat(np.arange(on.chains.curves.shape[1]), len(w))
    return column, looked_at(on, column, np.tile(w, on.chains.curves.shape[1]))


def _first_intervals(on: Stations, column: IntArray, places: Places) -> _Intervals:
    """All intervals between neighbouring places of a piece; each pair is doubted by what a cubic over both misses."""
    index = np.arange(len(column)).reshape(-1, INTERVALS + 1)
    low, high = index[:, :-1].ravel(), index[:, 1:].ravel()
    left, right, middle = index[:, :-2:2].ravel(), index[:, 2::2].ravel(), index[:, 1::2].ravel()
    pairs = _sided(on, _Intervals(column[left], places.at(left), places.at(right), np.zeros((4, len(left)))))
    missed = np.abs(_cubic(pairs, 0.5) - places.values[:, middle])
    return _sided(on, _Intervals(column[low], places.at(low), places.at(high), np.repeat(_FADE * missed, 2, axis=1)))


def looked_at(on: Stations, column: IntArray, w: Array) -> Places:
    """What is found at w (n,) of the pieces in the columns (n,)."""
    chain = column // on.chains.pieces
    other = (chain + on.chains.count // 2) % on.chains.count
    points = followed(np.take(on.chains.curves, column, axis=1), w)
    there, share, _ = closest_points(on, other, points)
    return _compared(on.chains, column, w, there, share)


def _compared(chains: ConicChains, column: IntArray, w: Array, there: IntArray, share: Array) -> Places:
    """Places at w (n,) of the pieces in the columns (n,), whose closest points are known: there, at the shares."""
    points, along, _ = followed_twice(np.take(chains.curves, column, axis=1), w)
    away, across, bend = followed_twice(seen_from(np.take(chains.curves, there, axis=1), points), share)
    square, slant = inner(across, across), inner(away, across)
    curved = square + inner(away, bend)
    # Where the way to the closest point is not square to the curve, the closest point is held by the curve's end.
    moves = np.abs(slant) < _MET * curved
    pace = np.where(moves, inner(along, across) / np.where(moves, curved, 1.0), 0.0)
    # Else what is left of it along the curve is rounding, which must not be told as a slope where there is no gap.
    straight = away - np.where(moves, slant / np.where(moves, square, 1.0), 0.0) * across
    normals, turning = chains.normals_at(column, w)
    facing, turning_there = chains.normals_at(there, share)
    apart, turned = normals - facing, turning_there * pace
    # What lies along the other curve is no part of width and step; its closest point stays where there is any.
    beside = np.where(moves, 0.0, slant / np.where(square > 0.0, square, 1.0))
    square_on = straight - beside * across
    rate = np.where(moves, pace, inner(along, across) / np.where(square > 0.0, square, 1.0)) * across - along
    # The step is the inner product with m / |m| of the sum m of the two normals.
    mean, mean_rate = normals + facing, turning + turned
    size = np.maximum(inner(mean, mean), _FACING)
    step = inner(square_on, mean) / np.sqrt(size)
    step_rate = (inner(rate, mean) + inner(square_on, mean_rate)) / np.sqrt(size) - step * inner(mean, mean_rate) / size
    stepping = step * step_rate
    return Places(
        w=w,
        values=np.stack(
            [
                inner(away, away),
                inner(apart, apart),
                np.maximum(inner(square_on, square_on) - step**2, 0.0),
                step**2,
            ]
        ),
        slopes=2.0
        * np.stack(
            [
                -inner(straight, along),
                inner(apart, turning - turned),
                inner(square_on, rate) - stepping,
                stepping,
            ]
        ),
        column=there,
        foot=there % chains.pieces + share,
        pace=pace,
    )


def _sided(on: Stations, of: _Intervals) -> _Intervals:
    """The same intervals, with slopes that hold inside them.

    A closest point between two pieces counts as of the one into which it goes inside the interval.
    """
    travel = of.high.foot - of.low.foot
    return _Intervals(
        of.column, _on_side(on, of.column, of.low, travel), _on_side(on, of.column, of.high, -travel), of.doubt
    )


def _on_side(on: Stations, column: IntArray, places: Places, travel: Array) -> Places:
    """Places with their closest points on the pieces into which they travel (n,)."""
    border = np.rint(places.foot)
    first = places.column - places.column % on.chains.pieces
    piece = first + border.astype(np.intp) - (travel < 0.0)
    wrong = (np.abs(places.foot - border) < _MET) & (np.abs(travel) > _MET) & (piece != places.column)
    wrong &= on.joins[first + border.astype(np.intp)]  # nothing joins at the ends of a chain
    if not wrong.any():
        return places
    turned = np.flatnonzero(wrong)
    right = _compared(
        on.chains, column[turned], places.w[turned], piece[turned], np.where(travel[turned] < 0.0, 1.0, 0.0)
    )
    slopes, pace = places.slopes.copy(), places.pace.copy()
    slopes[:, turned], pace[turned] = right.slopes, right.pace
    return replace(places, slopes=slopes, pace=pace)


def _cubic(of: _Intervals, t: Array | float) -> Array:
    """(4, n) the cubics with the values and slopes at both ends, at the shares t of the intervals."""
    start, b, c, d = _powers(of)
    values: Array = start + t * (b + t * (c + t * d))
    return values


def _powers(of: _Intervals) -> tuple[Array, Array, Array, Array]:
    rise = of.high.values - of.low.values
    begin, end = of.width * of.low.slopes, of.width * of.high.slopes
    return of.low.values, begin, 3.0 * rise - 2.0 * begin - end, begin + end - 2.0 * rise


def _expected(of: _Intervals) -> tuple[Array, Array]:
    """(4, n) the largest values to expect, and at which shares of the intervals; 1/2 where at an end.

    They are those of the cubics. Where the closest point leaps, the distance rises as from the low end until it falls
    as towards the high end, and all else may be what either end leads to.
    """
    start, b, c, d = _powers(of)
    root = np.sqrt(np.maximum(c**2 - 3.0 * b * d, 0.0))
    inside = (b > 0.0) & (b < root - c)
    t = np.where(inside, b / np.where(inside, root - c, 1.0), 0.5)
    peak = np.maximum(start, of.high.values)
    peak = np.where(inside, np.maximum(peak, start + t * (b + t * (c + t * d))), peak)
    leaps = np.flatnonzero(_leaps(of))
    if len(leaps):
        rise, fall = b[:, leaps], -of.width[leaps] * of.high.slopes[:, leaps]
        low, high = start[:, leaps], of.high.values[:, leaps]
        meeting = (high[0] + fall[0] - low[0]) / np.where(rise[0] + fall[0] > 0.0, rise[0] + fall[0], np.inf)
        ridge = (rise[0] > 0.0) & (fall[0] > 0.0) & (meeting > 0.0) & (meeting < 1.0)
        t[0, leaps] = np.where(ridge, meeting, t[0, leaps])
        peak[0, leaps] = np.maximum(peak[0, leaps], np.where(ridge, low[0] + meeting * rise[0], 0.0))
        t[1:, leaps] = 0.5
        peak[1:, leaps] = np.maximum(peak[1:, leaps], np.maximum(low[1:] + rise[1:], high[1:] + fall[1:]))
    return peak, t


def _leaps(of: _Intervals) -> BoolArray:
    """(n,) whether the closest point leaps in the intervals, as it is too far gone for its pace."""
    paces = np.maximum(np.abs(of.low.pace), np.abs(of.high.pace))
    leaps: BoolArray = np.abs(of.high.foot - of.low.foot) > _LEAP * paces * of.width + _MET
    return leaps


def _passing(of: _Intervals) -> Array:
    """(n,) shares of the intervals where the closest point passes from one piece to the next, or comes to the end.

    The cubics do not hold there. 0 where the closest point does not, or leaps, or does so at the interval's own end.
    """
    ahead, behind = of.low.foot, of.high.foot
    onward = behind > ahead
    border = np.where(onward, np.floor(ahead + _MET) + 1.0, np.ceil(ahead - _MET) - 1.0)
    travel = np.abs(behind - ahead)
    passed = (np.abs(border - ahead) <= travel) & (travel > _MET)
    # Over wide intervals from long pieces to short ones and back what looks like a leap need not be one.
    passed &= ~_leaps(of) | (of.width > 0.4 / INTERVALS)
    # From whichever end is nearer, as far as the closest point still has to go.
    paces = of.width * np.stack([of.low.pace, of.high.pace])
    from_low = (paces[1] == 0.0) | (np.abs(border - ahead) <= np.abs(border - behind))
    pace = np.where(from_low, paces[0], paces[1])
    share = np.where(from_low, 0.0, 1.0) + (border - np.where(from_low, ahead, behind)) / np.where(pace, pace, np.inf)
    share = np.where((share < -_MET) | (share > 1.0 + _MET) | (pace == 0.0), 0.5, share)
    return np.where(passed & (share > _MET) & (share < 1.0 - _MET), share, 0.0)


def _halves(on: Stations, of: _Intervals, share: Array) -> tuple[_Intervals, Array]:
    """Both parts of every interval, cut at shares (n,) of them, and the values (4, n) there."""
    cut = looked_at(on, of.column, of.low.w + share * of.width)
    doubt = _FADE * np.maximum(np.abs(_cubic(of, share) - cut.values), _FADE * of.doubt)
    parts = _Intervals(
        np.concatenate([of.column, of.column]),
        of.low.beside(cut),
        cut.beside(of.high),
        np.concatenate([doubt, doubt], axis=1),
    )
    return _sided(on, parts), cut.values
