"""Signed distance to a plane or a cone of a ruling, smooth through half angle 0, with exact derivatives.

With the axis through c = p - r n along a = cos(g) t - sin(g) n, y = x - c, z = y . a and rho = |y - z a|:
    d = s rho cos(g) - z sin(g) - r,    s = sign(r),
positive on the side of n. The gradient by x is the cone's unit normal e = s cos(g) e_rho - sin(g) a. When the cone is
moved by a twist (omega, v) the distance changes by -(e . v + (x x e) . omega).
"""

from __future__ import annotations

import numpy as np

from cadpanel.arrays import Array, BoolArray

# The eight numbers that a patch's distance depends on: the twist of its ruling (6), normal radius, half angle.
INNER = 8


def plane_distance(x: Array, p: Array, n: Array) -> Array:
    """Signed distance of x (3, panels, m) to the planes through p with normals n, both (panels, 3)."""
    px, py, pz = (p[:, i, None] for i in range(3))
    nx, ny, nz = (n[:, i, None] for i in range(3))
    distance: Array = (x[0] - px) * nx + (x[1] - py) * ny + (x[2] - pz) * nz
    return distance


def plane_inner(x: Array, n: Array) -> Array:
    """(panels, m, 8) derivative of `plane_distance` by the plane's twist; the last two numbers do not matter."""
    nx, ny, nz = (np.broadcast_to(n[:, i, None], x.shape[1:]) for i in range(3))
    return _inner(x, nx, ny, nz, 0.0, 0.0)


def cone_distance(x: Array, p: Array, t: Array, n: Array, radius: Array, half_angle: Array) -> Array:
    """Signed distance of x (3, panels, m) to cones; p, t, n (panels, 3), radius and half_angle (panels,)."""
    _, _, rho, z = _cone_parts(x, p, t, n, radius, half_angle)
    return _distance(rho, z, radius, half_angle)


def cone_distance_inner(
    x: Array, p: Array, t: Array, n: Array, radius: Array, half_angle: Array
) -> tuple[Array, Array]:
    """As `cone_distance`, and its derivative (panels, m, 8) by the ruling's twist, the radius and the half angle."""
    axis, radial, rho, z = _cone_parts(x, p, t, n, radius, half_angle)
    sign, cosine, sine = np.sign(radius)[:, None], np.cos(half_angle)[:, None], np.sin(half_angle)[:, None]
    inverse = sign * cosine / np.maximum(rho, np.finfo(float).tiny)
    ex, ey, ez = (inverse * radial[i] - sine * axis[:, i, None] for i in range(3))
    by_radius = ex * n[:, 0, None] + ey * n[:, 1, None] + ez * n[:, 2, None] - 1.0
    # The axis tilts by da = -(sin(g) t + cos(g) n); da is at right angles to a.
    tilt = -(np.sin(half_angle)[:, None] * t + np.cos(half_angle)[:, None] * n)
    outward = sum(radial[i] * tilt[:, i, None] for i in range(3))
    by_angle = -sign * rho * sine - z * cosine - inverse * z * outward - sine * outward
    return _distance(rho, z, radius, half_angle), _inner(x, ex, ey, ez, by_radius, by_angle)


def cone_normal(x: Array, p: Array, t: Array, n: Array, radius: Array, half_angle: Array) -> Array:
    """(panels, m, 3) unit normals of the cones under x (3, panels, m), on the side of n."""
    axis, radial, rho, _ = _cone_parts(x, p, t, n, radius, half_angle)
    scale = (np.sign(radius) * np.cos(half_angle))[:, None] / np.maximum(rho, np.finfo(float).tiny)
    sine = np.sin(half_angle)[:, None]
    return np.stack([scale * radial[i] - sine * axis[:, i, None] for i in range(3)], axis=-1)


def _cone_parts(
    x: Array, p: Array, t: Array, n: Array, radius: Array, half_angle: Array
) -> tuple[Array, list[Array], Array, Array]:
    axis = np.cos(half_angle)[:, None] * t - np.sin(half_angle)[:, None] * n
    centre = p - radius[:, None] * n
    y = [x[i] - centre[:, i, None] for i in range(3)]
    z = sum(y[i] * axis[:, i, None] for i in range(3))
    radial = [y[i] - z * axis[:, i, None] for i in range(3)]
    rho = np.sqrt(radial[0] ** 2 + radial[1] ** 2 + radial[2] ** 2)
    return axis, radial, rho, np.asarray(z)


def _distance(rho: Array, z: Array, radius: Array, half_angle: Array) -> Array:
    cosine, sine = np.cos(half_angle)[:, None], np.sin(half_angle)[:, None]
    return np.sign(radius)[:, None] * rho * cosine - z * sine - radius[:, None]


def _inner(x: Array, ex: Array, ey: Array, ez: Array, by_radius: Array | float, by_angle: Array | float) -> Array:
    inner = np.empty((*x.shape[1:], INNER))
    inner[..., 0] = ey * x[2] - ez * x[1]
    inner[..., 1] = ez * x[0] - ex * x[2]
    inner[..., 2] = ex * x[1] - ey * x[0]
    inner[..., 3], inner[..., 4], inner[..., 5] = -ex, -ey, -ez
    inner[..., 6], inner[..., 7] = by_radius, by_angle
    return inner


def beyond(x: Array, p: Array, b: Array) -> BoolArray:
    """Whether x (3, panels, m) lies on the +b side of rulings; p, b (panels, 3). Returns booleans (panels, m).

    The plane spanned by a ruling and the skin's normal there is where the nearest patch changes from one to the next.
    """
    return plane_distance(x, p, b) > 0.0
