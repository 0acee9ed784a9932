"""A panel's skin as triangles to look at: vertices on the exact surface, whatever the kind of panel. Millimetres."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.geometry.cone_sections import AxisFrame, axis_frame, lifted
from cadpanel.geometry.panel import Chain, Panel
from cadpanel.geometry.patches import ConePatch
from cadpanel.geometry.plane_section import plane_section
from cadpanel.geometry.plane_sides import side_curves
from cadpanel.geometry.polyline import arc_length
from cadpanel.geometry.tray_plan import TrayPlan
from cadpanel.geometry.trays import TrayShape
from cadpanel.geometry.vectors import cross, side_of, unit

ALONG, ACROSS = 8, 4
"""Steps from end to end, and across a flat patch: enough to show how a deviation changes over them."""
_TURN, _MOST_TURNS = math.radians(10.0), 24
"""By how much the skin turns in one step across a round patch, and how many steps there are at most."""
_HALVINGS = 2


@dataclass(frozen=True, slots=True, kw_only=True)
class SkinMesh:
    """A skin as f triangles between v vertices, with a chart of it.

    Attributes:
        points: (v, 3) on the skin, mm.
        triangles: (f, 3) counterclockwise seen from outside.
        chart: (v, 2) where the vertices lie on a flat map of the skin, mm; it keeps neighbours together, not lengths,
            and triangles run counterclockwise on it, too.
        ways: (v, 2, 3) unit vectors in the skin along the chart's two axes.
        patches: (f,) the patch to which each triangle belongs, by its place among the panel's.
    """

    points: Array
    triangles: IntArray
    chart: Array
    ways: Array
    patches: IntArray


def skin_mesh(shape: Panel) -> SkinMesh:
    """The mesh of a panel's skin; two panels with like patches and sweeps have the same triangles."""
    if isinstance(shape, TrayShape):
        return _tray_mesh(shape)
    return _grid_mesh(shape) if isinstance(shape, Chain) else _polygon_mesh(shape)


def _grid_mesh(shape: Chain) -> SkinMesh:
    """Of patches between two ends: rows from end to end, columns across."""
    grid, owners = _grid(shape)
    rows, columns = grid.shape[:2]
    across, along = arc_length(grid[rows // 2]), arc_length(np.swapaxes(grid, 0, 1)[columns // 2])
    chart = np.stack(np.meshgrid(across, along), axis=-1)
    ways = np.stack([unit(np.gradient(grid, axis=1)), unit(np.gradient(grid, axis=0))], axis=2)
    corner = np.arange(rows * columns).reshape(rows, columns)
    here, right, up, far = corner[:-1, :-1], corner[:-1, 1:], corner[1:, :-1], corner[1:, 1:]
    # The walk goes along t x n, so that across and along are right-handed with the outward normal.
    triangles = np.stack([here, right, far, here, far, up], axis=-1).reshape(-1, 3)
    return SkinMesh(
        points=grid.reshape(-1, 3),
        triangles=triangles,
        chart=chart.reshape(-1, 2),
        ways=ways.reshape(-1, 2, 3),
        patches=np.tile(np.repeat(owners, 2), rows - 1),
    )


def _grid(shape: Chain) -> tuple[Array, IntArray]:
    """(ALONG + 1, c, 3) points of the skin in rows from end 0 to end 1; (c - 1,) the patches between two of a row."""
    corners = shape.corners()
    points, directions, normals = shape.points, shape.directions, shape.normals
    share = np.linspace(0.0, 1.0, ALONG + 1)[:, None, None]
    parts: list[Array] = []
    for index, patch in enumerate(shape.patches):
        if not isinstance(patch, ConePatch):
            across = np.linspace(0.0, 1.0, ACROSS + 1)[:, None]
            ends = (1.0 - across) * corners[:, None, index] + across * corners[:, None, index + 1]
            part = (1.0 - share) * ends[0] + share * ends[1]
        else:
            part = _round_grid(shape, index, axis_frame(points[index], directions[index], normals[index], patch))
        parts.append(part if not parts else part[:, 1:])
    steps_of = [part.shape[1] - (place == 0) for place, part in enumerate(parts)]
    return np.concatenate(parts, axis=1), np.repeat(np.arange(len(parts)), steps_of)


def _round_grid(shape: Chain, index: int, frame: AxisFrame) -> Array:
    """(ALONG + 1, c, 3) points of a round patch: between sides in planes the columns turn with these."""
    share = np.linspace(0.0, 1.0, ALONG + 1)[:, None]
    across = np.linspace(0.0, 1.0, min(_MOST_TURNS, max(ACROSS, math.ceil(abs(frame.sweep) / _TURN))) + 1)
    borders = [np.zeros_like(share), np.full_like(share, frame.sweep)]
    for side, curve in enumerate(side_curves(shape)):
        if curve is not None and index == side * (len(shape.patches) - 1):
            heights = (1.0 - share) * curve.heights[0] + share * curve.heights[1]
            borders[side] = curve.angles(heights[:, 0])[:, None]
    angles = (1.0 - across) * borders[0] + across * borders[1]
    # Of a square sheet the other face ends where the skin's normals do: at the heights at which the skin is cut.
    cut = lifted(frame, shape.lift)
    low, high = (
        plane_section(cut, point, normal).heights(angles[[row]])[0]
        for row, (point, normal) in zip((0, -1), zip(shape.cut_points, shape.cut_normals, strict=True), strict=True)
    )
    heights = (1.0 - share) * low + share * high
    return frame.points(angles.ravel(), heights.ravel()).reshape(*angles.shape, 3)


def _polygon_mesh(shape: Panel) -> SkinMesh:
    """Of a plane with corners all round."""
    outline = shape.corners()[0]
    _, directions, normals = shape.rulings()
    axes = np.stack([directions[0], cross(normals[0], directions[0])])
    flat = (outline - outline[0]) @ axes.T
    chart, triangles = _halved(flat, _ears(flat))
    return SkinMesh(
        points=outline[0] + chart @ axes,
        triangles=triangles,
        chart=chart,
        ways=np.broadcast_to(axes, (len(chart), 2, 3)),
        patches=np.zeros(len(triangles), dtype=np.intp),
    )


def _tray_mesh(shape: TrayShape) -> SkinMesh:
    """Of a folded flat panel: its flat part inside of its reliefs, and rows over each fold and its leg."""
    plan = shape.plan
    origin = plan.corners[0] + shape.lift * plan.normal
    axes = np.stack([plan.along[0], cross(plan.normal, plan.along[0])])
    flat = (_round_reliefs(plan) - plan.corners[0]) @ axes.T
    chart, triangles = _halved(flat, _ears(flat))
    meshes = [
        SkinMesh(
            points=origin + chart @ axes,
            triangles=triangles,
            chart=chart,
            ways=np.tile(axes, (len(chart), 1, 1)),
            patches=np.zeros(len(triangles), dtype=np.intp),
        )
    ]
    meshes += [_fold_mesh(shape, edge, axes) for edge in np.flatnonzero(plan.folded).tolist()]
    starts = np.cumsum([0] + [len(mesh.points) for mesh in meshes[:-1]])
    firsts = np.cumsum([0] + [len(np.unique(mesh.patches)) for mesh in meshes[:-1]])
    return SkinMesh(
        points=np.concatenate([mesh.points for mesh in meshes]),
        triangles=np.concatenate([mesh.triangles + start for mesh, start in zip(meshes, starts, strict=True)]),
        chart=np.concatenate([mesh.chart for mesh in meshes]),
        ways=np.concatenate([mesh.ways for mesh in meshes]),
        patches=np.concatenate([mesh.patches + first for mesh, first in zip(meshes, firsts, strict=True)]),
    )


def _round_reliefs(plan: TrayPlan) -> Array:
    """(q, 3) round the flat part, in the plane of its corners."""
    back, inwards = -np.roll(plan.along, 1, axis=0), -np.roll(plan.outward, 1, axis=0)
    turns = plan.openings[:, None] * np.linspace(0.0, 1.0, ACROSS + 1)
    ways = np.cos(turns)[..., None] * back[:, None] + np.sin(turns)[..., None] * inwards[:, None]
    points = plan.corners[:, None] + plan.reliefs[:, None, None] * ways
    return np.concatenate(
        [own if round_one else own[:1] for own, round_one in zip(points, (plan.reliefs > 0.0).tolist(), strict=True)]
    )


def _fold_mesh(shape: TrayShape, edge: int, axes: Array) -> SkinMesh:
    """Rows along a fold and down its leg."""
    plan, long = shape.plan, float(shape.plan.lengths[edge])
    along, out, normal, angle = plan.along[edge], plan.outward[edge], plan.normal, float(plan.angles[edge])
    turns = np.concatenate([np.linspace(0.0, angle, ACROSS + 1), np.full(ACROSS, angle)])[:, None]
    down = np.concatenate([np.zeros(ACROSS + 1), np.linspace(0.0, float(plan.legs[edge]), ACROSS + 1)[1:]])[:, None]
    onwards = np.cos(turns) * out - np.sin(turns) * normal
    bent = shape.radius * (np.sin(turns) * out + np.cos(turns) * normal) - plan.radius * normal
    rows = plan.starts[edge] + bent + down * onwards
    steps = np.linspace(0.0, long, ALONG + 1)[:, None]
    points = rows[:, None] + steps * along
    begin = (plan.starts[edge] - plan.corners[0]) @ axes.T
    chart = begin + ((shape.radius * turns + down) * (axes @ out))[:, None] + steps * (axes @ along)
    ways = (axes @ along)[:, None] * along + (axes @ out)[:, None] * onwards[:, None]
    corner = np.arange(points.shape[0] * points.shape[1]).reshape(points.shape[:2])
    here, right, under, far = corner[:-1, :-1], corner[:-1, 1:], corner[1:, :-1], corner[1:, 1:]
    return SkinMesh(
        points=points.reshape(-1, 3),
        triangles=np.stack([here, far, right, here, under, far], axis=-1).reshape(-1, 3),
        chart=chart.reshape(-1, 2),
        ways=np.repeat(ways, len(steps), axis=0),
        patches=np.repeat([0, 1], 2 * ACROSS * ALONG),
    )


def _ears(corners: Array) -> IntArray:
    """(n - 2, 3) triangles of a simple polygon (n, 2), counterclockwise, cut off ear by ear."""
    left = list(range(len(corners)))
    found: list[tuple[int, int, int]] = []
    while len(left) > 3:
        ear = next((i for i in range(len(left)) if _is_ear(corners, left, i)), 0)  # the first where none is clear
        found.append((left[ear - 1], left[ear], left[(ear + 1) % len(left)]))
        del left[ear]
    found.append((left[0], left[1], left[2]))
    return np.array(found)


def _is_ear(corners: Array, left: list[int], place: int) -> bool:
    """Whether the corner at a place juts out and no other one lies in the triangle with its neighbours."""
    triangle = [left[place - 1], left[place], left[(place + 1) % len(left)]]
    a, b, c = corners[triangle]
    others = corners[[corner for corner in left if corner not in triangle]]
    inside = np.all([side_of(one, other, others) >= 0.0 for one, other in ((a, b), (b, c), (c, a))], axis=0)
    return bool(side_of(a, b, c) > 0.0 and not inside.any())


def _halved(points: Array, triangles: IntArray) -> tuple[Array, IntArray]:
    """The same with every edge halved, some times over: each triangle becomes four, neighbours share vertices."""
    for _ in range(_HALVINGS):
        edges = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]], axis=-1)
        pairs, which = np.unique(edges.reshape(-1, 2), axis=0, return_inverse=True)
        a, b, c = triangles.T
        ab, bc, ca = (len(points) + which.reshape(-1, 3)).T
        points = np.concatenate([points, points[pairs].mean(axis=1)])
        triangles = np.stack([a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca], axis=-1).reshape(-1, 3)
    return points, triangles
