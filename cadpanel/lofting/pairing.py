"""The best of all ordered pairings of the places of two rails, by dynamic programming.

A pairing goes from both beginnings to both ends by steps along one rail, the other, or both. Along it the square q of
the warp is summed up by the trapezoid rule over the share of both rails that is passed, which does not depend on how
many steps that takes:

    E = sum (q before + q after) / 2 * (share of a passed + share of b passed) / 2 + crease.

It may begin with a fan: a cone from the first point of one rail over a stretch of the other, and end with one. A fan is
developable by itself, and its warp costs nothing; but where it meets the rest of the surface there is a crease as large
as the warp of that ruling, and its square counts whole, once for each fan. A hair of cost on rulings that
leave the even pairing decides where the rails leave the choice free, as in a plane.

The objective is that of Wang and Tang (2004) and of Frey (2002), posed for shares of length; dynamic programming after
Bellman: the best way to a place goes through the best way to the place before it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from cadpanel.arrays import Array, IntArray

EVEN = 1e-8
"""What the square of a difference between the shares of both ends of a ruling weighs against the square of its warp."""
_STEPS = ((1, 1), (1, 0), (0, 1))


class Pairing(NamedTuple):
    """An ordered pairing.

    Attributes:
        cost: E.
        path: (k, 2) the places that are paired along the smooth part, the fans left out.
    """

    cost: float
    path: IntArray


def best_pairing(squares: Array, shares_a: Array, shares_b: Array) -> Pairing:
    """The pairing of least cost.

    Args:
        squares: (m, n) q of every possible ruling.
        shares_a: (m,) of the first rail's length, from 0 to 1, rising.
        shares_b: (n,) of the second one's.
    """
    uneven = EVEN * np.subtract.outer(shares_a, shares_b) ** 2
    along_a, along_b = _fans(uneven, squares, shares_a, shares_b)
    cost, came = _swept(squares + uneven, shares_a, shares_b, (along_a, along_b))
    backwards = _fans(uneven[::-1, ::-1], squares[::-1, ::-1], -shares_a[::-1], -shares_b[::-1])
    leave_a, leave_b = (fan[::-1] for fan in backwards)
    # Where the fan at the end begins: on the last column, the rest of a is passed; on the last row, the rest of b.
    ends = np.concatenate([cost[:, -1] + leave_a, cost[-1, :] + leave_b])
    best = int(ends.argmin())
    m, n = squares.shape
    place = (best, n - 1) if best < m else (m - 1, best - m)
    return Pairing(float(ends[best]), _back(came, place))


def _fans(uneven: Array, squares: Array, shares_a: Array, shares_b: Array) -> tuple[Array, Array]:
    """(m,), (n,) what a fan over the beginning of each rail costs up to each place, its crease there included."""
    found = []
    for off, crease, shares in ((uneven[:, 0], squares[:, 0], shares_a), (uneven[0], squares[0], shares_b)):
        passed = np.concatenate([[0.0], np.cumsum(0.25 * (off[1:] + off[:-1]) * np.diff(shares))])
        found.append(passed + np.where(np.arange(len(shares)) > 0, crease, 0.0))
    return found[0], found[1]


def _swept(q: Array, shares_a: Array, shares_b: Array, fans: tuple[Array, Array]) -> tuple[Array, IntArray]:
    """(m, n) the least cost of getting to every place, and the step that leads there; -1 where the smooth part begins.

    Places on one anti-diagonal do not depend on each other.
    """
    m, n = q.shape
    cost = np.full((m, n), np.inf)
    cost[:, 0], cost[0, :] = fans
    came = np.full((m, n), -1, dtype=np.intp)
    for diagonal in range(1, m + n - 1):
        i = np.arange(max(0, diagonal - n + 1), min(m - 1, diagonal) + 1)
        j = diagonal - i
        for step, (down, right) in enumerate(_STEPS):
            inside = (i >= down) & (j >= right)
            here, there = (i[inside], j[inside]), (i[inside] - down, j[inside] - right)
            passed = shares_a[here[0]] - shares_a[there[0]] + shares_b[here[1]] - shares_b[there[1]]
            trial = cost[there] + 0.25 * (q[here] + q[there]) * passed
            better = trial < cost[here]
            cost[here[0][better], here[1][better]] = trial[better]
            came[here[0][better], here[1][better]] = step
    return cost, came


def _back(came: IntArray, place: tuple[int, int]) -> IntArray:
    path = [place]
    while came[path[-1]] >= 0:
        down, right = _STEPS[came[path[-1]]]
        path.append((path[-1][0] - down, path[-1][1] - right))
    return np.array(path[::-1], dtype=np.intp)
