"""The points of panels' boundaries that rules hold: corners, and points on the arcs of their ends. Millimetres."""

from __future__ import annotations

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.features.layout import Layout
from cadpanel.features.panel_edges import ARC_SHARES
from cadpanel.geometry.panel import Chain, Panel
from cadpanel.geometry.patches import ConePatch
from cadpanel.geometry.vectors import cross


def boundary_of(shape: Panel) -> Array:
    """(q, 3) corners end by end or round a polygon, then arc points end by end, as `terms.state.State` orders them."""
    corners = np.asarray(shape.corners()).reshape(-1, 3)
    if not isinstance(shape, Chain):
        return corners
    inside = [
        _turned(shape.points[i], shape.directions[i], shape.normals[i], patch, share)
        for i, patch in enumerate(shape.patches)
        if isinstance(patch, ConePatch)
        for share in ARC_SHARES
    ]
    if not inside:
        return corners
    points, directions = (np.array(part) for part in zip(*inside, strict=True))
    height = np.einsum("erx,ex->er", shape.cut_points[:, None] - points[None], shape.cut_normals)
    along = height / np.einsum("rx,ex->er", directions, shape.cut_normals)
    return np.concatenate([corners, (points + along[..., None] * directions).reshape(-1, 3)])


def _turned(point: Array, direction: Array, normal: Array, patch: ConePatch, share: float) -> tuple[Array, Array]:
    """Point and direction of the ruling at a share of a patch's sweep, from its first ruling (Rodrigues' formula)."""
    axis = np.cos(patch.half_angle) * direction - np.sin(patch.half_angle) * normal
    angle = share * patch.sweep

    def turned(vector: Array) -> Array:
        around = np.sin(angle) * cross(axis, vector)
        return np.asarray(np.cos(angle) * vector + around + (1.0 - np.cos(angle)) * (axis @ vector) * axis)

    centre = point - patch.radius * normal
    return centre + turned(point - centre), turned(direction)


def places_in(layout: Layout, panel: int) -> IntArray:
    """(q,) where the points of one panel stand among all boundary points of `terms.state.State.boundary`."""
    feature = layout.feature_of[panel]
    padded = max(group.feature.corner_count for group in layout.groups)
    arcs = len(ARC_SHARES) * sum(feature.curved) * 2 if feature.four_sided else 0
    return np.concatenate([np.arange(feature.corner_count), padded + np.arange(arcs)])
