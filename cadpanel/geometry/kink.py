"""Angles between the normals of planes, cones and cylinders along the straight edges that they share. Radians."""

from __future__ import annotations

import numpy as np

from cadpanel.arrays import Array
from cadpanel.geometry.vectors import cross, dot

EDGE_POINTS = 5
"""Points along an edge, its ends included, at which the normals are compared."""


def edge_angles(edges: Array, surfaces: Array) -> Array:
    """(m,) greatest angle between the two surfaces' normals along each of m straight edges.

    Arguments:
        edges: (m, 2, 3) their ends, mm.
        surfaces: (m, 2, 9) origin, axis (a plane's normal), radius (0 for a plane), half angle, side (+1 or -1).
    """
    fractions = np.linspace(0.0, 1.0, EDGE_POINTS)[:, None]
    points = edges[:, None, 0] + fractions * (edges[:, 1] - edges[:, 0])[:, None, :]
    first, second = (surface_normals(points, surfaces[:, None, side]) for side in range(2))
    angles = np.arctan2(np.linalg.norm(cross(first, second), axis=-1), dot(first, second))
    return np.asarray(angles.max(axis=-1)) if len(edges) else np.zeros(0)


def surface_normals(points: Array, surfaces: Array) -> Array:
    """(..., 3) unit normals at points (..., 3) of surfaces (..., 9), see `edge_angles`; never through the apex."""
    origin, axis = surfaces[..., 0:3], surfaces[..., 3:6]
    radius, half_angle, side = surfaces[..., 6], surfaces[..., 7, None], surfaces[..., 8, None]
    offset = points - origin
    radial = offset - dot(offset, axis)[..., None] * axis
    length = np.linalg.norm(radial, axis=-1, keepdims=True)
    radial = radial / np.where(length > 0.0, length, 1.0)
    round_normal = np.cos(half_angle) * radial - np.sin(half_angle) * axis
    return np.asarray(side * np.where((radius > 0.0)[..., None], round_normal, axis))
