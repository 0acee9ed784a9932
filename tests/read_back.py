"""Panels rebuilt from the numbers of a report alone: corners, and planes, cones and cylinders as records hold them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cadpanel.arrays import Array
from cadpanel.delivery.records.patches import ConePatchModel, CylinderPatchModel, PatchModel, PlanePatchModel
from cadpanel.geometry.panel import Panel
from cadpanel.geometry.patches import ConePatch, Patch, PlanePatch
from cadpanel.geometry.shape import PanelShape, PolygonShape


def rebuilt(name: str, feature: str, rows: Sequence[Sequence[Sequence[float]]], patches: Sequence[PatchModel]) -> Panel:
    """The panel with these corners [end][ruling], or [0][corner] of a polygon, and these patches.

    A single cone has two corners an end, which do not tell how its end leans: of chains with curved patches it takes
    three rulings or more, and a flat flange to tell the outside.
    """
    corners = np.array(rows)
    if len(corners) == 1:
        assert isinstance(patches[0], PlanePatchModel)
        return PolygonShape(name=name, feature=feature, outline=corners[0], normal=np.array(patches[0].normal))
    points = corners[0]
    directions = _unit(corners[1] - points)
    normals = np.array([_normal(patches, ruling, points, directions) for ruling in range(len(points))])
    found = [_patch(patch, points[i], directions[i], normals[i]) for i, patch in enumerate(patches)]
    return PanelShape(
        name=name,
        feature=feature,
        points=points,
        directions=directions,
        normals=normals,
        patches=tuple(found),
        cut_points=corners[:, 0],
        cut_normals=np.array([_end_normal(end, directions[0]) for end in corners]),
    )


def _normal(patches: Sequence[PatchModel], ruling: int, points: Array, directions: Array) -> Array:
    """That of the flange at the ruling; between two curved patches square on the ruling and away from the axis."""
    beside = [patches[i] for i in (ruling - 1, ruling) if 0 <= i < len(patches)]
    for patch in beside:
        if isinstance(patch, PlanePatchModel):
            return np.array(patch.normal)
    curved = beside[-1]
    assert not isinstance(curved, PlanePatchModel)
    out = _from_axis(curved, points[ruling])[1]
    t = directions[ruling]
    normal: Array = _unit(out - (out @ t) * t)
    ways = [points[i + 1] - points[i] for i in (ruling - 1, ruling) if 0 <= i < len(points) - 1]
    # The walk goes towards t x n.
    return np.asarray(normal * np.sign(np.cross(t, normal) @ np.sum(ways, axis=0)))


def _from_axis(patch: ConePatchModel | CylinderPatchModel, point: Array) -> tuple[Array, Array]:
    """The unit axis, and the way from it to the point."""
    axis = np.array(patch.axis)
    to = point - np.array(patch.apex if isinstance(patch, ConePatchModel) else patch.axis_point)
    return axis, to - (to @ axis) * axis


def _patch(patch: PatchModel, p: Array, t: Array, n: Array) -> Patch:
    if isinstance(patch, PlanePatchModel):
        return PlanePatch()
    axis, out = _from_axis(patch, p)
    along = np.sign(axis @ t)
    half_angle = (
        0.0 if isinstance(patch, CylinderPatchModel) else float(np.arctan2(-along * axis @ n, along * axis @ t))
    )
    return ConePatch(
        radius=float(out @ out / (out @ n)),
        half_angle=half_angle,
        sweep=float(along * np.radians(patch.sweep)),
        kind=patch.kind,
    )


def _end_normal(corners: Array, along: Array) -> Array:
    """The normal of the plane through an end's corners; of one that is straight, square on it and along the strip."""
    off = corners - corners.mean(axis=0)
    if len(corners) == 2:
        across = _unit(off[1])
        return np.asarray(_unit(along - (along @ across) * across))
    normal = np.linalg.svd(off)[2][2]
    return np.asarray(normal * np.sign(normal @ along))


def _unit(vectors: Array) -> Array:
    unit: Array = vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)
    return unit
