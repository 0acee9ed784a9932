"""A polygon whose walls stand in given planes, edge by edge. Millimetres and radians.

In the polygon's plane every edge is a line with a way out o and a reach a: o . x = a. Its wall leans: at the height h
above the skin the line stands at a + h * lean. Edges that go on almost straight into one another, as where two
neighbours share a side, get one wall: two that lean differently would meet nowhere near their corner.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array
from cadpanel.errors import PanelError
from cadpanel.geometry.limits import SMALLEST_LENGTH
from cadpanel.geometry.panel import CutPlane, Outlined
from cadpanel.geometry.vectors import cross, dot, unit

NEARLY_STRAIGHT = 0.05
"""Radians by which an outline must turn at a corner for its two walls to be of their own."""


@dataclass(frozen=True, slots=True)
class _Line:
    """Where a wall meets the polygon's plane: o . x = reach, and how far it leans out for each mm of height."""

    out: Array
    reach: float
    lean: float


def cut_polygon(shape: Outlined, planes: Mapping[str, CutPlane], depth: float) -> tuple[Array, Array]:
    """The corners (n, 3), and by how much each moves for one mm of height (n, 3), with walls in planes named by edges.

    Raises:
        PanelError: an edge is gone, on either face of the sheet, of which the other is at `depth`.
    """
    count = len(shape.outline)
    origin = shape.outline[0]
    corners = shape.outline - origin
    spans = np.roll(corners, -1, axis=0) - corners
    outs = unit(cross(spans, shape.normal[None]))
    square = [_Line(outs[i], float(outs[i] @ corners[i]), 0.0) for i in range(count)]
    lines = [
        _line_in(plane, origin, shape.normal) if (plane := planes.get(f"edge {i}")) is not None else square[i]
        for i in range(count)
    ]
    group = _groups(outs, shape.normal)
    walls = [_common([i for i in range(count) if group[i] == g], lines, square, corners, depth) for g in group]
    moved, posts = corners.copy(), np.tile(shape.normal, (count, 1))
    for i in range(count):
        before, after = walls[i - 1], walls[i]
        if before is square[i - 1] and after is square[i]:
            continue
        if group[i - 1] == group[i]:
            moved[i] += (after.reach - after.out @ corners[i]) * after.out
            posts[i] += after.lean * after.out
        else:
            moved[i], lean = _meeting(before, after)
            posts[i] += lean
    for height in (0.0, depth):
        now = moved + height * posts
        _check_edges(shape.name, np.roll(now, -1, axis=0) - now, unit(spans))
    return origin + moved, posts


def _line_in(plane: CutPlane, origin: Array, normal: Array) -> _Line:
    within = plane.normal - (plane.normal @ normal) * normal
    size = float(np.linalg.norm(within))
    out = within / size
    return _Line(out, float(-plane.beyond(origin)) / size, float(-(plane.normal @ normal)) / size)


def _groups(outs: Array, normal: Array) -> list[int]:
    """Which wall each edge belongs to; an outline turns by a whole turn, so one of its corners at least is sharp."""
    turns = np.arctan2(dot(cross(np.roll(outs, 1, axis=0), outs), normal[None]), dot(np.roll(outs, 1, axis=0), outs))
    first = int(np.abs(turns).argmax())
    group, found = [0] * len(outs), 0
    for step in range(len(outs)):
        place = (first + step) % len(outs)
        found += int(abs(turns[place]) >= NEARLY_STRAIGHT)
        group[place] = found
    return group


def _common(members: list[int], lines: list[_Line], square: list[_Line], corners: Array, depth: float) -> _Line:
    """One wall for edges that go on straight: it keeps behind the walls of all of them, on both faces."""
    given = [lines[i] for i in members if lines[i] is not square[i]]
    if len(members) == 1 or not given:
        return lines[members[0]]
    out = unit(np.sum([lines[i].out for i in members], axis=0))
    lean = float(np.mean([line.lean for line in given]))
    reaches = [
        float(out @ _on(line, corners[end % len(corners)], height)) - height * lean
        for i in members
        for line in (lines[i],)
        for end in (i, i + 1)
        for height in (0.0, depth)
    ]
    return _Line(out, min(reaches), lean)


def _on(line: _Line, corner: Array, height: float) -> Array:
    """The point of a line at a height that is nearest to a corner."""
    return np.asarray(corner + (line.reach + height * line.lean - line.out @ corner) * line.out)


def _meeting(one: _Line, other: _Line) -> tuple[Array, Array]:
    """Where two lines meet in their plane, and by how much that moves for one mm of height."""
    system = np.stack([one.out, other.out])
    # The shortest solution lies in the plane of the two ways out, which is the polygon's.
    found = system.T @ np.linalg.solve(system @ system.T, [[one.reach, one.lean], [other.reach, other.lean]])
    return found[:, 0], found[:, 1]


def _check_edges(name: str, spans: Array, ways: Array) -> None:
    lengths = dot(spans, ways)
    shortest = int(lengths.argmin())
    if lengths[shortest] < SMALLEST_LENGTH:
        left = max(float(lengths[shortest]), 0.0) if math.isfinite(lengths[shortest]) else 0.0
        raise PanelError(name, f"only {left:.3g} mm of edge {shortest} are left, {SMALLEST_LENGTH:g} are needed")
