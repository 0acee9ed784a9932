"""Initial values of planar polygons: the plane through the samples, and the outline's corners in it."""

from __future__ import annotations

import numpy as np

from cadpanel.errors import PanelError
from cadpanel.features.polygon import Polygon
from cadpanel.fitting.start.frames import Frames, Given
from cadpanel.geometry.vectors import cross


def start_polygons(feature: Polygon, given: Given) -> Frames:
    """Frames and numbers (n, 3 + 2 corners) of panels with as many corners as their feature.

    Raises:
        PanelError: a panel has fewer or more.
    """
    panels, samples, length = given.panels, given.samples, given.length
    for panel in panels:
        if len(panel.edges) != feature.corner_count:
            raise PanelError(
                panel.name,
                f"it has {len(panel.edges)} corners in '{given.source}', and its feature '{feature.name}' "
                f"{feature.corner_count}: choose one with as many",
            )
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
