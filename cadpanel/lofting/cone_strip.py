"""A developable strip as right circular cones that touch it, and each other, along rulings.

A tangent plane n . x + d = 0 with |n| = 1 is the point (n, d) of Blaschke's cylinder S2 x R. The planes of a right
circular cone are a conic on it: its normals keep one angle with the axis, n . a = c, and all hold the apex, d = -n . v.
So two cones that join two (plane, ruling) pairs of a strip, and touch each other along a ruling, are a biarc
there, whose normals are a biarc on the sphere (S. Leopoldseder and H. Pottmann, Approximation of developable surfaces
with cone spline surfaces, 1998; W. Wang and B. Joe, Interpolation on quadric surfaces with rational quadratic spline
curves, 1997). With u = (n, d), and t = (n', d') where |n'| = 1, the tangents at both ends are followed equally far:

    B0 = u0 + r t0,   B1 = u1 - r t1,   |B1 - B0| = 2 r in their normals,   joint (B0 + B1) / 2.

|n| = 1 there by itself. Of all biarcs, one for each ratio of the two reaches, this is the one of equal reaches.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array
from cadpanel.errors import LoftError
from cadpanel.geometry.frames import rotate_about
from cadpanel.geometry.vectors import cross, dot, unit
from cadpanel.lofting.tangent_planes import PlaneCurve

# Of cones that turn less than this, radians, nobody could tell the axis.
_LEAST_TURN = 1e-6


@dataclass(frozen=True, slots=True)
class Cones:
    """A chain of k right circular cones, told as a walk over them tells them.

    Attributes:
        origin: (3,) on the ruling in the middle of the anchor, mm.
        axes: (3, 3) there: columns b, the way of the walk; t, along the ruling; n, the normal.
        anchor: which cone the walk begins in.
        dimensions: (k, 3) normal radius at the first ruling from the anchor, mm; half angle; and sweep, radians.
    """

    origin: Array
    axes: Array
    anchor: int
    dimensions: Array


def joints(planes: Array, velocities: Array) -> Array:
    """(k + 1, 4) the planes of k even cones: the given ones, (k / 2 + 1, 4), and where each pair of cones meets.

    Args:
        planes: (n, d) with |n| = 1.
        velocities: (n', d') with |n'| = 1, the way of the walk.

    Raises:
        LoftError: the normals turn back between two of the planes.
    """
    leaving, arriving = velocities[:-1], velocities[1:]
    chord = planes[1:] - planes[:-1]
    square = dot(chord[:, :3], chord[:, :3])
    onward = dot(chord[:, :3], (leaving + arriving)[:, :3])
    if not ((onward > 0.0) & (square > _LEAST_TURN**2)).all():
        raise LoftError("the normals of the strip stand still, or turn back: no cones join its planes")
    bent = 1.0 - dot(leaving[:, :3], arriving[:, :3])
    reach = (square / (onward + np.sqrt(onward**2 + 2.0 * bent * square)))[:, None]
    middle = 0.5 * (planes[1:] + planes[:-1] + reach * (leaving - arriving))
    found = np.empty((2 * len(planes) - 1, 4))
    found[::2], found[1::2] = planes, middle
    return found


def cones_through(curve: PlaneCurve, between: tuple[float, float], count: int, anchor: int) -> Cones:
    """An even number of cones along a strip, of equal turning two by two.

    Args:
        curve: the strip.
        between: the s of its first ruling on the way of the walk, which goes towards x, and of its last.
        count: of cones, which touch the strip along every second of their rulings.
        anchor: which of them the walk begins in.

    Raises:
        LoftError: the number is odd, or the strip is not regular, or turns too little.
    """
    if count < 2 or count % 2:
        raise LoftError(f"cones touch a strip two by two: {count} do not, ask for an even number")
    if not curve.bend:
        raise LoftError("rulings of the strip meet inside of it: no cones follow it")
    first, last = np.arctan(between).tolist()
    s = np.tan(np.linspace(first, last, count // 2 + 1))
    velocities = curve.bend * curve.velocities(s)
    planes = joints(curve.planes(s), velocities)
    walked = _walked(planes, velocities[0, :3], curve.rulings(s[:1])[0][0], curve.bend)
    origin, b, n = walked[anchor].after(0.5)
    dimensions = np.array([[cone.radius, cone.half_angle, cone.sweep] for cone in walked])
    return Cones(origin, np.stack([b, cross(n, b), n], axis=-1), anchor, dimensions)


@dataclass(frozen=True, slots=True)
class _Cone:
    """A cone from its first ruling on, with a point on it, the way b of the walk there and the normal n."""

    point: Array
    b: Array
    n: Array
    radius: float
    half_angle: float
    sweep: float

    def after(self, share: float) -> tuple[Array, Array, Array]:
        """Point, b and n after a share of the sweep. What is carried round the axis keeps its normal radius."""
        axis = np.cos(self.half_angle) * cross(self.n, self.b) - np.sin(self.half_angle) * self.n
        centre, angle = self.point - self.radius * self.n, np.asarray(share * self.sweep)
        b, n = (unit(rotate_about(axis, angle, one)) for one in (self.b, self.n))
        return centre + self.radius * n, b, n


def _walked(planes: Array, way: Array, point: Array, bend: int) -> list[_Cone]:
    """The cones from plane to plane; `way` (3,) is how the normal turns at the first, `point` lies on its ruling.

    With e = n1 - n0 and t along the ruling, the axis a = cos g t - sin g n0 has a . e = 0. Points on it are as far from
    all tangent planes: n1 . (p - r n0) + d1 = -r.
    """
    cones: list[_Cone] = []
    b, n = bend * way, planes[0, :3]
    for far in planes[1:]:
        step = far[:3] - n
        square = float(step @ step)
        half_angle = float(np.arctan(-2.0 * (cross(n, b) @ step) / square))
        turn = 2.0 * float(np.arcsin(min(0.5 * float(np.sqrt(square)) / np.cos(half_angle), 1.0)))
        cones.append(_Cone(point, b, n, -2.0 * float(far[:3] @ point + far[3]) / square, half_angle, bend * turn))
        point, b, n = cones[-1].after(1.0)
    return cones
