"""Initial values of planar polygons: the plane through the samples, and the outline's corners in it."""

from __future__ import annotations

import numpy as np

from cadpanel.features.polygon import Polygon
from cadpanel.fitting.start.frames import Frames, Given
from cadpanel.geometry.vectors import cross


def start_polygons(_feature: Polygon, given: Given) -> Frames:
    """Frames and numbers (n, 3 + 2 corners) of panels with equally many corners."""
    panels, samples, length = given.panels, given.samples, given.length
    weights = samples.weights / samples.weights.sum(axis=1, keepdims=True)
    origins = np.einsum("pm,pmx->px", weights, samples.points)
    off = samples.points - origins[:, None]
    _, directions = np.linalg.eigh(np.einsum("pm,pmx,pmy->pxy", weights, off, off))
    n = directions[:, :, 0]
    outward = np.einsum("pm,pmx->px", weights, samples.normals)
    n = n * np.where(np.einsum("px,px->p", n, outward) < 0.0, -1.0, 1.0)[:, None]
    corners = np.array([panel.corners for panel in panels])
    first = corners[:, 1] - corners[:, 0]
    b = first - np.einsum("px,px->p", first, n)[:, None] * n
    b = b / np.linalg.norm(b, axis=1, keepdims=True)
    axes = np.stack([b, cross(n, b), n], axis=-1)
    local = np.einsum("pcx,pxa->pca", corners - origins[:, None], axes) / length
    numbers = np.concatenate([np.zeros((len(panels), 3)), local[:, :, :2].reshape(len(panels), -1)], axis=1)
    return Frames(origins, axes, [numbers])
