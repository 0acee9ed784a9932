"""Signed distance to a plane or a cone of a ruling, smooth through half angle 0, with exact derivatives.

With the axis through c = p - r n along a = cos(g) t - sin(g) n, y = x - c, z = y . a and rho = |y - z a|:
    d = s rho cos(g) - z sin(g) - r,    s = sign(r),
positive on the side of n. The gradient by x is the cone's unit normal e = s cos(g) e_rho - sin(g) a. When the cone is
moved by a twist (omega, v) the distance changes by -(e . v + (x x e) . omega).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array, BoolArray, IntArray

# The eight numbers that a patch's distance depends on: the twist of its ruling (6), normal radius, half angle.
INNER = 8


@dataclass(frozen=True, slots=True)
class Skins:
    """Planes and cones that points lie over, one for each point or for several; vectors run along the first axis.

    Attributes:
        t, n, p: (3, ...) the rulings that they are measured at.
        radius, half_angle: (...) of cones.
        curved: (...) whether it is a cone; True or False for all of them.
    """

    t: Array
    n: Array
    p: Array
    radius: Array
    half_angle: Array
    curved: BoolArray | bool

    @staticmethod
    def of_rows(rows: Array, curved: BoolArray | bool) -> Skins:
        """Those with the numbers t, n, p, radius and half angle (11, ...)."""
        return Skins(rows[:3], rows[3:6], rows[6:9], rows[9], rows[10], curved)

    @staticmethod
    def of_panels(p: Array, t: Array, n: Array, radius: Array, half_angle: Array) -> Skins:
        """A cone for each panel: p, t, n (panels, 3), radius and half angle (panels,)."""
        t, n, p = (axis.T[:, :, None] for axis in (t, n, p))
        return Skins(t, n, p, radius[:, None], half_angle[:, None], curved=True)

    def distance(self, x: Array) -> Array:
        """(...) signed distances of points x (3, ...)."""
        if self.curved is True:
            return self._apart(*self._parts(x)[2:])
        distance = inner_product(x - self.p, self.n)
        if self.curved is not False:
            index, cones = self._cones()
            distance.reshape(-1)[index] = cones.distance(_at(x, index))
        return distance

    def distance_inner(self, x: Array) -> tuple[Array, Array]:
        """The same, and (8, ...) the derivatives by the twist of the ruling, the radius and the half angle."""
        inner = np.zeros((INNER, *x.shape[1:]))
        if self.curved is True:
            axis, radial, rho, z = self._parts(x)
            sign, cosine, sine = np.sign(self.radius), np.cos(self.half_angle), np.sin(self.half_angle)
            inverse = sign * cosine / np.maximum(rho, np.finfo(float).tiny)
            normal = inverse * radial - sine * axis
            # The axis tilts by da = -(sin(g) t + cos(g) n); da is at right angles to a.
            outward = -inner_product(radial, sine * self.t + cosine * self.n)
            inner[6] = inner_product(normal, self.n) - 1.0
            inner[7] = -sign * rho * sine - z * cosine - (inverse * z + sine) * outward
            return self._apart(rho, z), _by_twist(inner, x, normal)
        distance = inner_product(x - self.p, self.n)
        _by_twist(inner, x, self.n)
        if self.curved is not False:
            index, cones = self._cones()
            distance.reshape(-1)[index], inner.reshape(INNER, -1)[:, index] = cones.distance_inner(_at(x, index))
        return distance, inner

    def normals(self, x: Array) -> Array:
        """(3, ...) unit normals under points x (3, ...), on the side of n."""
        if self.curved is True:
            axis, radial, rho, _ = self._parts(x)
            scale = np.sign(self.radius) * np.cos(self.half_angle) / np.maximum(rho, np.finfo(float).tiny)
            return np.asarray(scale * radial - np.sin(self.half_angle) * axis)
        normals = np.broadcast_to(self.n, x.shape).copy()
        if self.curved is not False:
            index, cones = self._cones()
            normals.reshape(3, -1)[:, index] = cones.normals(_at(x, index))
        return normals

    def _cones(self) -> tuple[IntArray, Skins]:
        """Which of the surfaces of points, counted one by one, are cones; and these."""
        index = np.flatnonzero(self.curved)
        t, n, p = (_at(axis, index) for axis in (self.t, self.n, self.p))
        radius, half_angle = (np.take(numbers, index) for numbers in (self.radius, self.half_angle))
        return index, Skins(t, n, p, radius, half_angle, curved=True)

    def _parts(self, x: Array) -> tuple[Array, Array, Array, Array]:
        """Of cones the axis (3, ...); the way from there square to it (3, ...) and its length; how far along it."""
        axis = np.cos(self.half_angle) * self.t - np.sin(self.half_angle) * self.n
        y = x - (self.p - self.radius * self.n)
        z = inner_product(y, axis)
        radial = y - z * axis
        return axis, radial, np.sqrt(inner_product(radial, radial)), z

    def _apart(self, rho: Array, z: Array) -> Array:
        away = np.sign(self.radius) * rho * np.cos(self.half_angle) - z * np.sin(self.half_angle)
        return np.asarray(away - self.radius)


def _at(values: Array, index: IntArray) -> Array:
    """Columns (rows, chosen) of values (rows, ...), their other axes counted as one."""
    return np.take(values.reshape(len(values), -1), index, axis=1)


def _by_twist(inner: Array, x: Array, normal: Array) -> Array:
    """Derivatives (8, ...) by twists filled in: -(x cross e), -e."""
    (x0, x1, x2), (e0, e1, e2) = x, normal
    inner[0], inner[1], inner[2] = e1 * x2 - e2 * x1, e2 * x0 - e0 * x2, e0 * x1 - e1 * x0
    np.negative(normal, out=inner[3:6])
    return inner


def inner_product(first: Array, second: Array) -> Array:
    """(...) of vectors (3, ...)."""
    product: Array = first[0] * second[0] + first[1] * second[1] + first[2] * second[2]
    return product


def plane_distance(x: Array, p: Array, n: Array) -> Array:
    """Signed distance of x (3, panels, m) to the planes through p with normals n, both (panels, 3)."""
    return inner_product(x - p.T[:, :, None], n.T[:, :, None])


def plane_inner(x: Array, n: Array) -> Array:
    """(panels, m, 8) derivative of `plane_distance` by the plane's twist; the last two numbers do not matter."""
    return np.moveaxis(_by_twist(np.zeros((INNER, *x.shape[1:])), x, n.T[:, :, None]), 0, 2)


def cone_distance(x: Array, p: Array, t: Array, n: Array, radius: Array, half_angle: Array) -> Array:
    """Signed distance of x (3, panels, m) to cones; p, t, n (panels, 3), radius and half_angle (panels,)."""
    return Skins.of_panels(p, t, n, radius, half_angle).distance(x)


def cone_distance_inner(
    x: Array, p: Array, t: Array, n: Array, radius: Array, half_angle: Array
) -> tuple[Array, Array]:
    """As `cone_distance`, and its derivative (panels, m, 8) by the ruling's twist, the radius and the half angle."""
    distance, inner = Skins.of_panels(p, t, n, radius, half_angle).distance_inner(x)
    return distance, np.moveaxis(inner, 0, 2)


def cone_normal(x: Array, p: Array, t: Array, n: Array, radius: Array, half_angle: Array) -> Array:
    """(panels, m, 3) unit normals of the cones under x (3, panels, m), on the side of n."""
    return np.moveaxis(Skins.of_panels(p, t, n, radius, half_angle).normals(x), 0, 2)


def beyond(x: Array, p: Array, b: Array) -> BoolArray:
    """Whether x (3, panels, m) lies on the +b side of rulings; p, b (panels, 3). Returns booleans (panels, m).

    The plane spanned by a ruling and the skin's normal there is where the nearest patch changes from one to the next.
    """
    return plane_distance(x, p, b) > 0.0
