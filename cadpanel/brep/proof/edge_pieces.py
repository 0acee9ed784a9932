"""Which edges of a shape in a file make up one edge of a panel; they are told by the panel's corners. Millimetres."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.brep.proof.shape_facts import ShapeFacts
from cadpanel.geometry.shape import edge_corners


def edge_pieces(facts: ShapeFacts, corners: Array, edge: str) -> IntArray | None:
    """(m - 1,) the places among a shape's pieces of those along one edge, corner after corner.

    None where they do not make it up: an end of each is nearest to either of two corners that follow each other.

    Args:
        facts: the shape; of a sheet the pieces are those of the face that has these corners.
        corners: of the panel, in rows.
        edge: "end 0" and so on.
    """
    try:
        own = edge_corners(corners, edge)
    except ValueError:
        return None
    flat = corners.reshape(-1, 3)
    places = _nearest(flat, facts.piece_ends)
    wanted = np.linalg.norm(own[:, None] - flat, axis=-1).argmin(axis=-1)
    near = np.linalg.norm(flat[places] - facts.piece_ends, axis=-1).max(axis=-1, initial=0.0)
    found = []
    for first, last in pairwise(wanted.tolist()):
        joins = np.flatnonzero((np.sort(places, axis=-1) == sorted((first, last))).all(axis=-1))
        if not len(joins):
            return None
        found.append(joins[near[joins].argmin()])
    return np.array(found, dtype=np.intp)


def _nearest(corners: Array, points: Array) -> IntArray:
    return np.asarray(np.linalg.norm(points[..., None, :] - corners, axis=-1).argmin(axis=-1))
