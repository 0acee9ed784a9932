"""Walls square to the sheet, as a laser cuts them flat, inside of those that stand in the planes of the joints.

A wall that leans has a longer and a shorter face. The square one stands where the shorter face ends, so that the sheet
reaches nowhere beyond the leaning wall. Along an end that bends the lean changes: there the skin's edge keeps to a
plane, parallel to the old one and set back by what the longest place of the other face asks for. Millimetres, radians.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TypeVar

import numpy as np

from cadpanel.arrays import Array
from cadpanel.errors import PanelError
from cadpanel.geometry.chain_cutting import side_in_plane
from cadpanel.geometry.end_leans import leans
from cadpanel.geometry.leaning_sides import parallel_walk
from cadpanel.geometry.limits import SMALLEST_LENGTH
from cadpanel.geometry.panel import Chain, CutPlane, Outlined
from cadpanel.geometry.patches import ConePatch
from cadpanel.geometry.plane_sides import end_spans, side_curve
from cadpanel.geometry.vectors import cross, dot, unit

SomeChain = TypeVar("SomeChain", bound=Chain)
_ROUNDS = 8
NEARLY_STRAIGHT = 0.05
"""Radians by which an outline must turn at a corner for its two walls to meet in a line of their own."""


def square_chain(shape: SomeChain, depth: float) -> SomeChain:
    """A chain whose ends and sides stand square to the sheet, whose other face is at `depth`.

    Along a side in a plane the lean changes, too: its edge keeps to a parallel plane, as those of ends do.
    """
    for side, plane in enumerate(shape.side_planes):
        if plane is not None:
            shape = side_in_plane(shape, side, _set_back(shape, side, plane, depth), 0.0)
    cut_points = shape.cut_points.copy()
    shorter = np.where(np.array([-1.0, 1.0]) * depth * shape.side_leans < 0.0, shape.side_leans, 0.0)
    far = parallel_walk((shape.points, shape.normals, shape.binormals()), shape.patches, shorter, depth)
    patches = tuple(
        replace(patch, sweep=other.sweep) if isinstance(patch, ConePatch) and isinstance(other, ConePatch) else patch
        for patch, other in zip(shape.patches, far.patches, strict=True)
    )
    moved = shape.rewalked(far.points - depth * far.normals, shape.directions, far.normals, patches)
    rulings = moved.points, moved.directions, moved.normals
    spans = end_spans(moved)
    for end, outward in ((0, -1.0), (1, 1.0)):
        way_out = outward * shape.cut_normals[end]
        back = max(0.0, *(depth * lean for lean in leans(rulings, patches, way_out, spans[end])))
        cut_points[end] -= back * way_out
    return moved.trimmed(cut_points, shape.cut_normals, np.zeros(2)).made_square()


def _set_back(shape: Chain, side: int, plane: CutPlane, depth: float) -> CutPlane:
    """The plane that a side's edge keeps to, so that the other face, along the normals, ends behind the given one.

    Farther back the normals lean a little otherwise; each round is nearer to that by a part of `depth` by the radius.
    """
    back = 0.0
    for _ in range(_ROUNDS):
        curve = side_curve(shape.walled(side, plane.moved(-back)), side)
        assert curve is not None
        back = max(0.0, *(depth * (curve.frame.normals(curve.corners) @ plane.normal)).tolist())
    return plane.moved(-back)


def square_polygon(shape: Outlined, posts: Array | None, depth: float) -> Array:
    """(n, 3) the corners of a polygon whose walls stand square to the sheet, whose other face is at `depth`.

    Args:
        shape: the polygon.
        posts: (n, 3) by how much its corners move for one mm of height so far; None if not at all.
        depth: mm.

    Raises:
        PanelError: an edge is gone.
    """
    corners, normal = shape.outline, shape.normal
    if posts is None:
        return corners
    spans = np.roll(corners, -1, axis=0) - corners
    outs = unit(cross(spans, normal[None]))
    # A wall leans alike at both its corners; a hair of rounding is no lean.
    back = np.minimum(0.0, depth * 0.5 * (dot(posts, outs) + dot(np.roll(posts, -1, axis=0), outs)))
    moved = corners.copy()
    for i in range(len(corners)):
        before, after = outs[i - 1], outs[i]
        if float(before @ after) > np.cos(NEARLY_STRAIGHT):
            moved[i] += min(back[i - 1], back[i]) * unit(before + after)
            continue
        system = np.stack([before, after])
        moved[i] += system.T @ np.linalg.solve(system @ system.T, [back[i - 1], back[i]])
    lengths = dot(np.roll(moved, -1, axis=0) - moved, unit(spans))
    shortest = int(lengths.argmin())
    if lengths[shortest] < SMALLEST_LENGTH:
        left = max(float(lengths[shortest]), 0.0)
        raise PanelError(shape.name, f"only {left:.3g} mm of edge {shortest} are left, {SMALLEST_LENGTH:g} are needed")
    return moved
