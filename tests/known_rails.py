"""Rails on surfaces that are known, and rails that are on none."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import make_interp_spline

SLOPE, RADIUS = 200.0, 300.0


def curve(at, first, last, count=161):
    t = np.linspace(first, last, count)
    return make_interp_spline(t, at(t), k=5)


def on_cone(height):
    """On the cone of apex (0, 0, 500) and radius 100 at z = 0."""

    def at(t):
        z = height(t)
        radius = 100.0 * (1.0 - z / 500.0)
        return np.stack([radius * np.cos(t), radius * np.sin(t), z], axis=-1)

    return at


def on_cylinder(height):
    return lambda t: np.stack([100.0 * np.cos(t), 100.0 * np.sin(t), height(t)], axis=-1)


def helix(t):
    return np.stack([RADIUS * np.cos(t), RADIUS * np.sin(t), SLOPE * t], axis=-1)


def helix_way(t):
    way = np.stack([-RADIUS * np.sin(t), RADIUS * np.cos(t), SLOPE + 0.0 * t], axis=-1)
    return way / np.hypot(RADIUS, SLOPE)


def on_tangents(reach):
    """On the tangents of a helix."""
    return lambda t: helix(t) + reach(t)[:, None] * helix_way(t)


CONE = (on_cone(lambda t: 10.0 * np.cos(2.0 * t)), on_cone(lambda t: 200.0 + 20.0 * np.sin(3.0 * t)))
CYLINDER = (on_cylinder(lambda t: 30.0 * np.sin(2.0 * t)), on_cylinder(lambda t: 200.0 + 20.0 * np.cos(3.0 * t)))
TORSE = (
    on_tangents(lambda t: 200.0 + 30.0 * np.sin(2.0 * t)),
    on_tangents(lambda t: 600.0 + 50.0 * np.cos(3.0 * t)),
)
PLANE = (
    lambda t: np.stack([100.0 * t, 50.0 * t**2, 0.0 * t], axis=-1),
    lambda t: np.stack([100.0 * t, 400.0 + 30.0 * np.sin(t), 0.0 * t], axis=-1),
)
TWISTED = (
    lambda t: np.stack([1000.0 * t, 50.0 * t**2, 20.0 * np.cos(3.0 * t)], axis=-1),
    lambda t: np.stack([1000.0 * t, 300.0 + 40.0 * t**2, 100.0 + 30.0 * np.cos(3.0 * t + 0.3)], axis=-1),
)


def rails(known, first=(0.0, 1.5), second=(0.0, 1.5)):
    return curve(known[0], *first), curve(known[1], *second)


def off_torse(points):
    """How far points lie off the tangent surface of the helix, mm: the helix's tangent nearest to each, by Newton."""
    # About the axis, a tangent's point has the distance hypot(R, reach R / c): so the reach, and with it the turn.
    c = np.hypot(RADIUS, SLOPE)
    reach = np.sqrt(np.maximum((points[:, :2] ** 2).sum(axis=1) - RADIUS**2, 0.0)) * c / RADIUS
    t = np.unwrap(np.arctan2(points[:, 1], points[:, 0])) - np.arctan2(reach / c, 1.0)
    found = helix(t) + reach[:, None] * helix_way(t)
    return np.abs(found[:, 2] - points[:, 2])


def torse_samples(first=0.2, last=1.0, count=40):
    """Points, normals and weights on the tangent surface of the helix, and the way of its middle ruling."""
    t, reach = (grid.ravel() for grid in np.meshgrid(np.linspace(first, last, count), np.linspace(200.0, 600.0, 9)))
    way = helix_way(t)
    inwards = np.stack([-np.cos(t), -np.sin(t), 0.0 * t], axis=-1)
    normals = np.cross(way, inwards)
    normals = normals / np.linalg.norm(normals, axis=-1)[:, None]
    return helix(t) + reach[:, None] * way, normals, reach, helix_way(np.array([0.5 * (first + last)]))[0]


def cone_samples(slope=0.2, first=-0.6, last=0.8, count=40):
    """The same on the cone of apex (0, 0, 100 / slope) and radius 100 at z = 0; a cylinder where the slope is 0."""
    u, z = (grid.ravel() for grid in np.meshgrid(np.linspace(first, last, count), np.linspace(0.0, 300.0, 9)))
    radius = 100.0 - slope * z
    out = np.stack([np.cos(u), np.sin(u), 0.0 * u], axis=-1)
    normals = (out + np.array([0.0, 0.0, slope])) / np.hypot(1.0, slope)
    points = radius[:, None] * out + z[:, None] * np.array([0.0, 0.0, 1.0])
    return points, normals, radius, np.array([0.0, 0.0, 1.0])
