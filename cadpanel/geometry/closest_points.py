"""Closest points of chains of segments and conic arcs, for many points at once.

Each piece is followed by a few stations. Where the distance from the stations of a piece is least, and no station
elsewhere rules it out, Newton's method goes on to where the curve is square to the way to the point.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array, BoolArray, IntArray
from cadpanel.geometry.conic_chains import ConicChains, followed, followed_twice, inner, seen_from

STATIONS = 6
"""Steps in which each piece is followed to begin with."""
_REACH = 1.1
"""Points between two stations are no farther from either than this times the chord between the two."""
_ROUNDS = 6
"""Rounds of two steps of Newton's method each; almost all points settle in the first two."""
_SETTLED = 1e-6
"""Share of a piece: the error after a step of Newton's method no longer than this goes with its square."""
_BENT = 0.1
"""Least second derivative, as a share of the squared speed, with which a step of Newton's method is taken."""
_JOINED = 1e-6
"""Share of two pieces' steps by which their ends may be apart where they meet."""
_SECTIONS = 45
"""Steps of the golden section where Newton's method does not settle: 1e-9 of two stations' distance in the end."""
_ROUNDING = 1e-10
"""Share of a station's reach, and of squared distances, that is no difference."""
_GOLDEN = 0.5 * (np.sqrt(5.0) - 1.0)


@dataclass(frozen=True, slots=True)
class Stations:
    """What every chain is followed by.

    Attributes:
        chains: (c chains of k pieces).
        points: (3, c, k, STATIONS + 1).
        reach: (c, k, STATIONS + 1) from each station to whatever lies between it and its neighbours.
        joins: (c * k + 1,) whether the piece in a column begins where the one before it ends.
    """

    chains: ConicChains
    points: Array
    reach: Array
    joins: BoolArray


def stations(chains: ConicChains) -> Stations:
    """Follow every piece from end to end."""
    w = np.linspace(0.0, 1.0, STATIONS + 1)
    columns = np.repeat(np.arange(chains.curves.shape[1]), len(w))
    points = followed(np.take(chains.curves, columns, axis=1), np.tile(w, chains.curves.shape[1]))
    points = points.reshape(3, chains.count, chains.pieces, len(w))
    steps = np.diff(points, axis=-1)
    chords = _REACH * np.sqrt(inner(steps, steps))
    reach = np.zeros(points.shape[1:])
    reach[..., :-1] = chords
    reach[..., 1:] = np.maximum(reach[..., 1:], chords)
    joins = np.zeros((chains.count, chains.pieces), dtype=np.bool_)
    gaps = points[..., 1:, 0] - points[..., :-1, -1]
    joins[:, 1:] = np.sqrt(inner(gaps, gaps)) <= _JOINED * (reach[:, 1:, 0] + reach[:, :-1, -1])
    return Stations(chains, points, reach, np.append(joins.ravel(), False))


def closest_points(on: Stations, of: IntArray, points: Array) -> tuple[IntArray, Array, Array]:
    """Where on their chains the points (3, n) have their closest points: the column (n,), w (n,), and distance (n,).

    Args:
        on: the chains.
        of: (n,) the chain of each point.
        points: (3, n).
    """
    pieces = on.chains.pieces
    item, piece, station, square = _starts(on, of, points)
    column = of[item] * pieces + piece
    curves = seen_from(np.take(on.chains.curves, column, axis=1), points[:, item])
    # What rounding alone makes of a distance counts as no distance.
    level = square * (1.0 + _ROUNDING) + (_ROUNDING * on.reach[of[item], piece, station]) ** 2
    w, found = _descend(curves, station, level)
    if len(item) == len(of):
        return column, w, np.sqrt(found)
    least = np.minimum.reduceat(found, np.searchsorted(item, np.arange(len(of))))
    best = np.flatnonzero(found == least[item])
    chosen = np.zeros(len(of), dtype=np.intp)
    chosen[item[best[::-1]]] = best[::-1]  # of equals the first
    return column[chosen], w[chosen], np.sqrt(least)


def distances_near(chains: ConicChains, columns: IntArray, w: Array, points: Array) -> Array:
    """Distances (n,) from the points (3, n) to places near w (n,) of the pieces in the columns (n,).

    One step of Newton's method from there, or no step where it leads away: never less than the least distance, and
    about as much where the closest point is near.
    """
    curves = seen_from(np.take(chains.curves, columns, axis=1), points)
    _, stepped = _step(curves, w)
    squares = [inner(away, away) for away in (followed(curves, w), followed(curves, stepped))]
    return np.sqrt(np.minimum(*squares))


def _starts(on: Stations, of: IntArray, points: Array) -> tuple[IntArray, IntArray, IntArray, Array]:
    """Where descents begin: which point, piece and station of it, and the squared distance (m,) there; by points."""
    apart = np.take(on.points, of, axis=1)
    apart -= points[:, :, None, None]
    square = inner(apart, apart)
    least = np.ones(square.shape, dtype=np.bool_)
    falls = square[..., 1:] <= square[..., :-1]
    least[..., 1:] &= falls
    least[..., :-1] &= ~falls
    item, piece, station = np.nonzero(least)
    found = square[item, piece, station]
    first = np.searchsorted(item, np.arange(len(of)))
    nearest = np.sqrt(np.minimum.reduceat(found, first)) if len(of) else np.zeros(0)
    kept = np.sqrt(found) - on.reach[of[item], piece, station] <= nearest[item]
    return item[kept], piece[kept], station[kept], found[kept]


def _descend(curves: Array, station: IntArray, square: Array) -> tuple[Array, Array]:
    """Where (m,) pieces (17, m) are closest to the origin near the stations (m,), and the squared distance (m,).

    `square` (m,) is that of the stations: where a descent ends above it, it went astray and the place is searched.
    """
    w = station / STATIONS
    moving = np.arange(len(station))
    own = curves
    at = w
    for _ in range(_ROUNDS):
        before, (_, at) = at, (_step(own, at))
        before, (_, at) = at, (_step(own, at))
        w[moving] = at
        settled = np.abs(at - before) <= _SETTLED
        moving, own, at = moving[~settled], own[:, ~settled], at[~settled]
        if not len(moving):
            break
    away = followed(curves, w)
    found = inner(away, away)
    astray = found > square
    astray[moving] = True
    if astray.any():
        lost = np.flatnonzero(astray)
        w[lost], found[lost] = _golden_section(curves[:, lost], station[lost] / STATIONS)
    return w, found


def _step(curves: Array, w: Array) -> tuple[Array, Array]:
    """One step of Newton's method towards the foot of the perpendicular from the origin, and where it ends."""
    away, along, bend = followed_twice(curves, w)
    square = inner(along, along)
    curved = square + inner(away, bend)
    # Where the squared distance is bent the wrong way, a step as on a straight line still leads downhill.
    curved = np.where(curved > _BENT * square, curved, np.maximum(square, np.finfo(float).tiny))
    step = inner(away, along) / curved
    return step, np.clip(w - step, 0.0, 1.0)


def _golden_section(curves: Array, middle: Array) -> tuple[Array, Array]:
    """Where (m,) pieces are closest to the origin within a station to both sides of `middle`, and the square."""
    low, high = (np.clip(middle + side / STATIONS, 0.0, 1.0) for side in (-1.0, 1.0))

    def square(w: Array) -> Array:
        away = followed(curves, w)
        return inner(away, away)

    for _ in range(_SECTIONS):
        left, right = high - _GOLDEN * (high - low), low + _GOLDEN * (high - low)
        falls = square(left) > square(right)
        low, high = np.where(falls, left, low), np.where(falls, high, right)
    below, above = square(low), square(high)
    return np.where(above < below, high, low), np.minimum(above, below)
