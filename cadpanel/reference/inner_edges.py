"""Which edges of a panel's faces lie inside the panel, because another face begins there, and which are free."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from cadpanel.arrays import Array, BoolArray
from cadpanel.geometry.polyline import STENCIL, arc_length, arc_lengths, distances_to_curves, interpolate
from cadpanel.geometry.vectors import cross, norm, unit
from cadpanel.reference.model import RawPanel

# Two edges coincide when they do at this many evenly spread points.
PROBES = 9
# Inner places of an edge, as parts of its length, at which its distance to the one that it coincides with is measured.
INNER = np.array([0.25, 0.5, 0.75])
# A gap narrower than this is not measured any closer, mm.
SEEN = 0.01
# Faces that fold back by more than this where they touch meet in a knife edge, as at a wing's trailing edge, degrees.
KNIFE_EDGE = 135.0
# Points of a piece that is cut out of an edge.
PIECE_POINTS = 33
# Neighbouring points closer than this part of the edge's length count as one.
SAME_POINT = 1e-6


@dataclass(frozen=True, slots=True)
class Edge:
    """One edge of one face.

    Attributes:
        face: index of the face in its panel.
        points: (q, 3) in order, no two alike, mm.
        normals: (q, 3) the face's unit normals there.
        lengths: (q,) arc length from the first point, mm.
    """

    face: int
    points: Array
    normals: Array
    lengths: Array

    @property
    def length(self) -> float:
        """Length from end to end, mm."""
        return float(self.lengths[-1])

    def at(self, lengths: Array) -> tuple[Array, Array]:
        """Return points and (not quite unit) normals, each (k, 3), at the given arc lengths."""
        values = interpolate([self.lengths], np.hstack([self.points, self.normals]), [lengths])
        return values[:, :3], values[:, 3:]

    def reverse(self) -> Edge:
        """Return the edge walked the other way."""
        return Edge(self.face, self.points[::-1], self.normals[::-1], self.lengths[-1] - self.lengths[::-1])


@dataclass(frozen=True, slots=True)
class Contact:
    """Two faces that share an edge.

    Attributes:
        faces: their places in the panel.
        agree: whether their normals there lie on the same side.
        gap: how far apart the edges lie, mm.
        length: of the shorter edge, mm.
        ends: (2, 3) of the first face's edge, mm.
    """

    faces: tuple[int, int]
    agree: bool
    gap: float
    length: float
    ends: Array


def panel_edges(panel: RawPanel, tolerance: float) -> list[Edge]:
    """Return the edges of all faces; those no longer than the tolerance (mm) are points and are left out."""
    found = [
        (face, points, normals)
        for face, samples in enumerate(panel.faces)
        for points, normals in zip(samples.edges, samples.edge_normals, strict=True)
    ]
    edges = []
    for (face, points, normals), lengths in zip(found, arc_lengths([points for _, points, _ in found]), strict=True):
        if lengths[-1] <= tolerance:
            continue
        apart = lengths[1:] - lengths[:-1] > SAME_POINT * lengths[-1]
        if not apart.all():
            keep = np.concatenate([[True], apart])
            points, normals, lengths = points[keep], normals[keep], lengths[keep]
        if len(points) >= STENCIL:
            edges.append(Edge(face, points, normals, lengths))
    return edges


def free_edges(
    edges: Sequence[Edge], panel: RawPanel, tolerance: float, *, knives: bool = False
) -> tuple[list[Edge], list[Contact]]:
    """Separate the edges that no other face shares, from end to end, from those that one does.

    Args:
        edges: all edges of the panel, in any order and direction.
        panel: as sampled.
        tolerance: how far shared edges may lie apart, mm.
        knives: whether edges along which faces fold back are free, or shared.

    Returns:
        The free edges, and one contact for each pair of edges that coincide.
    """
    if not edges:
        return [], []
    faces = np.array([edge.face for edge in edges])
    starts = np.array([edge.points[0] for edge in edges])
    stops = np.array([edge.points[-1] for edge in edges])
    direct = _near(starts, starts, tolerance) & _near(stops, stops, tolerance)
    reverse = _near(starts, stops, tolerance) & _near(stops, starts, tolerance)
    candidates = np.argwhere(np.triu((direct | reverse) & (faces[:, None] != faces[None, :]), 1)).tolist()
    contacts, shared = [], set()
    for first, second in candidates:
        contact = _coincide(edges[first], edges[second], panel, tolerance)
        if contact is not None and not (knives and _folds_back(edges[first], edges[second], panel)):
            contacts.append(contact)
            shared |= {first, second}
    return [edge for index, edge in enumerate(edges) if index not in shared], contacts


def split_at_vertices(edges: Sequence[Edge], tolerance: float) -> list[Edge]:
    """Cut every edge where an end of another one lies on it (a T-junction), so that shared pieces match in pairs."""
    vertices = np.array([end for edge in edges for end in (edge.points[0], edge.points[-1])])
    pieces = []
    for edge in edges:
        cuts = positions_on(edge, vertices, tolerance)
        borders = [0.0, *cuts, edge.length]
        for start, stop in pairwise(borders):
            points, normals = edge.at(np.linspace(start, stop, PIECE_POINTS))
            pieces.append(Edge(edge.face, points, normals, arc_length(points)))
    return pieces


def _near(first: Array, second: Array, tolerance: float) -> BoolArray:
    """Tell for every pair of (m, 3) and (k, 3) points whether they lie within the tolerance: (m, k)."""
    near: BoolArray = norm(first[:, None] - second[None]) <= tolerance
    return near


def _coincide(first: Edge, second: Edge, panel: RawPanel, tolerance: float) -> Contact | None:
    """The contact along two edges, None where they do not coincide."""
    points, normals, other_points, other_normals = first.points, first.normals, second.points, second.normals
    if len(points) != len(other_points):
        parts = np.linspace(0.0, 1.0, PROBES)
        points, normals = first.at(parts * first.length)
        other_points, other_normals = second.at(parts * second.length)
    for order in (slice(None), slice(None, None, -1)):
        apart = float(norm(points - other_points[order]).max())
        if apart <= tolerance:
            together = float(np.mean(np.sum(normals * other_normals[order], axis=-1)))
            agree = together > 0.0
            if abs(together) < -np.cos(np.radians(KNIFE_EDGE)):
                # At a sharp crease normals of one side of a sheet may lean away from each other, but its faces lie on
                # the two sides of their edge.
                lefts = [_into(edge, panel)[1] for edge in (first, second)]
                runs_against = order.step is not None
                agree = (lefts[0] == lefts[1]) == runs_against
            # Points may lie beside each other along the edges only.
            gap = apart if apart <= SEEN else _gap(first, second)
            return Contact(
                (first.face, second.face), agree, gap, min(first.length, second.length), first.points[[0, -1]]
            )
    return None


def _folds_back(first: Edge, second: Edge, panel: RawPanel) -> bool:
    """Whether the surface turns back where it goes over two edges that coincide."""
    ways = [_into(edge, panel)[0] for edge in (first, second)]
    return bool(ways[0] @ ways[1] > np.cos(np.radians(180.0 - KNIFE_EDGE)))


def _into(edge: Edge, panel: RawPanel) -> tuple[Array, bool]:
    """Where an edge has its face: the way (3,) into it, square to the edge, and whether that is left with normals up.

    Told in the edge's point to which a sample of the face is nearest: across from there lies the face, however narrow.
    """
    inner = edge.points[1:-1]
    offsets = panel.faces[edge.face].points - inner[:, None]
    place, sample = np.unravel_index(norm(offsets).argmin(), offsets.shape[:2])
    left = unit(cross(edge.normals[place + 1], edge.points[place + 2] - edge.points[place]))
    on_left = bool(left @ offsets[place, sample] >= 0.0)
    return np.asarray(left if on_left else -left), on_left


def _gap(first: Edge, second: Edge) -> float:
    """How far inner points of an edge lie from another edge at most, mm."""
    probes, _ = first.at(INNER * first.length)
    return float(distances_to_curves(probes[None], second.points[None]).max())


def positions_on(edge: Edge, vertices: Array, tolerance: float) -> list[float]:
    """Return the rising arc lengths at which vertices lie on the inside of an edge, each place once."""
    # Half a tolerance is finer than anything that is told apart here, and the edge between its points is smooth.
    count = max(len(edge.points), PIECE_POINTS) * 2
    lengths = np.linspace(0.0, edge.length, count)
    points, _ = edge.at(lengths)
    steps = np.diff(points, axis=0)
    squares = np.maximum(np.einsum("kd,kd->k", steps, steps), np.finfo(float).tiny)
    offsets = vertices[:, None] - points[None, :-1]
    along = np.clip(np.einsum("vkd,kd->vk", offsets, steps) / squares, 0.0, 1.0)
    distances = norm(offsets - along[..., None] * steps)
    nearest = distances.argmin(axis=1)
    rows = np.arange(len(vertices))
    positions = lengths[nearest] + along[rows, nearest] * (lengths[1] - lengths[0])
    on_edge = (distances[rows, nearest] <= tolerance) & (positions > tolerance) & (positions < edge.length - tolerance)
    cuts: list[float] = []
    for position in sorted(positions[on_edge].tolist()):
        if not cuts or position - cuts[-1] > tolerance:
            cuts.append(position)
    return cuts
