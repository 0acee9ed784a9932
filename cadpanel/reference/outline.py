"""From a panel's faces to its outline: one closed loop of free edges, cut into sides at its corners."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.errors import OutlineError, PanelError
from cadpanel.geometry.polyline import end_tangents, interpolate
from cadpanel.geometry.vectors import norm, unit
from cadpanel.reference.inner_edges import Contact, Edge, free_edges, panel_edges, split_at_vertices
from cadpanel.reference.model import RawPanel
from cadpanel.reference.outline_faults import check_faces, check_loops, narrowest, refuse_hairs

# Faces of one panel touch where they come within this, mm, and within this part of the panel's size.
TOUCH_TOLERANCE = 1.0
TOUCH_PART = 1e-3
# Where they make no outline then, wider gaps are bridged, up to the tolerance and this part of the narrowest face's
# width: there an edge is nearer to its neighbour than to the other side of its own face.
BRIDGED_PART = 0.4
# Edges that are shorter than this many tolerances do not tell that faces meet along them.
BIT = 2.0
# The outline has a corner where it turns by more than this in the surface, degrees. Where it turns less, but by more
# than the second, a curved panel with four clear corners has bent edges, and any other one has a corner there, too.
CORNER_ANGLE = 30.0
OBTUSE_CORNER = 5.0
FOUR = 4
# A panel is flat where its normals lie within this angle of their mean, degrees.
FLAT = 0.5
FEWEST_CORNERS = 3
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


@dataclass(frozen=True, slots=True, kw_only=True)
class _Walk:
    """A panel's faces as they hang together within one tolerance, mm.

    Attributes:
        free: edges along which nothing of the panel goes on.
        contacts: faces that touch along edges.
        signs: for each face that hangs together with face 0, 1 or -1.
        loops: the free edges, walked round.
        loose: points (3,) in which other than two free edges meet.
    """

    tolerance: float
    free: list[Edge]
    contacts: list[Contact]
    signs: dict[int, float]
    loops: list[list[Edge]]
    loose: list[Array]

    def is_whole(self, panel: RawPanel) -> bool:
        """Whether all faces hang together and have one outline."""
        return len(self.loops) == 1 and not self.loose and len(self.signs) == len(panel.faces)


def find_outline(panel: RawPanel, source: str, tolerance: float = TOUCH_TOLERANCE) -> Outline:
    """Return the outline of a panel, whatever the order and direction of its faces and edges.

    Args:
        panel: the panel as sampled.
        source: the file's name, for messages.
        tolerance: gaps between the faces up to this width are bridged, mm.

    Raises:
        OutlineError: a face has no area, the faces do not touch, or their outline is not one loop with corners.
        PanelError: there are no faces, or one is too narrow.
    """
    check_faces(panel, source)
    return _outline(panel, source, _walk(panel, tolerance))


def outline_and_gap(panel: RawPanel, source: str, tolerance: float) -> tuple[Outline | None, float]:
    """What `find_outline` and `bridged_gap` give, walked round once; no outline where the panel has none."""
    try:
        check_faces(panel, source)
    except PanelError:
        return None, bridged_gap(panel, tolerance)
    walk = _walk(panel, tolerance)
    try:
        outline = _outline(panel, source, walk)
    except PanelError:
        return None, _gap(panel, walk)
    return outline, _gap(panel, walk)


def _outline(panel: RawPanel, source: str, walk: _Walk) -> Outline:
    if not walk.is_whole(panel):
        refuse_hairs(panel, source, _touch_tolerance(panel))
        check_loops(panel, source, walk.signs, walk.free, walk.loops, walk.loose, walk.tolerance)
    loop = [replace(edge, normals=walk.signs[edge.face] * edge.normals) for edge in walk.loops[0]]
    sides = _cut_at_corners(loop, panel, source, walk.tolerance)
    return Outline(sides=sides, face_signs=tuple(walk.signs[face] for face in range(len(panel.faces))))


def find_loops(panel: RawPanel, source: str, tolerance: float, count: int) -> tuple[tuple[Array, ...], ...]:
    """The closed lines that bound a panel's faces, each as the edges (count, 3) that follow each other round it, mm.

    None where the faces do not hang together, or their edges do not close.

    Args:
        panel: as sampled.
        source: the file's name, for messages.
        tolerance: gaps between the faces up to this width are bridged, mm.
        count: of even points on each edge.

    Raises:
        OutlineError: a face has no area.
        PanelError: there are no faces.
    """
    check_faces(panel, source)
    close = _touch_tolerance(panel)
    even = np.linspace(0.0, 1.0, count)
    # The widest gap first: unbridged, two parts of a strip have two borders, as a ring has.
    for bridged in dict.fromkeys((max(close, min(tolerance, BRIDGED_PART * narrowest(panel))), close)):
        whole = panel_edges(panel, bridged)
        for edges in (whole, split_at_vertices(whole, bridged)):
            walk = _walk_along(edges, panel, bridged)
            if not walk.loose and len(walk.signs) == len(panel.faces):
                return tuple(tuple(edge.at(even * edge.length)[0] for edge in loop) for loop in walk.loops)
    return ()


def bridged_gap(panel: RawPanel, tolerance: float) -> float:
    """Width of the widest gap between faces of a panel that its outline bridges, mm.

    Args:
        panel: with faces that have an area.
        tolerance: as for `find_outline`, mm.
    """
    return 0.0 if len(panel.faces) < 2 else _gap(panel, _walk(panel, tolerance))


def _gap(panel: RawPanel, walk: _Walk) -> float:
    return 0.0 if len(panel.faces) < 2 else max((contact.gap for contact in walk.contacts), default=0.0)


def _walk(panel: RawPanel, tolerance: float) -> _Walk:
    """Walk round a panel within the tolerance that suits its size; where that gives no outline, within a wider one."""
    close = _touch_tolerance(panel)
    walk = _walk_within(panel, close)
    wide = min(tolerance, BRIDGED_PART * narrowest(panel))
    if wide <= close:
        return walk
    # Where faces overlap by a little more than the close tolerance, bits of their ends lie on each other.
    bits = any(contact.length < BIT * wide for contact in walk.contacts)
    if walk.is_whole(panel) and not bits:
        return walk
    wider = _walk_within(panel, wide)
    return walk if walk.is_whole(panel) and not wider.is_whole(panel) else wider


def _walk_within(panel: RawPanel, tolerance: float) -> _Walk:
    """Walk round a panel.

    Only where it is not whole without, edges are parted where others end on them, and then along knife edges.
    """
    whole = panel_edges(panel, tolerance)
    walk = _walk_along(whole, panel, tolerance)
    if walk.is_whole(panel):
        return walk
    parts = split_at_vertices(whole, tolerance)
    walk = _walk_along(parts, panel, tolerance)
    if walk.is_whole(panel):
        return walk
    parted = (_walk_along(edges, panel, tolerance, knives=True) for edges in (whole, parts))
    return next((found for found in parted if found.is_whole(panel)), walk)


def _walk_along(edges: Sequence[Edge], panel: RawPanel, tolerance: float, *, knives: bool = False) -> _Walk:
    """Walk round a panel; edges along which it folds back are joined, or are free as knife edges."""
    free, contacts = free_edges(edges, panel, tolerance, knives=knives)
    loops, loose = _chain(free, contacts, tolerance)
    return _Walk(
        tolerance=tolerance,
        free=free,
        contacts=contacts,
        signs=_face_signs(len(panel.faces), contacts),
        loops=loops,
        loose=loose,
    )


def least_edge(size: float) -> float:
    """Edges no longer than this count as points on a panel of a size, mm."""
    return min(TOUCH_TOLERANCE, TOUCH_PART * size)


def _touch_tolerance(panel: RawPanel) -> float:
    return least_edge(_size(panel))


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


def _chain(
    edges: Sequence[Edge], contacts: Sequence[Contact], tolerance: float
) -> tuple[list[list[Edge]], list[Array]]:
    """Chain edges into closed loops.

    Where more than two meet in a point, as at a knife edge from one face to the next, those go on into each other whose
    faces hang together there.

    Returns:
        The loops, each edge directed along its loop, and the points (3,) in which other than two edges meet;
        where there are such points, no loops.
    """
    if not edges:
        return [], []
    ends = np.array([end for edge in edges for end in (edge.points[0], edge.points[-1])])
    near = norm(ends[:, None] - ends[None]) <= tolerance
    numbers = near.argmax(axis=1)
    for node in np.flatnonzero(np.bincount(numbers) > 2).tolist():
        here = np.flatnonzero(numbers == node)
        faces = [edges[end // 2].face for end in here.tolist()]
        numbers[here] = _by_sheet(here, faces, [c for c in contacts if norm(c.ends - ends[node]).min() <= tolerance])
    nodes = numbers.reshape(-1, 2).tolist()
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


def _by_sheet(here: IntArray, faces: Sequence[int], contacts: Sequence[Contact]) -> Array:
    """Of the (k,) ends of edges in one point, for each the first whose face hangs together with its own there.

    Args:
        here: their numbers.
        faces: of their edges.
        contacts: of faces, along edges that end in the point.
    """
    sheets = {face: {face} for face in faces}
    for contact in contacts:
        one, other = (sheets.setdefault(face, {face}) for face in contact.faces)
        joined = one | other
        sheets.update(dict.fromkeys(joined, joined))
    return np.array([next(end for end, own in zip(here, faces, strict=True) if own in sheets[face]) for face in faces])


def _cut_at_corners(loop: Sequence[Edge], panel: RawPanel, source: str, tolerance: float) -> tuple[Side, ...]:
    """Cut a closed loop of edges into its sides."""
    turns = _turns(loop)
    corners = np.flatnonzero(turns > CORNER_ANGLE).tolist()
    if len(corners) > FOUR:
        # An end that crosses a crease aslant turns there in the sheet, too, and is one cut all the same.
        off_creases = [corner for corner in corners if not _at_crease(loop, corner)]
        corners = off_creases if len(off_creases) == FOUR else corners
    if len(corners) != FOUR or _is_flat(loop):
        corners = np.flatnonzero(turns > OBTUSE_CORNER).tolist()
    if len(corners) < FEWEST_CORNERS:
        refuse_hairs(panel, source, tolerance)
        places = ", ".join("({:.1f}, {:.1f}, {:.1f})".format(*loop[index].points[0]) for index in corners)
        raise OutlineError(
            panel.name,
            source,
            f"its outline has {len(corners)} corners{f' (at {places})' if places else ''} where a panel has "
            f"{FEWEST_CORNERS} or more",
            "trim it to edges that meet in corners, or cut it with a grid",
        )
    turned = [*loop[corners[0] :], *loop[: corners[0]]]
    cuts = [corner - corners[0] for corner in corners] + [len(loop)]
    return _sides([turned[start:stop] for start, stop in pairwise(cuts)])


def _at_crease(loop: Sequence[Edge], start: int) -> bool:
    """Whether the loop goes from one face to another at the start of an edge, and the normals turn as at a corner."""
    before, after = loop[start - 1], loop[start]
    sharp = before.normals[-1] @ after.normals[0] < np.cos(np.radians(CORNER_ANGLE))
    return bool(before.face != after.face and sharp)


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
