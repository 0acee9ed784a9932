"""A chain whose walls stand in given planes: its ends by other cuts, its sides along other rulings.

A flat patch ends on any plane in a straight line, and so does the parallel patch on the sheet's other face: its wall
may lean as the plane does. So may the wall at the side of a cylinder, as far as the plane leans about the axis. A plane
that leans meets two parallel cones in no two rulings of theirs: along a ruling the side of a cone stands square to the
sheet. Either runs along the ruling from which it keeps behind the plane on both faces. Where there is a joint, and that
ruling would leave it wider somewhere, the side of a round patch stands in the plane itself instead.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np

from cadpanel.arrays import Array
from cadpanel.errors import PanelError
from cadpanel.geometry.cone_sections import AxisFrame, axis_frame, lifted
from cadpanel.geometry.leaning_sides import may_lean, risen
from cadpanel.geometry.panel import Chain, CutPlane
from cadpanel.geometry.patches import ConePatch
from cadpanel.geometry.plane_sides import curve_in_plane
from cadpanel.geometry.vectors import cross, unit

SomeChain = TypeVar("SomeChain", bound=Chain)
CLOSE_TURN = 1e-14
"""Share of a sweep at which the search for a ruling ends."""
MOST_STEPS = 40
FARTHEST_OUT = -0.25
"""Share of a sweep by which a side may be moved outwards, to where the panels meet."""
AS_WIDE = 0.01
"""By so much, mm, may a ruling leave a joint wider than the plane does."""


def cut_chain(shape: SomeChain, planes: Mapping[str, CutPlane], depth: float) -> SomeChain:
    """The chain with the walls of its sheet, whose other face is at `depth`, in planes named by its edges.

    Raises:
        PanelError: a plane misses its side.
    """
    cut = _with_ends(shape, planes)
    for side in range(2):
        plane = planes.get(f"side {side}")
        if plane is None:
            continue
        round_patch = isinstance(cut.patches[-side], ConePatch)
        cut = _beside_a_cone(cut, side, plane, depth) if round_patch else _leaning(cut, side, plane)
    return cut


def _beside_a_cone(shape: SomeChain, side: int, plane: CutPlane, depth: float) -> SomeChain:
    """The side of a round patch along a ruling, or in the plane where that leaves a joint wider than it should be."""
    ruled = _along_a_ruling(shape, side, plane, depth)
    if not plane.jointed:
        return ruled
    corners = [face.corners()[:, -side] for face in (ruled, ruled.offset(depth))]
    if max(float(-plane.beyond(of).min()) for of in corners) <= AS_WIDE:
        return ruled
    return side_in_plane(shape, side, plane, depth)


def side_in_plane(shape: SomeChain, side: int, plane: CutPlane, depth: float) -> SomeChain:
    """The side of a round patch in a plane, its ruling that through the outermost of its four corners.

    Raises:
        PanelError: the plane misses its side.
    """
    index = 0 if side == 0 else len(shape.patches) - 1
    patch = shape.patches[index]
    assert isinstance(patch, ConePatch)
    frame = axis_frame(shape.points[index], shape.directions[index], shape.normals[index], patch)
    faces = [curve_in_plane(shape, of, side, plane) for of in (frame, lifted(frame, depth))]
    shares = np.concatenate([curve.corners for curve in faces]) / patch.sweep
    share = _near_enough(shape, side, float((1.0 - shares).min() if side else shares.min()))
    return _cut_off(shape, frame, side, share).walled(side, plane)


def _with_ends(shape: SomeChain, planes: Mapping[str, CutPlane]) -> SomeChain:
    points, normals = shape.cut_points.copy(), shape.cut_normals.copy()
    for end, outward in ((0, -1.0), (1, 1.0)):
        plane = planes.get(f"end {end}")
        if plane is not None:
            points[end], normals[end] = plane.point, outward * plane.normal
    return shape.trimmed(points, normals, shape.side_leans)


def _leaning(shape: SomeChain, side: int, plane: CutPlane) -> SomeChain:
    """The side of a flat patch where the plane meets it."""
    normal = shape.normals[-side]
    within = plane.normal - (plane.normal @ normal) * normal
    points, directions = shape.points.copy(), shape.directions.copy()
    points[-side] -= plane.beyond(points[-side]) / (plane.normal @ within) * within
    along = unit(cross(normal, plane.normal))
    directions[-side] = math.copysign(1.0, along @ directions[-side]) * along
    leans = shape.side_leans.copy()
    leans[side] = -(plane.normal @ normal) / (plane.normal @ cross(directions[-side], normal))
    moved = shape.rewalked(points, directions, shape.normals, shape.patches)
    return moved.trimmed(shape.cut_points, shape.cut_normals, leans)


@dataclass(frozen=True, slots=True)
class _Ruling:
    """Rulings of a round patch at sweep angles: points, directions and normals (m, 3)."""

    points: Array
    directions: Array
    normals: Array


def _rulings(frame: AxisFrame, angles: Array) -> _Ruling:
    radials = frame.radials(angles)
    cosine, sine = math.cos(frame.half_angle), math.sin(frame.half_angle)
    return _Ruling(
        frame.center + frame.level_radius * radials,
        cosine * frame.axis + sine * radials,
        cosine * radials - sine * frame.axis,
    )


def _along_a_ruling(shape: SomeChain, side: int, plane: CutPlane, depth: float) -> SomeChain:
    """The side of a round patch along the ruling whose four corners, two on either face, keep behind the plane."""
    index = 0 if side == 0 else len(shape.patches) - 1
    patch = shape.patches[index]
    assert isinstance(patch, ConePatch)
    frame = axis_frame(shape.points[index], shape.directions[index], shape.normals[index], patch)
    share = _share_cut_off(shape, frame, side, plane, depth, leaning=may_lean(patch))
    moved = _cut_off(shape, frame, side, share)
    if not may_lean(patch):
        return moved
    leans = shape.side_leans.copy()
    leans[side] = _leans(moved.directions[[-side]], moved.normals[[-side]], plane)[0]
    return moved.trimmed(shape.cut_points, shape.cut_normals, leans)


def _cut_off(shape: SomeChain, frame: AxisFrame, side: int, share: float) -> SomeChain:
    """The chain without a share of the sweep of the round patch at a side."""
    index = 0 if side == 0 else len(shape.patches) - 1
    patch = shape.patches[index]
    assert isinstance(patch, ConePatch)
    points, directions, normals = shape.points.copy(), shape.directions.copy(), shape.normals.copy()
    turned = _rulings(frame, np.array([patch.sweep * (share if side == 0 else 1.0 - share)]))
    points[-side], directions[-side], normals[-side] = turned.points[0], turned.directions[0], turned.normals[0]
    shorter = replace(patch, sweep=patch.sweep * (1.0 - share))
    patches = (*shape.patches[:index], shorter, *shape.patches[index + 1 :])
    return shape.rewalked(points, directions, normals, patches)


def _leans(directions: Array, normals: Array, plane: CutPlane) -> Array:
    """(m,) by how much walls lean along b for one mm along n that stand along rulings (m, 3) as a plane does."""
    return np.asarray(-(normals @ plane.normal) / (cross(directions, normals) @ plane.normal))


def _share_cut_off(shape: Chain, frame: AxisFrame, side: int, plane: CutPlane, depth: float, *, leaning: bool) -> float:
    """The share of the sweep that goes, so that the last of the four corners comes behind the plane.

    Each corner's distance beyond the plane falls smoothly as the side moves inwards: the secant method finds its zero.
    The wall stands square to the sheet, or leans as the plane does.
    """
    ends = np.array([0, 1, 0, 1])
    depths = np.array([0.0, 0.0, depth, depth])

    def beyond(shares: Array) -> Array:
        turned = _rulings(frame, frame.sweep * (shares if side == 0 else 1.0 - shares))
        starts = turned.points + depths[:, None] * turned.normals
        if leaning:
            leans = _leans(turned.directions, turned.normals, plane)
            ways = turned.normals + leans[:, None] * cross(turned.directions, turned.normals)
            starts = turned.points + risen(frame.level_radius, leans, depths)[:, None] * ways
        rates = np.einsum("cx,cx->c", turned.directions, shape.cut_normals[ends])
        heights = np.einsum("cx,cx->c", shape.cut_points[ends] - starts, shape.cut_normals[ends]) / rates
        return plane.beyond(starts + heights[:, None] * turned.directions)

    before, now = np.zeros(4), np.full(4, 1e-3)
    was, found = beyond(before), beyond(now)
    for _ in range(MOST_STEPS):
        rate = found - was
        step = np.where(rate != 0.0, -found * (now - before) / np.where(rate != 0.0, rate, 1.0), 0.0)
        before, was = now, found
        now = np.clip(now + step, FARTHEST_OUT, 1.0)
        found = beyond(now)
        if np.abs(now - before).max() <= CLOSE_TURN:
            break
    return _near_enough(shape, side, float(now.max()))


def _near_enough(shape: Chain, side: int, share: float) -> float:
    """The share of a sweep by which a side is moved inwards, once it is seen that there is a wall."""
    if not FARTHEST_OUT < share < 1.0:
        raise PanelError(
            shape.name,
            f"its neighbour at side {side} lies too far away for a wall between the two: hold a smaller gap tolerance, "
            "or read the reference with a smaller --seam-tolerance, so that they do not meet.",
        )
    return share
