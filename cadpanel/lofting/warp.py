"""How far a ruling is from having one tangent plane: its warp, with derivatives, and the distance of its two planes."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from cadpanel.arrays import Array
from cadpanel.geometry.vectors import cross, norm
from cadpanel.lofting.distance import Distance
from cadpanel.lofting.rail import Jet, Rail


class Signed(NamedTuple):
    """The sine of the warp (m,) with its sign, its derivatives by the shares of both rails, and the cosine."""

    sine: Array
    by_a: Array
    by_b: Array
    cosine: Array

    @property
    def angle(self) -> Array:
        """(m,) the warp with its sign, from -pi to pi, radians."""
        angle: Array = np.arctan2(self.sine, self.cosine)
        return angle


def _dot(one: Array, other: Array) -> Array:
    return np.asarray(np.einsum("...d,...d->...", one, other))


def signed_warp(a: Jet, b: Jet) -> Signed:
    """The sine of the warp along rulings between (m,) places of both rails; see the package for the formula."""
    ruling = b.point - a.point
    normal_a, normal_b = cross(a.first, ruling), cross(b.first, ruling)
    length, across_a, across_b = norm(ruling), norm(normal_a), norm(normal_b)
    scale = length / (across_a * across_b)
    volume = _dot(cross(a.first, b.first), ruling)
    sine = scale * volume
    # det(a', b', -a') and det(a', b', b') are nothing.
    volume_a = _dot(cross(a.second, b.first), ruling)
    volume_b = _dot(cross(a.first, b.second), ruling)
    # d log scale, by a: r' = -a', (a' x r)' = a'' x r, (b' x r)' = -b' x a'; and likewise by b.
    log_a = (
        -_dot(ruling, a.first) / length**2
        - _dot(normal_a, cross(a.second, ruling)) / across_a**2
        + _dot(normal_b, cross(b.first, a.first)) / across_b**2
    )
    log_b = (
        _dot(ruling, b.first) / length**2
        - _dot(normal_b, cross(b.second, ruling)) / across_b**2
        - _dot(normal_a, cross(a.first, b.first)) / across_a**2
    )
    cosine = _dot(normal_a, normal_b) / (across_a * across_b)
    return Signed(sine, scale * volume_a + sine * log_a, scale * volume_b + sine * log_b, cosine)


def warp(a: Jet, b: Jet) -> Array:
    """Angles (...,) between the tangent planes at both ends of rulings, from 0 to pi, radians."""
    ruling = b.point - a.point
    one, other = cross(a.first, ruling), cross(b.first, ruling)
    angle: Array = np.arctan2(norm(cross(one, other)), _dot(one, other))
    return angle


def grid(a: Jet, b: Jet) -> tuple[Jet, Jet]:
    """Every place of one rail against every place of the other: (m, 1, 3) and (1, n, 3)."""
    return Jet(*(one[:, None] for one in a)), Jet(*(one[None] for one in b))


def squares(rail_a: Rail, rail_b: Rail, shares_a: Array, shares_b: Array, distance: Distance) -> Array:
    """(m, n) the square of the distance of the tangent planes at both ends of every possible ruling.

    Either the warp; or the distance of the planes as points of dual space (Hoschek and Schneider, Interpolation and
    approximation with developable surfaces, 1997), each with a normal of length 1 and told from the middle of both
    rails, in units of their mean length: |m - n|^2 + ((m . p - n . q) / L)^2.
    """
    a, b = rail_a.at(shares_a), rail_b.at(shares_b)
    one, other = grid(a, b)
    if distance == "warp":
        return np.asarray(warp(one, other) ** 2)
    ruling = other.point - one.point
    normals = [cross(jet.first, ruling) for jet in (one, other)]
    units = [normal / norm(normal)[..., None] for normal in normals]
    middle = 0.5 * (a.point.mean(axis=0) + b.point.mean(axis=0))
    depths = [_dot(normal, jet.point - middle) for normal, jet in zip(units, (one, other), strict=True)]
    size = 0.5 * (rail_a.length + rail_b.length)
    return np.asarray(_dot(units[0] - units[1], units[0] - units[1]) + ((depths[0] - depths[1]) / size) ** 2)
