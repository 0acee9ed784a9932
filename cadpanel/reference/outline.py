"""From a panel's faces to its outline: one closed loop of free edges, cut into sides at its corners."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from cadpanel.errors import OutlineError, PanelError
from cadpanel.reference.model import RawPanel
from cadpanel.reference.polyline import arc_lengths, distances_to_polylines, end_tangents, interpolate, norm, unit
from cadpanel.reference.touching import Contact, Edge, free_edges, panel_edges, split_at_vertices

Array = NDArray[np.float64]

# Faces of one panel touch where they come within this, and within this part of the panel's size.
TOUCH_TOLERANCE = 1.0
TOUCH_PART = 1e-3
# The outline has a corner where it turns by more than this in the surface, degrees. Where it turns less, but by more
# than the second, a curved panel with four clear corners has bent edges, and any other one has a corner there, too.
CORNER_ANGLE = 30.0
OBTUSE_CORNER = 5.0
FOUR = 4
# A panel is flat where its normals lie within this angle of their mean, degrees.
FLAT = 0.5
FEWEST_CORNERS = 3
# A face whose area is less than this part of its outline's length squared is a line.
SLIVER = 1e-6
# Points on each side of the outline that is handed on.
OUTLINE_POINTS = 65
EVEN_PARTS = np.linspace(0.0, 1.0, OUTLINE_POINTS)


@dataclass(frozen=True, slots=True, kw_only=True)
class Side:
    """One of the outline's sides: (q, 3) points (mm) and the surface's (q, 3) unit normals, evenly spaced."""

    points: Array
    normals: Array
    length: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Outline:
    """A panel's outline.

    Attributes:
        sides: three or more in walking order, each beginning where the one before ends.
        face_signs: for each face 1 or -1, which turns its normals to the side of the first face.
    """

    sides: tuple[Side, ...]
    face_signs: tuple[float, ...]


def find_outline(panel: RawPanel, source: str) -> Outline:
    """Return the outline of a panel, whatever the order and direction of its faces and edges.

    Args:
        panel: the panel as sampled.
        source: the file's name, for messages.

    Raises:
        OutlineError: a face has no area, the faces do not touch, or their outline is not one loop with corners.
        PanelError: there are no faces, or one is too narrow.
    """
    check_faces(panel, source)
    tolerance = min(TOUCH_TOLERANCE, TOUCH_PART * _size(panel))
    edges = panel_edges(panel, tolerance)
    free, contacts = free_edges(edges, tolerance)
    signs = _face_signs(len(panel.faces), contacts)
    loops, loose = _chain(free, tolerance)
    if len(loops) != 1 or loose or len(signs) < len(panel.faces):
        free, contacts = free_edges(split_at_vertices(edges, tolerance), tolerance)
        signs = _face_signs(len(panel.faces), contacts)
        loops, loose = _chain(free, tolerance)
        if len(loops) != 1 or loose or len(signs) < len(panel.faces):
            _refuse_hairs(panel, source, tolerance)
            _check_loops(panel, source, signs, free, loops, loose, tolerance)
    loop = [replace(edge, normals=signs[edge.face] * edge.normals) for edge in loops[0]]
    sides = _cut_at_corners(loop, panel, source, tolerance)
    return Outline(sides=sides, face_signs=tuple(signs[face] for face in range(len(panel.faces))))


def check_faces(panel: RawPanel, source: str) -> None:
    """Refuse a panel without faces, and one with a face that has shrunk to a line or a point.

    Raises:
        OutlineError: naming the face by its place.
        PanelError: there are no faces.
    """
    if not panel.faces:
        raise PanelError(panel.name, f"in '{source}', it holds no face: take it out of the export.")
    for place, (face, (area, around)) in enumerate(zip(panel.faces, _measures(panel), strict=True), start=1):
        if len(face.points) == 0 or area <= SLIVER * around**2:
            fault = f"face {place} of {len(panel.faces)} has no area"
            raise OutlineError(panel.name, source, fault, "delete it and export again")


def _refuse_hairs(panel: RawPanel, source: str, tolerance: float) -> None:
    """Say of a panel without an outline that one of its faces is so narrow that its short edges count as points.

    Raises:
        PanelError: naming the face by its place, and its width.
    """
    for place, (area, around) in enumerate(_measures(panel), start=1):
        if 2.0 * area <= tolerance * around:
            raise PanelError(
                panel.name,
                f"in '{source}', face {place} of {len(panel.faces)} is only {2.0 * area / around:.2g} mm wide, too "
                "narrow for a panel: leave it out, or cut the surface into fewer panels.",
            )


def _measures(panel: RawPanel) -> list[tuple[float, float]]:
    """Area (mm^2) of each face, and how long its boundary is (mm)."""
    lengths = iter(arc_lengths([points for face in panel.faces for points in face.edges]))
    return [(float(face.weights.sum()), sum(float(next(lengths)[-1]) for _ in face.edges)) for face in panel.faces]


def _size(panel: RawPanel) -> float:
    """Diagonal of the box around a panel's samples and edges, mm."""
    points = np.concatenate([array for face in panel.faces for array in (face.points, *face.edges)])
    return float(np.linalg.norm(np.ptp(points, axis=0)))


def _face_signs(count: int, contacts: Sequence[Contact]) -> dict[int, float]:
    """Return the sign that turns each face's normals to the side of face 0, for the faces connected with it."""
    neighbours: list[list[tuple[int, float]]] = [[] for _ in range(count)]
    for contact in contacts:
        (first, second), sign = contact.faces, 1.0 if contact.agree else -1.0
        neighbours[first].append((second, sign))
        neighbours[second].append((first, sign))
    signs, front = {0: 1.0}, [0]
    while front:
        face = front.pop()
        for other, sign in neighbours[face]:
            if other not in signs:
                signs[other] = sign * signs[face]
                front.append(other)
    return signs


def _chain(edges: Sequence[Edge], tolerance: float) -> tuple[list[list[Edge]], list[Array]]:
    """Chain edges into closed loops.

    Returns:
        The loops, each edge directed along its loop, and the points (3,) in which other than two edges meet;
        where there are such points, no loops.
    """
    if not edges:
        return [], []
    ends = np.array([end for edge in edges for end in (edge.points[0], edge.points[-1])])
    near = norm(ends[:, None] - ends[None]) <= tolerance
    nodes = near.argmax(axis=1).reshape(-1, 2).tolist()
    at_node: dict[int, list[int]] = {}
    for index, pair in enumerate(nodes):
        for node in pair:
            at_node.setdefault(node, []).append(index)
    loose = [ends[node] for node, indices in at_node.items() if len(indices) != 2]
    if loose:
        return [], loose
    loops, left = [], set(range(len(edges)))
    while left:
        index = min(left)
        start, node = nodes[index]
        loop = [edges[index]]
        left.remove(index)
        while node != start:
            index = next(other for other in at_node[node] if other in left)
            left.remove(index)
            forwards = nodes[index][0] == node
            loop.append(edges[index] if forwards else edges[index].reverse())
            node = nodes[index][1] if forwards else nodes[index][0]
        loops.append(loop)
    return loops, []


def _check_loops(
    panel: RawPanel,
    source: str,
    signs: dict[int, float],
    free: Sequence[Edge],
    loops: Sequence[Sequence[Edge]],
    loose: Sequence[Array],
    tolerance: float,
) -> None:
    """Say why a panel's free edges do not form one closed outline, where they do not."""
    count = len(panel.faces)
    if len(signs) < count:
        gap = _gap(panel, signs)
        touch = f"only {len(signs)} of its {count} faces touch each other along"
        fault = (
            f"{touch} whole edges"
            if gap <= tolerance
            else f"{touch} an edge, the nearest other one is {gap:.3g} mm away"
        )
        raise OutlineError(panel.name, source, fault, "join the faces, or export them as panels of their own")
    if not free:
        fault = "it is a closed surface without an outline"
        raise OutlineError(panel.name, source, fault, "export an open sheet of four sides")
    if loose:
        x, y, z = loose[0]
        fault = f"its outline is not closed or branches at ({x:.1f}, {y:.1f}, {z:.1f})"
        raise OutlineError(panel.name, source, fault, "join its faces along whole edges and export again")
    if len(loops) > 1:
        fault = f"its outline has {len(loops)} loops where a panel has one"
        raise OutlineError(panel.name, source, fault, "close its holes, export again")


def _gap(panel: RawPanel, connected: dict[int, float]) -> float:
    """Least distance from the edges of the connected faces to the points of those of the others, mm."""
    inside, outside = (
        [edge for face, samples in enumerate(panel.faces) if (face in connected) == side for edge in samples.edges]
        for side in (True, False)
    )
    if not inside or not outside:
        return float("inf")
    points = np.concatenate(outside)[None]
    return min(float(distances_to_polylines(points, edge[None]).min()) for edge in inside)


def _cut_at_corners(loop: Sequence[Edge], panel: RawPanel, source: str, tolerance: float) -> tuple[Side, ...]:
    """Cut a closed loop of edges into its sides."""
    turns = _turns(loop)
    corners = np.flatnonzero(turns > CORNER_ANGLE).tolist()
    if len(corners) != FOUR or _is_flat(loop):
        corners = np.flatnonzero(turns > OBTUSE_CORNER).tolist()
    if len(corners) < FEWEST_CORNERS:
        _refuse_hairs(panel, source, tolerance)
        places = ", ".join("({:.1f}, {:.1f}, {:.1f})".format(*loop[index].points[0]) for index in corners)
        raise OutlineError(
            panel.name,
            source,
            f"its outline has {len(corners)} corners{f' (at {places})' if places else ''} where a panel has "
            f"{FEWEST_CORNERS} or more",
            "trim it to edges that meet in corners",
        )
    turned = [*loop[corners[0] :], *loop[: corners[0]]]
    cuts = [corner - corners[0] for corner in corners] + [len(loop)]
    return _sides([turned[start:stop] for start, stop in pairwise(cuts)])


def _is_flat(loop: Sequence[Edge]) -> bool:
    normals = np.concatenate([edge.normals for edge in loop])
    return bool((normals @ unit(normals.sum(axis=0))).min() >= np.cos(np.radians(FLAT)))


def _turns(loop: Sequence[Edge]) -> Array:
    """Angle (k,) by which the outline turns at the start of each of its k edges, seen along the normal, degrees.

    A sharp fold, where the outline runs over the edge between two faces, turns about that edge and not about the
    normal: it is no corner.
    """
    leaving = end_tangents(np.array([edge.points[:3] for edge in loop]))
    arriving = np.roll(-end_tangents(np.array([edge.points[:-4:-1] for edge in loop])), 1, axis=0)
    normals = np.array([loop[index - 1].normals[-1] + edge.normals[0] for index, edge in enumerate(loop)])
    normals = unit(normals)[:, None]
    tangents = np.stack([arriving, leaving], axis=1)
    flat = unit(tangents - np.sum(tangents * normals, axis=-1, keepdims=True) * normals)
    turns: Array = np.degrees(np.arccos(np.clip(np.sum(flat[:, 0] * flat[:, 1], axis=-1), -1.0, 1.0)))
    return turns


def _sides(groups: Sequence[Sequence[Edge]]) -> tuple[Side, ...]:
    """Join consecutive edges into evenly spaced polylines, one a group."""
    lengths, positions = [], []
    for edges in groups:
        starts = np.cumsum([0.0, *(edge.length for edge in edges)])
        even = EVEN_PARTS * starts[-1]
        borders = [0, *np.searchsorted(even, starts[1:-1]).tolist(), OUTLINE_POINTS]
        positions += [
            even[low:high] - start for (low, high), start in zip(pairwise(borders), starts[:-1].tolist(), strict=True)
        ]
        lengths.append(float(starts[-1]))
    edges = [edge for group in groups for edge in group]
    known = np.hstack([np.concatenate([edge.points for edge in edges]), np.concatenate([e.normals for e in edges])])
    values = interpolate([edge.lengths for edge in edges], known, positions).reshape(len(groups), OUTLINE_POINTS, 6)
    points, normals = values[..., :3], unit(values[..., 3:])
    return tuple(Side(points=points[side], normals=normals[side], length=length) for side, length in enumerate(lengths))
