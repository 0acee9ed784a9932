"""Ruled B-spline surfaces, rational or not, and their dual form: the tangent planes at both ends of every ruling.

A ruled surface joins two rails of one degree p with the same knots (equation 1 of the paper, P homogeneous):

    S(u, v) = (1 - v) P0(u) + v P1(u).

Its tangent plane at the end j of a ruling holds P0, P1 and Pj'. Its homogeneous coordinates are the generalised cross
product of the three in four dimensions, U_j = +-(P0 x P1 x Pj'), and so splines again, of degree 3 p - 2: in Pj x Pj'
the highest power cancels (H. Pottmann and J. Wallner, Computational line geometry, 2001, chapter 6). The planes

    Y(u, v) = (1 - v) U0(u) + v U1(u)

are the dual form (equation 2 of the paper); the surface is developable where U0 and U1 are one point of dual space.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.interpolate import BSpline
from scipy.special import comb

from cadpanel.arrays import Array
from cadpanel.errors import LoftError
from cadpanel.geometry.vectors import norm

# A plane whose coordinates are smaller than the largest by this is none.
_STILL = 1e-12


@dataclass(frozen=True, eq=False)
class RuledSurface:
    """A ruled surface.

    Attributes:
        degree: of its rails.
        knots: (n + degree + 1,) clamped.
        poles: (n, 2, 4) of both rails: w x, w y, w z, w with w > 0, mm.
    """

    degree: int
    knots: Array
    poles: Array

    def __post_init__(self) -> None:
        """Refuse what is no surface.

        Raises:
            LoftError: numbers are missing, or weights are not above 0.
        """
        knots, poles = (np.asarray(given, dtype=np.float64) for given in (self.knots, self.poles))
        if poles.ndim != 3 or poles.shape[1:] != (2, 4) or knots.shape != (len(poles) + self.degree + 1,):
            raise LoftError("a ruled surface has poles (n, 2, 4) and n + degree + 1 knots")
        if not (np.isfinite(poles).all() and (poles[..., 3] > 0.0).all() and (np.diff(knots) >= 0.0).all()):
            raise LoftError("the poles of a ruled surface are numbers with weights above 0, and its knots do not fall")
        object.__setattr__(self, "knots", knots)
        object.__setattr__(self, "poles", poles)

    def rails(self, u: Array, order: int = 0) -> Array:
        """(m, 2, 4) homogeneous points of both rails at (m,) parameters, or their derivatives."""
        return np.asarray(BSpline(self.knots, self.poles, self.degree)(u, nu=order))

    def points(self, u: Array, v: Array) -> Array:
        """(m, 3) points, mm, at parameters (m,) and (m,) from 0 to 1."""
        rails = self.rails(u)
        mixed = (1.0 - v)[:, None] * rails[:, 0] + v[:, None] * rails[:, 1]
        return np.asarray(mixed[:, :3] / mixed[:, 3:])

    def dual(self) -> DualForm:
        """The tangent planes at both ends of every ruling, as splines."""
        spans = np.unique(self.knots)
        degree = max(3 * self.degree - 2, 1)
        nodes = 0.5 - 0.5 * np.cos(np.pi * (np.arange(degree + 1) + 0.5) / (degree + 1))
        inverse = np.linalg.inv(bernstein(degree, nodes))
        found = []
        for start, stop in pairwise(spans):
            found.append(np.einsum("ij,jkl->ikl", inverse, self.planes(start + (stop - start) * nodes)))
        return DualForm(degree, spans, np.array(found))

    def planes(self, u: Array) -> Array:
        """(m, 2, 4) the tangent planes at both ends of rulings, straight from their definition.

        A plane (n, d) holds the points x with n . x + d = 0; n points along S_u x S_v.
        """
        rails, ways = self.rails(u), self.rails(u, 1)
        return np.stack([_plane(rails[:, 0], rails[:, 1], ways[:, end]) for end in (0, 1)], axis=1)

    def disparity(self, u: Array) -> Array:
        """(m,) how far U0 and U1 are from one point of dual space: the sine of the angle between them, from 0 to 1.

        It is told in coordinates from the middle of the surface, in units of its size, so that it does not hang on
        where the surface lies or how large it is. A rail that stands still has any plane, and the disparity is 0.
        """
        places = self.poles[..., :3] / self.poles[..., 3:]
        middle = places.reshape(-1, 3).mean(axis=0)
        size = float(norm(np.ptp(places.reshape(-1, 3), axis=0)))
        planes = self.planes(u)
        own = np.concatenate([planes[..., :3] * size, planes[..., 3:] + planes[..., :3] @ middle[:, None]], axis=-1)
        lengths = np.linalg.norm(own, axis=-1)
        still = lengths <= _STILL * lengths.max()
        own = own / np.where(still, 1.0, lengths)[..., None]
        # |a - b| |a + b| / 2 is the sine, without the digits that 1 - (a . b)^2 loses.
        apart, together = (np.linalg.norm(own[:, 0] + sign * own[:, 1], axis=-1) for sign in (-1.0, 1.0))
        return np.asarray(np.where(still.any(axis=1), 0.0, 0.5 * apart * together), dtype=np.float64)


@dataclass(frozen=True, eq=False)
class DualForm:
    """Two planes a ruling, as polynomials of Bernstein on every span.

    Attributes:
        degree: of the polynomials.
        spans: (s + 1,) parameters between which they hold, rising.
        planes: (s, degree + 1, 2, 4) control planes.
    """

    degree: int
    spans: Array
    planes: Array

    def at(self, u: Array) -> Array:
        """(m, 2, 4) U0 and U1 at parameters (m,)."""
        row = np.clip(np.searchsorted(self.spans, u, side="right") - 1, 0, len(self.spans) - 2)
        share = (u - self.spans[row]) / (self.spans[row + 1] - self.spans[row])
        return np.asarray(np.einsum("mi,mijk->mjk", bernstein(self.degree, share), self.planes[row]))

    def between(self, u: Array, v: Array) -> Array:
        """(m, 4) the planes Y(u, v) of equation (2)."""
        both = self.at(u)
        return np.asarray((1.0 - v)[:, None] * both[:, 0] + v[:, None] * both[:, 1])


def bernstein(degree: int, share: Array) -> Array:
    """(m, degree + 1) Bernstein's polynomials at (m,) shares from 0 to 1."""
    index = np.arange(degree + 1)
    values: Array = comb(degree, index) * share[:, None] ** index * (1.0 - share[:, None]) ** (degree - index)
    return values


def plane_distance(one: Array, other: Array, points: Array) -> Array:
    """(...,) the distance of planes (..., 4) over a region of interest, mm: how far they lie apart at points (m, 3).

    The root of the mean square of the difference of the points' signed distances from both planes: Pottmann and
    Wallner's measure (1999), with the distance square to the plane instead of along z.
    """
    scaled = [planes / np.linalg.norm(planes[..., :3], axis=-1)[..., None] for planes in (one, other)]
    apart = [np.einsum("...d,md->...m", planes[..., :3], points) + planes[..., 3:] for planes in scaled]
    return np.asarray(np.sqrt(((apart[0] - apart[1]) ** 2).mean(axis=-1)))


def _plane(a: Array, b: Array, c: Array) -> Array:
    """(m, 4) the planes through three points or directions (m, 4): signed minors of three of the coordinates."""
    rows = np.stack([a, c, b], axis=1)
    columns = [[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]]
    signs = (1.0, -1.0, 1.0, -1.0)
    minors = [sign * np.linalg.det(rows[:, :, kept]) for sign, kept in zip(signs, columns, strict=True)]
    return np.stack(minors, axis=-1)
