"""The boundary of a shape as plain numbers, and whether two of them are one: every vertex, edge and face. Millimetres.

Two shapes are the same where their vertices, edges and faces pair off one to one, edges run through the same points,
and faces have the same edges, lie on the same surface and look the same way. Which of them comes first, and which way
an edge runs, is no part of a shape.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.geometry.curve_pieces import BoolArray
from cadpanel.geometry.kink import surface_normals
from cadpanel.geometry.vectors import dot, norm

EDGE_POINTS = 5
"""Points of an edge that are looked at, at equal steps of its parameter, both ends included."""
SAME_PLACE = 1e-6
"""Distance in mm within which two points are one."""
SAME_WAY = 1e-6
"""Radians within which two normals are one."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Boundary:
    """What bounds a shape.

    Attributes:
        vertices: (v, 3) each once.
        edges: (e, EDGE_POINTS, 3) points of each edge of a face, once.
        edge_faces: (e, 2) the faces on which each lies; -1 in the place of a second one that is not there.
        surfaces: (f, 9) the surface of each face as in `ShapeFacts`; not numbers where it is of another kind.
    """

    vertices: Array
    edges: Array
    edge_faces: IntArray
    surfaces: Array


def difference(found: Boundary, wanted: Boundary) -> str | None:
    """What tells the found shape from the wanted one, as "has 3 faces instead of 6"; None where they are the same."""
    counts = (
        ("vertices", found.vertices, wanted.vertices),
        ("edges", found.edges, wanted.edges),
        ("faces", found.surfaces, wanted.surfaces),
    )
    for what, own, other in counts:
        if len(own) != len(other):
            return f"has {len(own)} {what} instead of {len(other)}"
    _, off = _pairs(_vertices_apart(found, wanted))
    if not off <= SAME_PLACE:
        return f"has a vertex {off:.3g} mm from its place"
    edges, off = _pairs(_edges_apart(found, wanted))
    if not off <= SAME_PLACE:
        return f"has an edge {off:.3g} mm from its place"
    return _faces_differ(found, wanted, edges)


def edges_off(found: Boundary, wanted: Boundary) -> float:
    """How far, mm, the farthest vertex or edge lies off; infinite where they do not pair off one to one."""
    if found.vertices.shape != wanted.vertices.shape or found.edges.shape != wanted.edges.shape:
        return np.inf
    return max(_pairs(_vertices_apart(found, wanted))[1], _pairs(_edges_apart(found, wanted))[1])


def _vertices_apart(found: Boundary, wanted: Boundary) -> Array:
    """(v, v) distances of the wanted vertices from those found."""
    return np.asarray(norm(wanted.vertices[:, None] - found.vertices))


def _edges_apart(found: Boundary, wanted: Boundary) -> Array:
    """(e, e) how far the wanted edges lie from those found, whichever way they run."""
    ways = (wanted.edges, wanted.edges[:, ::-1])
    return np.asarray(np.minimum(*(norm(way[:, None] - found.edges).max(axis=-1) for way in ways)))


def _pairs(apart: Array) -> tuple[IntArray, float]:
    """Which one found belongs to each that is wanted, and how far off the farthest is; infinite if one serves twice."""
    if not len(apart):
        return np.zeros(0, dtype=np.intp), 0.0
    nearest = apart.argmin(axis=1)
    off = float(apart.min(axis=1).max())
    return nearest, off if len(np.unique(nearest)) == len(nearest) else np.inf


def _faces_differ(found: Boundary, wanted: Boundary, edges: IntArray) -> str | None:
    """What tells the faces apart, where the found edges are known by the wanted ones."""
    bounded = {_edges_of(found, face): face for face in range(len(found.surfaces))}
    faces = []
    for face in range(len(wanted.surfaces)):
        place = bounded.get(frozenset(edges[list(_edges_of(wanted, face))].tolist()))
        if place is None:
            return "has a face with other edges"
        faces.append(place)
    edge, side = np.nonzero(wanted.edge_faces >= 0)
    of = wanted.edge_faces[edge, side]
    own = found.surfaces[np.array(faces, dtype=np.intp)[of]]
    return _surfaces_differ(own, wanted.surfaces[of], wanted.edges[edge])


def _edges_of(boundary: Boundary, face: int) -> frozenset[int]:
    return frozenset(np.flatnonzero((boundary.edge_faces == face).any(axis=1)).tolist())


def _surfaces_differ(found: Array, wanted: Array, points: Array) -> str | None:
    """What tells surfaces (m, 9) apart from others at points (m, k, 3) on them."""
    if not _same_kind(found, wanted).all():
        return "has a face of another kind"
    known = _known(wanted)
    heights, turns = _apart(found[known], wanted[known], points[known])
    off, turned = heights.max(initial=0.0), turns.max(initial=0.0)
    if not off <= SAME_PLACE:
        return f"has a face {off:.3g} mm from its place"
    if not turned <= SAME_WAY:
        return f"has a face that looks {min(turned, 2.0):.3g} rad another way"
    return None


def surfaces_agree(found: Array, wanted: Array, points: Array) -> BoolArray:
    """(m,) whether surfaces (m, 9) are others, as far as points (m, k, 3) on them tell."""
    agree, known = _same_kind(found, wanted), _known(wanted)
    heights, turns = _apart(found[known], wanted[known], points[known])
    agree[known] &= (heights <= SAME_PLACE) & (turns <= SAME_WAY)
    return agree


def _same_kind(found: Array, wanted: Array) -> BoolArray:
    """(m,) whether both are flat, or both round, or both of a kind that is not known."""
    known = _known(wanted)
    return np.asarray((_known(found) == known) & ((_round(found) == _round(wanted)) | ~known))


def _apart(found: Array, wanted: Array, points: Array) -> tuple[Array, Array]:
    """(m,) how far points (m, k, 3) lie off surfaces (m, 9), mm, and (m,) how far normals are from others, at most."""
    heights = np.abs(_height(points, found[:, None]))
    turns = norm(surface_normals(points, found[:, None]) - surface_normals(points, wanted[:, None]))
    return np.asarray(heights.max(axis=-1, initial=0.0)), np.asarray(turns.max(axis=-1, initial=0.0))


def _known(surfaces: Array) -> BoolArray:
    return np.asarray(~np.isnan(surfaces[:, 0]))


def _round(surfaces: Array) -> BoolArray:
    return np.asarray(surfaces[:, 6] > 0.0)


def _height(points: Array, surfaces: Array) -> Array:
    """(..., ) signed distances of points (..., 3) from surfaces (..., 9)."""
    axis, half_angle = surfaces[..., 3:6], surfaces[..., 7]
    offset = points - surfaces[..., 0:3]
    along = dot(offset, axis)
    radius = norm(offset - along[..., None] * axis)
    beside = (radius - surfaces[..., 6]) * np.cos(half_angle) - along * np.sin(half_angle)
    return np.asarray(np.where(surfaces[..., 6] > 0.0, beside, along))
