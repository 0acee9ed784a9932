"""A polygon whose walls stand in given planes, edge by edge. Millimetres and radians.

In the polygon's plane every edge is a line with a way out o and a reach a: o . x = a. Its wall leans: at the height h
above the skin the line stands at a + h * lean. Edges that go on almost straight into one another, as where two
neighbours share a side, get one wall: two that lean differently would meet nowhere near their corner.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from cadpanel.arrays import Array
from cadpanel.errors import PanelError
from cadpanel.geometry.limits import SMALLEST_LENGTH
from cadpanel.geometry.panel import CutPlane, Outlined
from cadpanel.geometry.vectors import cross, dot, unit

NEARLY_STRAIGHT = 0.05
"""Radians by which an outline must turn at a corner for its two walls to be of their own."""
AHEAD = 1e-9
"""How far a wall of several edges may stand beyond that of one of them, mm."""
MOST_ROUNDS = 8


@dataclass(frozen=True, slots=True)
class _Line:
    """Where a wall meets the polygon's plane: o . x = reach, and how far it leans out for each mm of height."""

    out: Array
    reach: float
    lean: float

    def moved(self, distance: float) -> _Line:
        """The line that many mm farther out."""
        return replace(self, reach=self.reach + distance)


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
    walls = [_wall(i, [j for j in range(count) if group[j] == group[i]], lines, square, corners) for i in range(count)]
    for _ in range(MOST_ROUNDS):
        moved, posts = _corners(corners, shape.normal, walls, square, group)
        ahead = _ahead(moved, posts, lines, (0.0, depth))
        if ahead.max() <= AHEAD:
            break
        worst = {g: max(float(ahead[i]) for i in range(count) if group[i] == g) for g in group}
        pulled = {id(wall): wall.moved(-worst[g]) for g, wall in zip(group, walls, strict=True) if worst[g] > AHEAD}
        walls = [pulled.get(id(wall), wall) for wall in walls]
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


def _wall(edge: int, members: list[int], lines: list[_Line], square: list[_Line], corners: Array) -> _Line:
    """The wall of an edge: of those that go on straight one for all, the mean of theirs, where any is given.

    Where that stands is found by `_ahead`. Where none is given each edge stays where it is.
    """
    given = [lines[i] for i in members if lines[i] is not square[i]]
    if len(members) == 1 or not given:
        return lines[edge]
    out = unit(np.sum([lines[i].out for i in members], axis=0))
    ends = [corners[end % len(corners)] for i in members for end in (i, i + 1)]
    return _Line(out, max(float(out @ end) for end in ends), float(np.mean([line.lean for line in given])))


def _corners(
    corners: Array, normal: Array, walls: list[_Line], square: list[_Line], group: list[int]
) -> tuple[Array, Array]:
    """Where the walls meet (n, 3), and by how much that moves for one mm of height (n, 3)."""
    moved, posts = corners.copy(), np.tile(normal, (len(corners), 1))
    for i in range(len(corners)):
        before, after = walls[i - 1], walls[i]
        if before is square[i - 1] and after is square[i]:
            continue
        if group[i - 1] == group[i]:
            moved[i] += (after.reach - after.out @ corners[i]) * after.out
            posts[i] += after.lean * after.out
        else:
            moved[i], lean = _meeting(before, after)
            posts[i] += lean
    return moved, posts


def _ahead(moved: Array, posts: Array, lines: list[_Line], heights: tuple[float, float]) -> Array:
    """(n,) how far the two ends of each edge stand beyond its own line, at most, on either face of the sheet."""
    out = np.array([line.out for line in lines])
    reach, lean = (np.array([getattr(line, name) for line in lines]) for name in ("reach", "lean"))
    ends = [
        dot(np.roll(moved + height * posts, -end, axis=0), out) - reach - height * lean
        for height in heights
        for end in (0, 1)
    ]
    return np.asarray(np.max(ends, axis=0))


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
