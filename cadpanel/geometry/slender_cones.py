"""Cones that are all but cylinders, made cylinders: programs downstream lose their volumes at half angles near 1e-6."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Protocol, TypeVar

import numpy as np

from cadpanel.arrays import Array
from cadpanel.geometry.cone_sections import axis_frame
from cadpanel.geometry.panel import Chain, Panel, Straightened
from cadpanel.geometry.patches import ConePatch


class ChainPanel(Chain, Panel, Protocol):
    """A panel that is a chain."""


StraightChain = TypeVar("StraightChain", bound=ChainPanel)
SMALLEST_HALF_ANGLE = 5e-6
"""Radians; a cone of this half angle differs from the cylinder by 0.01 mm on 4 m."""


def straighten(shape: StraightChain, smallest_half_angle: float) -> Straightened[StraightChain]:
    """Replace every cone with 0 < |half_angle| <= `smallest_half_angle` by the cylinder that it has halfway along.

    The rulings up to the patch stay where they are; the rest of the walk follows the cylinder as a rigid body.
    """
    tiny = tuple(
        index
        for index, patch in enumerate(shape.patches)
        if isinstance(patch, ConePatch) and 0.0 < abs(patch.half_angle) <= smallest_half_angle
    )
    straight = shape
    for index in tiny:
        straight = _straighten_patch(straight, index)
    move = np.linalg.norm(straight.corners() - shape.corners(), axis=-1).max() if tiny else 0.0
    return Straightened(shape=straight, patches=tiny, largest_move=float(move))


def _straighten_patch(shape: StraightChain, index: int) -> StraightChain:
    patch = shape.patches[index]
    assert isinstance(patch, ConePatch)
    direction, normal = shape.directions[index], shape.normals[index]
    middle = shape.pierced()[:, index].mean(axis=0)
    widened = float((middle - shape.points[index]) @ direction) * math.tan(patch.half_angle)
    cylinder = replace(patch, radius=patch.radius + widened, half_angle=0.0, kind="cylinder")
    before = _turn_about_axis(middle, direction, normal, replace(patch, radius=cylinder.radius))
    after = _turn_about_axis(middle, direction, normal, cylinder)
    rotation = after[1] @ before[1].T
    rest = slice(index + 1, None)
    points, directions, normals = shape.points.copy(), shape.directions.copy(), shape.normals.copy()
    points[index] = middle
    points[rest] = after[0] + (points[rest] - before[0]) @ rotation.T
    directions[rest] = directions[rest] @ rotation.T
    normals[rest] = normals[rest] @ rotation.T
    patches = (*shape.patches[:index], cylinder, *shape.patches[index + 1 :])
    return shape.rewalked(points, directions, normals, patches)


def _turn_about_axis(point: Array, direction: Array, normal: Array, patch: ConePatch) -> tuple[Array, Array]:
    """Where the patch carries `point`, and the (3, 3) rotation that it applies to directions."""
    frame = axis_frame(point, direction, normal, patch)
    basis = np.stack([frame.axis, frame.radial, frame.tangential], axis=1)
    cosine, sine = math.cos(patch.sweep), math.sin(patch.sweep)
    turn = np.array([[1.0, 0.0, 0.0], [0.0, cosine, -sine], [0.0, sine, cosine]])
    rotation = basis @ turn @ basis.T
    return frame.center + rotation @ (point - frame.center), rotation
