"""Corners of a mesh that lie on edges of other faces, as in a brick bond, become corners of those faces, too."""

from __future__ import annotations

from collections import Counter
from itertools import pairwise

import numpy as np
from scipy.spatial import cKDTree

from cadpanel.arrays import Array
from cadpanel.brep.cutting.mesh_weld import Faces
from cadpanel.geometry.vectors import norm

Edge = tuple[int, int]

# How far from an edge a corner may lie to be on it, as a part of the edge's length: over a curved surface the edge is a
# chord, from which the corner is away by the sagitta.
ASIDE = 0.05
# It lies between the edge's ends by at least this part of the length.
INSIDE = 0.02


def parted(corners: Array, faces: Faces) -> tuple[Faces, int]:
    """Faces whose edges are parted at the corners that lie on them, and how many edges that are.

    Only edges that belong to one face alone are looked at, and an edge is parted only if another face then shares each
    of its parts.

    Args:
        corners: (n, 3) mm.
        faces: the corners of each, in order round it.
    """
    found = _hanging(corners, faces)
    while found:
        uses = uses_of(_with(faces, found))
        kept = {
            edge: between
            for edge, between in found.items()
            if all(uses[unordered(*part)] == 2 for part in pairwise((edge[0], *between, edge[1])))
        }
        if len(kept) == len(found):
            break
        found = kept
    return _with(faces, found), len(found)


def _hanging(corners: Array, faces: Faces) -> dict[Edge, tuple[int, ...]]:
    """For each edge of one face alone, as that face runs along it, the corners on it in their order; none left out."""
    uses = uses_of(faces)
    single = [edge for face in faces for edge in round_of(face) if uses[unordered(*edge)] == 1]
    if not single:
        return {}
    on_border = np.unique(np.array(single))
    tree = cKDTree(corners[on_border])
    found: dict[Edge, tuple[int, ...]] = {}
    for first, last in single:
        start, way = corners[first], corners[last] - corners[first]
        length = float(norm(way))
        near = on_border[tree.query_ball_point(start + 0.5 * way, (0.5 + ASIDE) * length)]
        near = near[(near != first) & (near != last)]
        parts = (corners[near] - start) @ way / length**2
        aside = norm(corners[near] - start - parts[:, None] * way)
        on = (parts > INSIDE) & (parts < 1.0 - INSIDE) & (aside <= ASIDE * length)
        if on.any():
            found[first, last] = tuple(near[on][np.argsort(parts[on])].tolist())
    return found


def _with(faces: Faces, hanging: dict[Edge, tuple[int, ...]]) -> Faces:
    """The faces with the corners on their edges put in."""
    if not hanging:
        return faces
    return tuple(
        tuple(corner for edge in round_of(face) for corner in (edge[0], *hanging.get(edge, ()))) for face in faces
    )


def uses_of(faces: Faces) -> Counter[Edge]:
    """How many times faces run along each edge."""
    return Counter(unordered(*edge) for face in faces for edge in round_of(face))


def round_of(face: tuple[int, ...]) -> list[Edge]:
    """The edges of a face, as it runs along them."""
    return list(pairwise((*face, face[0])))


def unordered(first: int, last: int) -> Edge:
    """An edge, whichever way a face runs along it."""
    return (min(first, last), max(first, last))
