"""Sides of parallel skins under a wall that leans: of flat patches, and of cylinders. Millimetres and radians.

A plane along a cylinder's axis meets the cylinder and every parallel one in rulings, so the wall at a cylinder's side
may lean as that at a flat patch does: only the angle at which it leaves the skin changes on the way. A plane that meets
two parallel cones in a ruling each goes through both of their apexes and stands square to the sheet.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from cadpanel.arrays import Array
from cadpanel.geometry.patches import ConePatch, Patch


@dataclass(frozen=True, slots=True, kw_only=True)
class ParallelWalk:
    """Rulings (points and normals, (k + 1, 3)), patches and leans (2,) of a parallel skin; see `PanelShape`."""

    points: Array
    normals: Array
    patches: tuple[Patch, ...]
    leans: Array


def may_lean(patch: Patch) -> bool:
    """Whether the wall along a ruling of this patch may lean and be a plane that ends in a ruling on either face."""
    return not isinstance(patch, ConePatch) or patch.half_angle == 0.0


def risen(radius: float, leans: Array, depths: Array) -> Array:
    """(m,) how far along n a wall is where it has come to the skin at `depths`; not a number where it comes to none.

    It starts on a cylinder of `radius` and leans by (m,) `leans` along b for one mm along n. With h the rise, its
    distance from the axis is that of the parallel skin: (radius + h)^2 + (h lean)^2 = (radius + depth)^2.
    """
    more = depths * (2.0 * radius + depths)
    under = radius * radius + (1.0 + leans * leans) * more
    root = np.sqrt(np.where(under >= 0.0, under, np.nan))
    return np.asarray(more / (radius + np.copysign(root, radius)))


def parallel_walk(
    rulings: tuple[Array, Array, Array], patches: Sequence[Patch], leans: Array, distance: float
) -> ParallelWalk:
    """The walk over the skin at `distance` mm along n, its sides under the walls of this one.

    Args:
        rulings: points, normals and binormals b of the rulings, (k + 1, 3) each.
        patches: the k patches.
        leans: (2,) by how much the walls at the sides lean along b for one mm along n; 0 at cones.
        distance: mm.
    """
    points, normals, binormals = rulings
    ways = normals.copy()
    ways[[0, -1]] += leans[:, None] * binormals[[0, -1]]
    moved, turned, kept = points + distance * ways, normals.copy(), leans.copy()
    offset = [
        replace(patch, radius=patch.radius + distance) if isinstance(patch, ConePatch) else patch for patch in patches
    ]
    for side in (0, 1):
        patch, lean = patches[-side], float(leans[side])
        if lean == 0.0 or not isinstance(patch, ConePatch):
            continue
        rise = float(risen(patch.radius, np.array([lean]), np.array([distance]))[0])
        turn = math.atan(rise * lean / (patch.radius + rise))  # a wall is left before it has turned by a quarter
        normal, binormal = normals[-side], binormals[-side]
        moved[-side] = points[-side] + rise * ways[-side]
        turned[-side] = np.cos(turn) * normal + np.sin(turn) * binormal
        kept[side] = np.tan(np.arctan(lean) - turn)
        own = offset[-side]
        assert isinstance(own, ConePatch)
        offset[-side] = replace(own, sweep=own.sweep + (turn if side else -turn))
    return ParallelWalk(points=moved, normals=turned, patches=tuple(offset), leans=kept)
