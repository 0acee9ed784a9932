"""A walk round a panel's faces: which hang together, along which edges nothing of it goes on, and their loops."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.geometry.vectors import norm
from cadpanel.reference.inner_edges import Contact, Edge, free_edges, panel_edges, split_at_vertices
from cadpanel.reference.model import RawPanel
from cadpanel.reference.outline_faults import narrowest

# Faces of one panel touch where they come within this, mm, and within this part of the panel's size.
TOUCH_TOLERANCE = 1.0
TOUCH_PART = 1e-3
# Where they make no outline then, wider gaps are bridged, up to the tolerance and this part of the narrowest face's
# width: there an edge is nearer to its neighbour than to the other side of its own face.
BRIDGED_PART = 0.4
# Edges that are shorter than this many tolerances do not tell that faces meet along them.
BIT = 2.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Walk:
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


def walk_round(panel: RawPanel, tolerance: float) -> Walk:
    """Walk round a panel within the tolerance that suits its size; where that gives no outline, within a wider one."""
    close = touch_tolerance(panel)
    walk = _within(panel, close)
    wide = min(tolerance, BRIDGED_PART * narrowest(panel))
    if wide <= close:
        return walk
    # Where faces overlap by a little more than the close tolerance, bits of their ends lie on each other.
    bits = any(contact.length < BIT * wide for contact in walk.contacts)
    if walk.is_whole(panel) and not bits:
        return walk
    wider = _within(panel, wide)
    return walk if walk.is_whole(panel) and not wider.is_whole(panel) else wider


def _within(panel: RawPanel, tolerance: float) -> Walk:
    """Walk round a panel.

    Only where it is not whole without, edges are parted where others end on them, and then along knife edges.
    """
    whole = panel_edges(panel, tolerance)
    walk = walk_along(whole, panel, tolerance)
    if walk.is_whole(panel):
        return walk
    parts = split_at_vertices(whole, tolerance)
    walk = walk_along(parts, panel, tolerance)
    if walk.is_whole(panel):
        return walk
    parted = (walk_along(edges, panel, tolerance, knives=True) for edges in (whole, parts))
    return next((found for found in parted if found.is_whole(panel)), walk)


def walk_along(edges: Sequence[Edge], panel: RawPanel, tolerance: float, *, knives: bool = False) -> Walk:
    """Walk round a panel; edges along which it folds back are joined, or are free as knife edges."""
    free, contacts = free_edges(edges, panel, tolerance, knives=knives)
    loops, loose = _chain(free, contacts, tolerance)
    return Walk(
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


def touch_tolerance(panel: RawPanel) -> float:
    """Within this faces of a panel touch that fit as they should, mm."""
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
