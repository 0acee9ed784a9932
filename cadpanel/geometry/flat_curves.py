"""Edges of sheets as they lie when the sheet is flat: segments, and sections of cones rolled out. Millimetres, radians.

A cone patch is walked by the angle phi round its axis. With k the sine of its half angle, rho the distance of its first
ruling's point from the axis and theta = k phi, the generatrix at phi lies in the plane where rolling without slipping
puts it, and the point at height s along it at

    across = s sin(theta) + rho phi sinc(theta),    along = s cos(theta) - rho k phi^2 / 2 sinc(theta / 2)^2,

seen from the first ruling's point, `along` being its direction. Neither the apex nor a division by k occurs: with k = 0
these are the formulas of the cylinder. The height at which a cut plane is met is a quotient of numbers linear in
cos(phi) and sin(phi); a side that stands in a plane runs along the generatrices, nearly, and is followed by the height
instead (see `plane_section`). Lengths are kept: ds^2 = dheight^2 + (rho + k height)^2 dphi^2, on the cone as in the
plane.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from cadpanel.arrays import Array, BoolArray, IntArray
from cadpanel.geometry.plane_section import PlaneSection
from cadpanel.geometry.vectors import side_of

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(48)
_NODES, _WEIGHTS = 0.5 * (1.0 + _NODES), 0.5 * _WEIGHTS


@dataclass(frozen=True, slots=True, kw_only=True)
class FlatCurves:
    """c pieces in the plane, each followed by u from 0 to 1.

    Attributes:
        start, stop: (c, 2) where they begin and end, mm.
        origin: (c, 2) where the point of the patch's first ruling lies, mm.
        along: (c, 2) unit direction of that ruling.
        level_radius: (c,) rho, signed, mm.
        sine: (c,) k.
        first: (c,) phi where it begins, or of a side the height.
        sweep: (c,) from there to where it ends; 0 for a segment.
        reach, rate: (c, 3) height = reach . (1, cos phi, sin phi) / rate . (1, cos phi, sin phi).
        backward: (c,) whether u runs from the end to the beginning.
        way_out: (c,) of a side in a plane 1 or -1, see `PlaneSection.angles`; else 0.
    """

    start: Array
    stop: Array
    origin: Array
    along: Array
    level_radius: Array
    sine: Array
    first: Array
    sweep: Array
    reach: Array
    rate: Array
    backward: BoolArray
    way_out: Array

    def __len__(self) -> int:
        return len(self.sweep)

    def take(self, rows: IntArray | slice) -> FlatCurves:
        """Some of the pieces."""
        return FlatCurves(**{one.name: getattr(self, one.name)[rows] for one in fields(self)})

    @property
    def curved(self) -> BoolArray:
        """(c,) which of them are no segments."""
        return np.asarray(self.sweep != 0.0)

    def points(self, u: Array) -> Array:
        """(c, q, 2) points at the parameters u (c, q)."""
        phi, height, _, _ = self._followed(u)
        theta, rho = self.sine[:, None] * phi, self.level_radius[:, None]
        across = height * np.sin(theta) + rho * phi * _sinc(theta)
        along = height * np.cos(theta) - 0.5 * rho * self.sine[:, None] * phi**2 * _sinc(0.5 * theta) ** 2
        rolled = self.origin[:, None] + _combined(self.along[:, None], across, along)
        straight = self.start[:, None] + u[..., None] * (self.stop - self.start)[:, None]
        return np.where(self.curved[:, None, None], rolled, straight)

    def velocities(self, u: Array) -> Array:
        """(c, q, 2) derivatives of `points` by u."""
        phi, height, turn, climb = self._followed(u)
        theta = self.sine[:, None] * phi
        width = self.level_radius[:, None] + self.sine[:, None] * height
        sine, cosine = np.sin(theta), np.cos(theta)
        across, along = climb * sine + turn * width * cosine, climb * cosine - turn * width * sine
        pace = np.where(self.backward, -self.sweep, self.sweep)[:, None, None]
        rolled = pace * _combined(self.along[:, None], across, along)
        straight = np.broadcast_to((self.stop - self.start)[:, None], rolled.shape)
        return np.where(self.curved[:, None, None], rolled, straight)

    def lengths(self) -> Array:
        """(c,) lengths, mm, to rounding error."""
        speed = np.linalg.norm(self.velocities(np.broadcast_to(_NODES, (len(self), len(_NODES)))), axis=-1)
        lengths: Array = speed @ _WEIGHTS
        return lengths

    def areas(self) -> Array:
        """(c,) what each piece adds to the area that a closed round of them encloses, mm2."""
        u = np.broadcast_to(_NODES, (len(self), len(_NODES)))
        middle = self.start[:, None]
        swept = side_of(np.zeros(2), self.points(u) - middle, self.velocities(u))
        swept = np.where(self.curved[:, None], swept, 0.0)
        areas: Array = 0.5 * (swept @ _WEIGHTS + side_of(np.zeros(2), self.start, self.stop))
        return areas

    def _followed(self, u: Array) -> tuple[Array, Array, Array, Array]:
        """Angles, heights, and the derivatives of both by what the pieces are followed by, (c, q) each."""
        at = self.first[:, None] + np.where(self.backward[:, None], 1.0 - u, u) * self.sweep[:, None]
        phi, (height, climb) = at, PlaneSection(reach=self.reach, rate=self.rate).heights(at)
        turn = np.ones_like(at)
        sides = np.flatnonzero(self.way_out)
        if len(sides):
            own = PlaneSection(reach=self.reach[sides], rate=self.rate[sides])
            phi = at.copy()
            height[sides], climb[sides] = at[sides], 1.0
            phi[sides], turn[sides] = own.angles(at[sides], self.way_out[sides], np.zeros(len(sides)))
        return phi, height, turn, climb


def joined(curves: list[FlatCurves]) -> FlatCurves:
    """The pieces of all of them, one after the other."""
    return FlatCurves(
        **{one.name: np.concatenate([getattr(some, one.name) for some in curves]) for one in fields(FlatCurves)}
    )


def segments(start: Array, stop: Array) -> FlatCurves:
    """Segments between points (c, 2)."""
    count = len(start)
    none, ahead = np.zeros(count), np.tile([0.0, 1.0], (count, 1))
    one = np.tile([1.0, 0.0, 0.0], (count, 1))
    return FlatCurves(
        start=start,
        stop=stop,
        origin=start,
        along=ahead,
        level_radius=none,
        sine=none,
        first=none,
        sweep=none,
        reach=np.zeros((count, 3)),
        rate=one,
        backward=np.zeros(count, dtype=bool),
        way_out=none,
    )


def _combined(along_way: Array, across: Array, along: Array) -> Array:
    """Vectors with these parts across and along a direction; across is to its right."""
    x, y = along_way[..., 0], along_way[..., 1]
    return np.stack([across * y + along * x, along * y - across * x], axis=-1)


def _sinc(angles: Array) -> Array:
    """sin(a) / a, smooth through 0."""
    quotient: Array = np.sinc(angles / np.pi)
    return quotient
