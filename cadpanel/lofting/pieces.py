"""The parts of a loft as splines: fans, at its ends or from a place within a rail, and what lies between them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import BSpline, make_interp_spline

from cadpanel.arrays import Array
from cadpanel.geometry.vectors import cross, norm
from cadpanel.lofting.rail import Jet, Rail
from cadpanel.lofting.ruled import RuledSurface
from cadpanel.lofting.settling import Settled
from cadpanel.lofting.warp import warp

DEGREE = 5
CLOSE = 1e-10
"""How far splines may leave the rails, as a part of the size of the loft, before more poles are tried."""
_FEWEST, _MOST = 17, 1025
# A fan over a smaller share of a rail is none.
_LEAST_FAN = 1e-7


@dataclass(frozen=True, eq=False)
class Piece:
    """A ruled surface (1 - v) A(u) + v B(u), u and v from 0 to 1.

    Attributes:
        edges: A and B, splines of one degree and with the same knots.
        apex: 0 or 1 where it is a fan from a point of that rail, its end or not, else None.
        shares: ((2,), (2,)) of both rails at its first and its last ruling.
        off: how far its edges leave the rails at most, mm.
    """

    edges: tuple[BSpline, BSpline]
    apex: int | None
    shares: Array
    off: float

    def jets(self, u: Array) -> tuple[Jet, Jet]:
        """Both edges at (m,) parameters."""
        one, other = (Jet(*(np.asarray(edge(u, nu=order)) for order in range(3))) for edge in self.edges)
        return one, other

    def ruled(self) -> RuledSurface:
        """It as a ruled B-spline surface."""
        poles = np.stack([np.asarray(edge.c) for edge in self.edges], axis=1)
        return RuledSurface(DEGREE, self.edges[0].t, np.concatenate([poles, np.ones((*poles.shape[:2], 1))], axis=-1))

    def warp(self, u: Array) -> Array:
        """(m,) angles between the tangent planes at both ends of the rulings; a fan has none."""
        return np.zeros(len(u)) if self.apex is not None else warp(*self.jets(u))

    def normals(self, u: Array) -> Array:
        """(m, 3) unit normals in the middle of the rulings: those of A'(u) x (B - A)."""
        a, b = self.jets(u)
        normals = cross(a.first + b.first, b.point - a.point)
        return np.asarray(normals / norm(normals)[:, None])


def pieces_of(smooth: Settled, size: float) -> tuple[Piece, ...]:
    """A loft from its first to its last ruling: fan, smooth part, fan; those that are there."""
    rails = smooth.rails
    first, last = smooth.shares(smooth.middles[[0, -1]])
    found = []
    for rail in (0, 1):
        found += _fan(rails, rail, 0.0, first, size)
    if smooth.middles[-1] > smooth.middles[0]:
        found.append(_between(smooth, size))
    for rail in (0, 1):
        found += _fan(rails, rail, 1.0, last, size)
    return tuple(found)


def _between(smooth: Settled, size: float) -> Piece:
    """What lies between the fans; a fan itself where all its rulings come from one place, as opposite of a line."""
    start, stop = smooth.middles[0], smooth.middles[-1]
    places = smooth.shares(smooth.middles)
    for along in (0, 1):
        still = places[:, 1 - along]
        if np.ptp(still) <= _LEAST_FAN:
            first, last = places[[0, -1], along].tolist()
            return _fan_from(smooth.rails, along, float(still.mean()), (first, last), size)
    return _piece(smooth.rails, lambda u: smooth.shares(start + (stop - start) * u), None, size)


def _fan(rails: tuple[Rail, Rail], along: int, end: float, ruling: Array, size: float) -> list[Piece]:
    """The fan along a rail between its end and a ruling (2,); empty where there is none."""
    if abs(ruling[along] - end) <= _LEAST_FAN:
        return []
    first, last = sorted((end, float(ruling[along])))
    return [_fan_from(rails, along, end, (first, last), size)]


def _fan_from(rails: tuple[Rail, Rail], along: int, still: float, span: tuple[float, float], size: float) -> Piece:
    """The fan along a rail over a span of shares, from the place with the share `still` of the other one."""

    def shares(u: Array) -> Array:
        places = np.full((len(u), 2), still)
        places[:, along] = span[0] + (span[1] - span[0]) * u
        return places

    return _piece(rails, shares, 1 - along, size)


def _piece(rails: tuple[Rail, Rail], shares: Callable[[Array], Array], apex: int | None, size: float) -> Piece:
    count, best = _FEWEST, None
    while True:
        u = np.linspace(0.0, 1.0, count)
        middles = 0.5 * (u[1:] + u[:-1])
        both = shares(np.sort(np.concatenate([u, middles])))
        points = np.stack([rail.at(both[:, row]).point for row, rail in enumerate(rails)], axis=1)
        spline = make_interp_spline(u, points[::2], k=DEGREE)
        off = float(norm(spline(middles) - points[1::2]).max())
        if best is None or off < best.off:
            # A pole of the apex is the apex, to the last digit.
            poles = np.asarray(spline.c)
            if apex is not None:
                poles[:, apex] = points[0, apex]
            edges = tuple(BSpline(spline.t, np.ascontiguousarray(poles[:, row]), DEGREE) for row in (0, 1))
            best = Piece((edges[0], edges[1]), apex, both[[0, -1]], off)
        if best.off <= CLOSE * size or count >= _MOST:
            return best
        count = 2 * count - 1
