"""A rail: a chain of B-spline curves, rational or not, evaluated with two derivatives, and followed by arc length."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from scipy.interpolate import BSpline, make_interp_spline

from cadpanel.arrays import Array
from cadpanel.errors import LoftError
from cadpanel.geometry.vectors import norm, unit

CORNER = 1e-3
"""Two stretches that meet at a larger angle, radians, meet in a corner."""
# Stretches follow each other where they are no farther apart than this part of both their lengths, or this, mm.
_FOLLOWS, _MEETS = 1e-6, 1e-3
# Gauss nodes between two knots, and the pieces of a span for the table of lengths.
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(12)
_PARTS = 8
# A curve whose speed is less than this part of its largest one stands still.
_STILL = 1e-9
_DEGREE = 5


class Jet(NamedTuple):
    """Points (m, 3) of a curve with first and second derivatives."""

    point: Array
    first: Array
    second: Array


@dataclass(frozen=True, slots=True)
class Stretch:
    """One B-spline curve without corners.

    Attributes:
        degree: at least 1.
        knots: (n + degree + 1,) clamped.
        poles: (n, 4) w x, w y, w z, w.
    """

    degree: int
    knots: Array
    poles: Array

    def reversed(self) -> Stretch:
        """The same followed backwards."""
        return Stretch(self.degree, self.knots[0] + self.knots[-1] - self.knots[::-1], self.poles[::-1].copy())

    @property
    def ends(self) -> Array:
        """(2, 3) its first and its last point."""
        outer = self.poles[[0, -1]]
        return np.asarray(outer[:, :3] / outer[:, 3:])

    def at(self, u: Array) -> Jet:
        """Points and derivatives by its own parameter (m,).

        A rational curve is the quotient p = h / w: p' = (h' - w' p) / w, p'' = (h'' - 2 w' p' - w'' p) / w.
        """
        spline = BSpline(self.knots, self.poles, self.degree)
        none, once, twice = (spline(u, nu=order) for order in range(3))
        weight = none[:, 3:]
        point = none[:, :3] / weight
        first = (once[:, :3] - once[:, 3:] * point) / weight
        second = (twice[:, :3] - 2.0 * once[:, 3:] * first - twice[:, 3:] * point) / weight
        return Jet(point, first, second)


def stretch_of(spline: BSpline) -> Stretch:
    """A spline of scipy, (n, 3) coefficients and clamped, as a stretch."""
    poles = np.asarray(spline.c, dtype=np.float64)
    return Stretch(int(spline.k), np.asarray(spline.t, dtype=np.float64), np.column_stack([poles, np.ones(len(poles))]))


def stretch_through(points: Array) -> Stretch:
    """The smooth curve through (q, 3) points, q >= 2."""
    steps = norm(np.diff(points, axis=0))
    if len(points) < 2 or not (steps > 0.0).all():
        raise LoftError("a rail is told by two points or more, each apart from the one before it; leave doubles out")
    return stretch_of(make_interp_spline(np.cumsum([0.0, *steps]), points, k=min(_DEGREE, len(points) - 1)))


@dataclass(frozen=True, eq=False)
class Rail:
    """A smooth or cornered curve, followed by the share of its length from 0 to 1.

    Attributes:
        name: for messages.
        stretches: each begins where the one before it ends.
        length: mm.
    """

    name: str
    stretches: tuple[Stretch, ...]
    length: float = field(init=False)
    _shares: Array = field(init=False, repr=False)
    _places: Array = field(init=False, repr=False)
    _breaks: Array = field(init=False, repr=False)

    def __repr__(self) -> str:
        return f"<Rail '{self.name}': {self.length:.0f} mm, {len(self.stretches)} stretches>"

    def __post_init__(self) -> None:
        """Measure its length.

        Raises:
            LoftError: it has none, stands still somewhere, or is not a curve of numbers.
        """
        lengths, places, starts = [], [], [0]
        for number, stretch in enumerate(self.stretches):
            spans = np.unique(stretch.knots)
            fine = np.unique(np.concatenate([np.linspace(*span, _PARTS + 1) for span in pairwise(spans)]))
            half = 0.5 * np.diff(fine)
            nodes = (fine[:-1] + half)[:, None] + half[:, None] * _NODES
            speed = norm(stretch.at(nodes.reshape(-1)).first).reshape(nodes.shape)
            lengths.append(half * (speed @ _WEIGHTS))
            places.append(np.stack([np.full(len(fine), float(number)), fine], axis=-1))
            starts.append(starts[-1] + len(half))
        along = np.concatenate([[0.0], np.cumsum(np.concatenate(lengths))])
        if not (np.isfinite(along).all() and along[-1] > 0.0):
            raise LoftError(f"rail '{self.name}' has no length: draw it again")
        self._check_moves()
        object.__setattr__(self, "length", float(along[-1]))
        object.__setattr__(self, "_shares", along / along[-1])
        object.__setattr__(self, "_places", np.concatenate([place[:-1] for place in places] + [places[-1][-1:]]))
        object.__setattr__(self, "_breaks", along[starts] / along[-1])

    def _check_moves(self) -> None:
        """Refuse what has no tangent somewhere, as a cusp or poles that lie on each other have none."""
        for stretch in self.stretches:
            spans = np.unique(stretch.knots)
            u = np.unique(np.concatenate([np.linspace(*span, _PARTS + 1) for span in pairwise(spans)]))
            jet = stretch.at(u)
            speed = norm(jet.first)
            still = speed <= _STILL * speed.max()
            if still.any():
                x, y, z = (np.round(jet.point[still][0], 1) + 0.0).tolist()
                raise LoftError(
                    f"rail '{self.name}' stands still at ({x:.1f}, {y:.1f}, {z:.1f}) mm and has no tangent there: "
                    "draw it again through points that lie apart"
                )

    def at(self, share: Array) -> Jet:
        """Points and derivatives by the share of the length, at (m,) shares between 0 and 1.

        With v = |p'| and the length L, the derivatives by the share are L p' / v and
        L^2 (p'' - (p' . p'') p' / v^2) / v^2.
        """
        number = np.clip(np.searchsorted(self._breaks, share, side="right") - 1, 0, len(self.stretches) - 1)
        found = np.empty((3, len(share), 3))
        for index, stretch in enumerate(self.stretches):
            here = number == index
            if here.any():
                jet = stretch.at(self._parameters(stretch, index, share[here]))
                found[:, here] = jet
        point, first, second = found
        speed = norm(first)[:, None]
        way = first / speed
        bend = (second - np.einsum("md,md->m", second, way)[:, None] * way) / speed**2
        return Jet(point, self.length * way, self.length**2 * bend)

    def _parameters(self, stretch: Stretch, index: int, share: Array) -> Array:
        """The stretch's own parameters at (m,) shares of the whole rail: from the table by Newton's method."""
        rows = self._places[:, 0] == index
        table_u = np.append(self._places[rows, 1], stretch.knots[-1])
        first = int(np.flatnonzero(rows)[0])
        table = self._shares[first : first + len(table_u)] * self.length
        wanted = np.clip(share * self.length, table[0], table[-1])
        row = np.clip(np.searchsorted(table, wanted, side="right") - 1, 0, len(table) - 2)
        low, high = table_u[row], table_u[row + 1]
        u = low + (high - low) * (wanted - table[row]) / np.maximum(table[row + 1] - table[row], 1e-300)
        for _ in range(4):
            half = 0.5 * (u - low)
            nodes = (low + half)[:, None] + half[:, None] * _NODES
            speed = norm(stretch.at(nodes.reshape(-1)).first).reshape(nodes.shape)
            missing = wanted - table[row] - half * (speed @ _WEIGHTS)
            u = np.clip(u + missing / norm(stretch.at(u).first), low, high)
        return np.asarray(u)

    @property
    def joints(self) -> Array:
        """Shares at which stretches meet, without the rail's ends."""
        return self._breaks[1:-1]

    def corners(self) -> list[int]:
        """Before which stretches it has a corner."""
        found = []
        for index in range(1, len(self.stretches)):
            before, after = self.stretches[index - 1], self.stretches[index]
            ways = unit(np.stack([before.at(before.knots[-1:]).first[0], after.at(after.knots[:1]).first[0]]))
            if norm(ways[1] - ways[0]) > CORNER:
                found.append(index)
        return found

    def cut(self, corners: Sequence[int]) -> list[Rail]:
        """Its parts between these stretches."""
        ends = [0, *corners, len(self.stretches)]
        parts = [self.stretches[start:stop] for start, stop in pairwise(ends)]
        if len(parts) == 1:
            return [self]
        return [Rail(f"{self.name}, part {number}", part) for number, part in enumerate(parts, start=1)]

    def reversed(self) -> Rail:
        """The same followed backwards."""
        return Rail(self.name, tuple(stretch.reversed() for stretch in reversed(self.stretches)))

    def share_of_corner(self, corner: int) -> float:
        """The share at which a stretch begins."""
        return float(self._breaks[corner])


def chained(name: str, stretches: Sequence[Stretch]) -> Rail:
    """Stretches in any order and direction as one rail.

    Raises:
        LoftError: they do not follow each other.
    """
    left = list(stretches)
    chain = [left.pop(0)]
    while left:
        reach = _reach([*chain, *left])
        for index, other in enumerate(left):
            placed = _follows(chain, other, reach)
            if placed is not None:
                chain = placed
                left.pop(index)
                break
        else:
            x, y, z = chain[-1].ends[1]
            raise LoftError(
                f"the curves of rail '{name}' do not follow each other: at ({x:.1f}, {y:.1f}, {z:.1f}) mm none goes "
                "on; join them, or name one of them"
            )
    return Rail(name, tuple(chain))


def _reach(stretches: Sequence[Stretch]) -> float:
    points = np.concatenate([stretch.poles[:, :3] / stretch.poles[:, 3:] for stretch in stretches])
    return max(_MEETS, _FOLLOWS * float(norm(np.ptp(points, axis=0))))


def _follows(chain: list[Stretch], other: Stretch, reach: float) -> list[Stretch] | None:
    joins: list[Callable[[], tuple[Array, Array, list[Stretch]]]] = [
        lambda: (chain[-1].ends[1], other.ends[0], [*chain, other]),
        lambda: (chain[-1].ends[1], other.ends[1], [*chain, other.reversed()]),
        lambda: (chain[0].ends[0], other.ends[1], [other, *chain]),
        lambda: (chain[0].ends[0], other.ends[0], [other.reversed(), *chain]),
    ]
    for join in joins:
        one, two, placed = join()
        if norm(one - two) <= reach:
            return placed
    return None


def rail_of(given: object, name: str) -> Rail:
    """A rail from a rail, a spline of scipy, or (q, 3) points along a smooth curve.

    Raises:
        LoftError: it is none of these.
    """
    if isinstance(given, Rail):
        return replace(given, name=given.name or name)
    if isinstance(given, BSpline):
        return Rail(name, (stretch_of(given),))
    try:
        points = np.asarray(given, dtype=np.float64)
    except (TypeError, ValueError):
        points = np.empty(0)
    if points.ndim != 2 or points.shape[-1] != 3 or not np.isfinite(points).all():
        raise LoftError(f"rail '{name}' is a Rail, a spline of scipy or points (q, 3), not {given!r:.60}")
    return Rail(name, (stretch_through(points),))
