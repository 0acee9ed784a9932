"""Where a plane meets the generatrices of a cone patch, followed by the angle or by the height. Millimetres, radians.

With the axis frame of `cone_sections` the plane through q with unit normal m meets the generatrix at phi in the height
h where

    reach . (1, cos phi, sin phi) = h rate . (1, cos phi, sin phi),

reach = (m . (q - c), -rho m . e, -rho m . b), rate = (cos g m . a, sin g m . e, sin g m . b). An end is followed by phi
and h is a quotient. A side runs along the generatrices, nearly, and is followed by h: then the same is an equation
A cos phi + B sin phi = D, and which of its two roots is the side the way out tells. Neither knows the apex, and nothing
happens where the conic is an ellipse, a hyperbola, or a ruling.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array
from cadpanel.geometry.cone_sections import AxisFrame

_MOST_STEPS = 40
_CLOSE = 1e-15
"""Radians within which a corner is found."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PlaneSection:
    """Where c planes meet a generatrix of their cone patches.

    Attributes:
        reach, rate: (c, 3) as above.
    """

    reach: Array
    rate: Array

    def heights(self, angles: Array) -> tuple[Array, Array]:
        """(c, q) heights at the angles (c, q), and their derivatives by them."""
        above, above_rate = _waves(self.reach, angles)
        below, below_rate = _waves(self.rate, angles)
        heights = above / below
        return heights, (above_rate - heights * below_rate) / below

    def angles(self, heights: Array, way_out: Array, near: Array) -> tuple[Array, Array]:
        """(c, q) angles at the heights (c, q), and their derivatives by them; not numbers where the plane ends before.

        Args:
            heights: mm.
            way_out: (c,) 1 where the angle grows on the way out of the panel, -1 where it falls.
            near: (c,) an angle within half a turn of those that are sought.
        """
        cosine = heights * self.rate[:, 1:2] - self.reach[:, 1:2]
        sine = heights * self.rate[:, 2:] - self.reach[:, 2:]
        level = (self.reach[:, :1] - heights * self.rate[:, :1]) / np.hypot(cosine, sine)
        inside = np.where(np.abs(level) <= 1.0, level, np.nan)
        angles = np.arctan2(sine, cosine) - way_out[:, None] * np.arccos(inside)
        angles += 2.0 * np.pi * np.round((near[:, None] - angles) / (2.0 * np.pi))
        (_, above_rate), (below, below_rate) = _waves(self.reach, angles), _waves(self.rate, angles)
        return angles, below / (above_rate - heights * below_rate)


def _waves(of: Array, angles: Array) -> tuple[Array, Array]:
    """Numbers linear in 1, cos and sin of angles (c, q), and their derivatives."""
    cosine, sine = np.cos(angles), np.sin(angles)
    return of[:, :1] + of[:, 1:2] * cosine + of[:, 2:] * sine, of[:, 2:] * cosine - of[:, 1:2] * sine


def plane_section(frame: AxisFrame, point: Array, normal: Array) -> PlaneSection:
    """Where the plane through a point (3,) with a unit normal (3,) meets a patch."""
    rise, toward, aside = (float(normal @ of) for of in (frame.axis, frame.radial, frame.tangential))
    cosine, sine = math.cos(frame.half_angle), math.sin(frame.half_angle)
    rho, offset = frame.level_radius, float(normal @ (point - frame.center))
    return PlaneSection(
        reach=np.array([[offset, -rho * toward, -rho * aside]]),
        rate=np.array([[cosine * rise, sine * toward, sine * aside]]),
    )


def corner_angles(ends: PlaneSection, sides: PlaneSection, starts: Array) -> Array:
    """(c,) angles at which ends meet the planes of sides, by Newton's method from (c,) `starts`.

    Along an end the distance beyond the side's plane is h rate - reach of that plane, times (1, cos phi, sin phi).
    """
    angles = starts.copy()
    for _ in range(_MOST_STEPS):
        heights, climbs = ends.heights(angles[:, None])
        reach, reach_rate = _waves(sides.reach, angles[:, None])
        rate, rate_rate = _waves(sides.rate, angles[:, None])
        step = (heights * rate - reach) / (climbs * rate + heights * rate_rate - reach_rate)
        angles = angles - step[:, 0]
        if not np.abs(step).max(initial=0.0) > _CLOSE * (1.0 + np.abs(angles).max()):
            break
    return angles
