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
_TINY = np.finfo(float).tiny


# Rows of a table of surfaces: axis and a point on it (of planes a point of theirs), the normal of the ruling, what the
# axis tilts against; the normal radius r, s cos(g), sin(g), s sin(g) and cos(g).
_AXIS, _CENTRE, _NORMAL, _TILT = (slice(row, row + 3) for row in (0, 3, 6, 9))
_RADIUS, _SIGNED_COSINE, _SINE, _SIGNED_SINE, _COSINE = range(12, 17)


def skin_rows(p: Array, t: Array, n: Array, radius: Array, half_angle: Array) -> Array:
    """A table (17, ...) of planes and cones: what `Skins` asks of each, worked out once for all points over it.

    Args:
        p: (3, ...) points of the rulings that they are measured at.
        t: (3, ...) their directions.
        n: (3, ...) the skin's normals there.
        radius: (...) normal radii of cones, 0 of planes.
        half_angle: (...) of cones, 0 of planes.
    """
    cosine, sine, sign = np.cos(half_angle), np.sin(half_angle), np.sign(radius)
    rows = np.empty((17, *radius.shape))
    rows[_AXIS], rows[_CENTRE] = cosine * t - sine * n, p - radius * n
    # The axis tilts by da = -(sin(g) t + cos(g) n) with the half angle; da is at right angles to a.
    rows[_NORMAL], rows[_TILT] = n, sine * t + cosine * n
    rows[_RADIUS], rows[_SIGNED_COSINE], rows[_SINE] = radius, sign * cosine, sine
    rows[_SIGNED_SINE], rows[_COSINE] = sign * sine, cosine
    return rows


@dataclass(frozen=True, slots=True)
class Skins:
    """Planes and cones that points lie over, one for each point or for several; vectors run along the first axis.

    Attributes:
        rows: (17, ...) see `skin_rows`.
        curved: (...) whether it is a cone; True or False for all of them.
    """

    rows: Array
    curved: BoolArray | bool

    @staticmethod
    def of_panels(p: Array, t: Array, n: Array, radius: Array, half_angle: Array) -> Skins:
        """A cone for each panel: p, t, n (panels, 3), radius and half angle (panels,)."""
        return Skins(skin_rows(p.T, t.T, n.T, radius, half_angle)[:, :, None], curved=True)

    def distance(self, x: Array) -> Array:
        """(...) signed distances of points x (3, ...)."""
        if self.curved is True:
            return self._apart(*self._parts(x)[1:])
        distance = inner_product(x - self.rows[_CENTRE], self.rows[_NORMAL])
        if self.curved is not False:
            index, cones = self._cones()
            distance.reshape(-1)[index] = cones.distance(_at(x, index))
        return distance

    def distance_inner(self, x: Array) -> tuple[Array, Array]:
        """The same, and (8, ...) the derivatives by the twist of the ruling, the radius and the half angle."""
        inner, rows = np.zeros((INNER, *x.shape[1:])), self.rows
        if self.curved is True:
            radial, rho, z = self._parts(x)
            inverse = rows[_SIGNED_COSINE] / np.maximum(rho, _TINY)
            normal = inverse * radial - rows[_SINE] * rows[_AXIS]
            inner[6] = inner_product(normal, rows[_NORMAL]) - 1.0
            outward = (inverse * z + rows[_SINE]) * inner_product(radial, rows[_TILT])
            inner[7] = outward - rows[_SIGNED_SINE] * rho - rows[_COSINE] * z
            return self._apart(rho, z), _by_twist(inner, x, normal)
        distance = inner_product(x - rows[_CENTRE], rows[_NORMAL])
        _by_twist(inner, x, rows[_NORMAL])
        if self.curved is not False:
            index, cones = self._cones()
            distance.reshape(-1)[index], inner.reshape(INNER, -1)[:, index] = cones.distance_inner(_at(x, index))
        return distance, inner

    def normals(self, x: Array) -> Array:
        """(3, ...) unit normals under points x (3, ...), on the side of n."""
        rows = self.rows
        if self.curved is True:
            radial, rho, _ = self._parts(x)
            return np.asarray(rows[_SIGNED_COSINE] / np.maximum(rho, _TINY) * radial - rows[_SINE] * rows[_AXIS])
        normals = np.broadcast_to(rows[_NORMAL], x.shape).copy()
        if self.curved is not False:
            index, cones = self._cones()
            normals.reshape(3, -1)[:, index] = cones.normals(_at(x, index))
        return normals

    def _cones(self) -> tuple[IntArray, Skins]:
        """Which of the surfaces of points, counted one by one, are cones; and these."""
        index = np.flatnonzero(self.curved)
        return index, Skins(_at(self.rows, index), curved=True)

    def _parts(self, x: Array) -> tuple[Array, Array, Array]:
        """Of cones the way from the axis square to it (3, ...), and its length; how far along it."""
        axis, y = self.rows[_AXIS], x - self.rows[_CENTRE]
        z = inner_product(y, axis)
        radial = y - z * axis
        return radial, np.sqrt(inner_product(radial, radial)), z

    def _apart(self, rho: Array, z: Array) -> Array:
        rows = self.rows
        return np.asarray(rows[_SIGNED_COSINE] * rho - rows[_SINE] * z - rows[_RADIUS])


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


def cone_distance(x: Array, p: Array, t: Array, n: Array, radius: Array, half_angle: Array) -> Array:
    """Signed distance of x (3, panels, m) to cones; p, t, n (panels, 3), radius and half_angle (panels,)."""
    return Skins.of_panels(p, t, n, radius, half_angle).distance(x)


def beyond(x: Array, p: Array, b: Array) -> BoolArray:
    """Whether x (3, panels, m) lies on the +b side of rulings; p, b (panels, 3). Returns booleans (panels, m).

    The plane spanned by a ruling and the skin's normal there is where the nearest patch changes from one to the next.
    """
    return plane_distance(x, p, b) > 0.0
