"""A pairing moved onto det(a', b', b - a) = 0, or as near to it as the rails allow.

A ruling between the shares a and b is told by its middle c = (a + b) / 2 and its lead d = (a - b) / 2. Both shares rise
along the surface as long as |d'(c)| < 1. First the leads of some hundred rulings are moved together, by damped
Gauss-Newton steps on their warp; on what |d'(c)| exceeds nine tenths by; and, very softly, on the bend of d(c), which
parts of the rails that lie in a plane leave free. Then every ruling by itself is moved by Newton's method with exact
derivatives.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import make_interp_spline
from scipy.linalg import solveh_banded

from cadpanel.arrays import Array, BoolArray, IntArray
from cadpanel.lofting.rail import Rail
from cadpanel.lofting.warp import Signed, signed_warp

STATIONS = 129
"""Rulings that are moved together."""
EXACT = 1e-9
"""A ruling whose warp has a smaller sine has one tangent plane."""
SLIVER = 1e-5
"""A fan over a smaller share of a rail is not made."""
# Weight of the square of d''(c), and of the pull of damping at first and at most.
_BEND = 1e-6
_DAMPING, _MOST_DAMPING = 1e-3, 1e9
# Weight of the square of what |d'(c)| exceeds this slope by, and the slope that it never exceeds without need.
_STEEP_WEIGHT, _STEEP, _STEEPEST = 10.0, 0.9, 0.98
_ROUNDS, _NEWTON = 100, 30
# Degree of the spline d(c), and how many times the steps of the pairing's grid are smoothed to begin with.
_SMOOTH, _SMOOTHINGS = 5, 12
_LEAST_COSINE = 0.1
# Warp of this size is rounding.
_ROUNDING = 1e-13
# Newton moves a ruling by no more than this many distances of stations.
_FAR = 4.0
# The slope of d(c) stays below 1 by this.
_RISING = 1e-9
# The sum is at rest where it falls by a smaller share.
_REST = 1e-9
# Rulings at both ends together that may lie beyond the smooth part; and how near to both ends of the rails, as a share,
# the nearest one lies where it begins or ends there itself.
_BEYOND, _AT_ENDS = 16, 0.05
# A place within this share of a rail's end is that end.
_END = 1e-9


@dataclass(frozen=True, eq=False)
class Settled:
    """The smooth part of a surface between two rails.

    Attributes:
        rails: both.
        middles: (k,) middles c of its rulings, rising.
        leads: (k,) their leads d.
        exact: whether every one of them has one tangent plane.
        slivers: (2, 2) what is added to the shares of the first and of the last ruling, and evenly less in between, so
            that no fan is left that is too narrow to be cut; it warps the surface by about as much, in radians.
    """

    rails: tuple[Rail, Rail]
    middles: Array
    leads: Array
    exact: bool
    slivers: Array

    def shares(self, middles: Array) -> Array:
        """(m, 2) shares of both rails at middles (m,) of rulings between the first and the last one."""
        if len(self.middles) == 1:
            return np.repeat([[self.middles[0] + self.leads[0], self.middles[0] - self.leads[0]]], len(middles), axis=0)
        leads = np.asarray(make_interp_spline(self.middles, self.leads, k=_SMOOTH)(middles))
        if self.exact:
            inside = (middles > self.middles[0]) & (middles < self.middles[-1])
            moved, done = _polished(self.rails, middles, leads, float(np.diff(self.middles).max()))
            leads = np.where(inside & done, moved, leads)
        onward = (middles - self.middles[0]) / max(float(self.middles[-1] - self.middles[0]), _END)
        added = np.stack([1.0 - onward, onward], axis=-1) @ self.slivers
        return np.clip(np.stack([middles + leads, middles - leads], axis=-1) + added, 0.0, 1.0)


def settled(rails: tuple[Rail, Rail], shares: tuple[Array, Array], path: IntArray) -> Settled:
    """Move a pairing of places (m,) and (n,) of two rails to where rulings have one tangent plane.

    Args:
        rails: both rails.
        shares: of their lengths, that were paired.
        path: (k, 2) pairs of them.
    """
    path = _between_fans(path, (len(shares[0]) - 1, len(shares[1]) - 1))
    a, b = shares[0][path[:, 0]], shares[1][path[:, 1]]
    middles, leads = 0.5 * (a + b), 0.5 * (a - b)
    if len(middles) < 2 or middles[-1] - middles[0] <= _END:  # two fans, and nothing between them
        one = _sine(rails, middles[:1], leads[:1])
        return Settled(rails, middles[:1], leads[:1], bool(abs(one.angle[0]) <= EXACT), np.zeros((2, 2)))
    stations = np.linspace(middles[0], middles[-1], STATIONS)
    begun = _smoothed(stations, np.interp(stations, middles, leads))
    begun = _moved_together(rails, stations, begun)
    found = _onto_zero(rails, stations, begun)
    return found or Settled(rails, stations, begun, False, _slivers(stations, begun))


def _between_fans(path: IntArray, last: tuple[int, int]) -> IntArray:
    """The path without what runs along the first or the last place of a rail: that is a fan, whatever it cost."""
    start = int(np.flatnonzero((path == 0).any(axis=1))[-1]) if (path[0] == 0).any() else 0
    ends = np.flatnonzero((path[start:] == last).any(axis=1))
    return path[start : start + int(ends[0]) + 1]


def _sine(rails: tuple[Rail, Rail], middles: Array, leads: Array) -> Signed:
    a, b = (np.clip(share, 0.0, 1.0) for share in (middles + leads, middles - leads))
    return signed_warp(rails[0].at(a), rails[1].at(b))


def _allowed(middles: Array, leads: Array, steepest: float = 1.0 + _RISING) -> bool:
    """Whether both shares rise, between 0 and 1."""
    rising = np.abs(np.diff(leads)) <= steepest * np.diff(middles)
    return bool(rising.all() and (np.abs(leads) <= np.minimum(middles, 1.0 - middles) + _END).all())


def _smoothed(middles: Array, leads: Array) -> Array:
    """Leads (k,) without the steps of the grid, no steeper than the steepest; the first and the last one stay."""
    line = leads[0] + (leads[-1] - leads[0]) * (middles - middles[0]) / (middles[-1] - middles[0])
    beside = leads - line
    for _ in range(_SMOOTHINGS):
        beside[1:-1] = 0.25 * (beside[:-2] + 2.0 * beside[1:-1] + beside[2:])
    return np.asarray(line + _STEEPEST * beside)


class _Together:
    """The sum that the leads of all rulings make small together.

    Attributes:
        rails: both.
        middles: (k,) of the rulings, one distance apart.
    """

    def __init__(self, rails: tuple[Rail, Rail], middles: Array) -> None:
        self.rails, self.middles = rails, middles
        self._pace = float(middles[1] - middles[0])
        self._bend = _BEND * (1.0 - 2.0 / len(middles)) / len(middles) / self._pace**4 * (middles[-1] - middles[0]) ** 4

    def cost(self, leads: Array) -> tuple[float, Signed]:
        """The sum, and the warps in it."""
        signed = _sine(self.rails, self.middles, leads)
        warps, steep = (signed.angle**2).mean(), (self._steep(leads) ** 2).mean()
        return float(warps + _STEEP_WEIGHT * steep + self._bend * (np.diff(leads, 2) ** 2).sum()), signed

    def _steep(self, leads: Array) -> Array:
        """(k - 1,) by what slopes exceed the steep one, with their sign."""
        slopes = np.diff(leads) / self._pace
        return np.asarray(np.sign(slopes) * np.maximum(np.abs(slopes) - _STEEP, 0.0))

    def normal(self, leads: Array, now: Signed) -> tuple[Array, Array]:
        """The normal equations of the inner leads: three upper bands (3, k - 2), and the gradient (k - 2,)."""
        count = len(leads)
        # The angle's derivative is the sine's by the cosine; where the tangent planes are all but square, part of it.
        slope = (now.by_a - now.by_b) / np.copysign(np.maximum(np.abs(now.cosine), _LEAST_COSINE), now.cosine)
        bands, gradient = np.zeros((3, count)), slope * now.angle / count
        bands[2] = slope**2 / count
        steep = self._steep(leads)
        weight = _STEEP_WEIGHT / (count - 1.0) / self._pace
        gradient[1:] += weight * steep
        gradient[:-1] -= weight * steep
        held = weight / self._pace * (steep != 0.0)
        bands[2, 1:] += held
        bands[2, :-1] += held
        bands[1, 1:] -= held
        # The second difference at a station has the weights 1, -2, 1 on the leads about it.
        second = self._bend * np.diff(leads, 2)
        gradient[2:] += second
        gradient[1:-1] -= 2.0 * second
        gradient[:-2] += second
        bands[2, 2:] += self._bend
        bands[2, 1:-1] += 4.0 * self._bend
        bands[2, :-2] += self._bend
        bands[1, 2:] -= 2.0 * self._bend
        bands[1, 1:-1] -= 2.0 * self._bend
        bands[0, 2:] += self._bend
        inner = bands[:, 1:-1].copy()
        inner[1, 0] = 0.0
        inner[0, :2] = 0.0
        return inner, gradient[1:-1]


def _moved_together(rails: tuple[Rail, Rail], middles: Array, leads: Array) -> Array:
    """Leads (k,) with less warp; the first and the last ruling stay."""
    model, damping = _Together(rails, middles), _DAMPING
    least, now = model.cost(leads)
    for _ in range(_ROUNDS):
        bands, gradient = model.normal(leads, now)
        bands[-1] += damping * (bands[-1].mean() + bands[-1])
        trial = leads.copy()
        trial[1:-1] -= solveh_banded(bands, gradient)
        cost, ahead = model.cost(trial) if _allowed(middles, trial, 1.0 - _RISING) else (np.inf, now)
        if not cost < least:
            damping *= 8.0
            if damping > _MOST_DAMPING:
                break
            continue
        small = least - cost <= _REST * least
        leads, now, least, damping = trial, ahead, cost, damping / 4.0
        if small:
            break
    return leads


def _polished(rails: tuple[Rail, Rail], middles: Array, leads: Array, pace: float) -> tuple[Array, BoolArray]:
    """Leads (m,) at which rulings with these middles have one tangent plane, and (m,) where such were found nearby."""
    moved = leads.copy()
    now = _sine(rails, middles, moved)
    for _ in range(_NEWTON):
        slope = now.by_a - now.by_b
        with np.errstate(divide="ignore", invalid="ignore"):
            step = np.where(np.abs(now.sine) > 1e-15, -now.sine / slope, 0.0)
        step = np.clip(np.nan_to_num(step, nan=0.0, posinf=0.0, neginf=0.0), -pace, pace)
        trial = np.clip(moved + step, -np.minimum(middles, 1.0 - middles), np.minimum(middles, 1.0 - middles))
        ahead = _sine(rails, middles, trial)
        better = np.abs(ahead.angle) < np.abs(now.angle)
        if not (better & (np.abs(now.angle) > _ROUNDING)).any():
            break
        moved = np.where(better, trial, moved)
        now = Signed(*(np.where(better, new, old) for new, old in zip(ahead, now, strict=True)))
    return moved, np.abs(now.angle) <= EXACT


def _onto_zero(rails: tuple[Rail, Rail], middles: Array, leads: Array) -> Settled | None:
    """The pairing without warp near these leads, from where it enters both rails to where it leaves them; or None."""
    pace = _FAR * float(middles[1] - middles[0])
    moved, done = _polished(rails, middles, leads, pace)
    # A ruling that ran into the end of a rail lies beyond the smooth part.
    held = _longest(done)
    if len(held) < 3 or len(held) < len(done) - _BEYOND:
        return None
    inner = slice(held[0], held[-1] + 1)
    start = _border(rails, middles[inner][:2], moved[inner][:2], ending=False)
    stop = _border(rails, middles[inner][-2:][::-1], moved[inner][-2:][::-1], ending=True)
    if start is None or stop is None or not start[0] < stop[0]:
        return None
    stations = np.linspace(start[0], stop[0], STATIONS)
    known = (middles > start[0]) & (middles < stop[0]) & done
    known_middles = np.concatenate([[start[0]], middles[known], [stop[0]]])
    guess = np.interp(stations, known_middles, np.concatenate([[start[1]], moved[known], [stop[1]]]))
    found, done = _polished(rails, stations, guess, pace)
    found[[0, -1]] = start[1], stop[1]
    if not done[1:-1].all() or not _allowed(stations, found):
        return None
    return Settled(rails, stations, found, True, _slivers(stations, found))


def _longest(done: BoolArray) -> IntArray:
    """(k,) the longest stretch of places that are done."""
    runs = np.split(np.arange(len(done)), np.flatnonzero(np.diff(done)) + 1)
    return max((run for run in runs if done[run[0]]), key=len, default=np.empty(0, dtype=np.intp))


def _slivers(middles: Array, leads: Array) -> Array:
    """(2, 2) what brings the first and the last ruling to the ends of both rails, where they are all but there."""
    ends = np.stack([middles + leads, middles - leads], axis=-1)[[0, -1]]
    missing = np.array([[0.0], [1.0]]) - ends
    return np.where((np.abs(missing) <= SLIVER).all(axis=1, keepdims=True), missing, 0.0)


def _border(rails: tuple[Rail, Rail], middles: Array, leads: Array, *, ending: bool) -> tuple[float, float] | None:
    """Middle and lead of the ruling without warp from the first, or to the last, point of one of both rails.

    Args:
        rails: both.
        middles: (2,) of the two rulings next to it, the nearest first.
        leads: (2,) theirs.
        ending: whether it is the last one.
    """
    end = 1.0 if ending else 0.0
    near, next_ = (np.array([c + d, c - d]) for c, d in zip(middles.tolist(), leads.tolist(), strict=True))
    # Opposite of a line that begins along the other rail, any place of it will do: a fan that is there stays.
    if abs(_sine(rails, np.array([end]), np.zeros(1)).angle[0]) <= EXACT and np.abs(near - end).max() <= _AT_ENDS:
        return end, 0.0
    with np.errstate(divide="ignore", invalid="ignore"):
        ahead = (end - near) / (near - next_)
    ahead = np.where(np.isfinite(ahead) & (ahead >= -_END), ahead, np.inf)
    fixed = int(ahead.argmin())  # which rail ends first
    if not np.isfinite(ahead[fixed]):
        return None
    free = 1 - fixed
    share = float(np.clip(near[free] + ahead[fixed] * (near - next_)[free], 0.0, 1.0))
    for _ in range(_NEWTON):
        pair = np.array([end, share]) if fixed == 0 else np.array([share, end])
        signed = signed_warp(rails[0].at(pair[:1]), rails[1].at(pair[1:]))
        slope = float((signed.by_b if fixed == 0 else signed.by_a)[0])
        if abs(float(signed.sine[0])) <= 1e-3 * EXACT or slope == 0.0:
            break
        share = float(np.clip(share - float(signed.sine[0]) / slope, 0.0, 1.0))
    if abs(float(signed.angle[0])) > EXACT:
        return None
    return float(0.5 * pair.sum()), float(0.5 * (pair[0] - pair[1]))
