"""Which of many boundaries are what they should be, all at once: the quick way to what `difference` says of each.

Whatever passes here is the same shape by the same limits. What does not may be the same still (two edges with one
middle, say), so `difference` is asked what tells it apart.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.brep.proof.boundary import EDGE_POINTS, SAME_PLACE, Boundary, surfaces_agree
from cadpanel.geometry.curve_pieces import BoolArray
from cadpanel.geometry.vectors import norm

MOST_EDGES = 62
"""Of a shape that is looked at here: the edges of a face are the bits of a number."""
TOGETHER = 256
"""Shapes that are compared at once, so that what is worked out of them stays small."""


def same_boundaries(found: Sequence[Boundary], wanted: Sequence[Boundary]) -> BoolArray:
    """(n,) which of the found boundaries are seen to be the wanted ones."""
    groups: dict[tuple[int, int, int], list[int]] = {}
    for place, (own, other) in enumerate(zip(found, wanted, strict=True)):
        kind = _counts(own)
        if kind == _counts(other) and min(kind) > 0 and kind[1] <= MOST_EDGES:
            groups.setdefault(kind, []).append(place)
    same = np.zeros(len(found), dtype=bool)
    for places in groups.values():
        for first in range(0, len(places), TOGETHER):
            some = places[first : first + TOGETHER]
            same[some] = _same([found[place] for place in some], [wanted[place] for place in some])
    return same


def _counts(boundary: Boundary) -> tuple[int, int, int]:
    return len(boundary.vertices), len(boundary.edges), len(boundary.surfaces)


def _same(found: Sequence[Boundary], wanted: Sequence[Boundary]) -> BoolArray:
    """The same of boundaries with as many vertices, edges and faces each."""
    vertices, others = (np.array([own.vertices for own in some]) for some in (found, wanted))
    pairs, same = _pairs(vertices, others)
    same &= (norm(_taken(vertices, pairs) - others) <= SAME_PLACE).all(axis=1)
    edges, others = (np.array([own.edges for own in some]) for some in (found, wanted))
    pairs, unique = _pairs(edges[:, :, EDGE_POINTS // 2], others[:, :, EDGE_POINTS // 2])
    edges = _taken(edges, pairs)
    apart = np.minimum(*(norm(way - others).max(axis=-1) for way in (edges, edges[:, :, ::-1])))
    same &= unique & (apart <= SAME_PLACE).all(axis=1)
    faces, other_faces = (np.array([own.edge_faces for own in some]) for some in (found, wanted))
    surfaces, other_surfaces = (np.array([own.surfaces for own in some]) for some in (found, wanted))
    faces = faces[np.arange(len(faces))[:, None], pairs]
    turn, bounded = _face_pairs(faces, other_faces, surfaces.shape[1])
    same &= bounded
    shape, edge, side = np.nonzero(other_faces >= 0)
    of = other_faces[shape, edge, side]
    agree = surfaces_agree(surfaces[shape, turn[shape, of]], other_surfaces[shape, of], others[shape, edge])
    same[shape[~agree]] = False
    return same


def _pairs(found: Array, wanted: Array) -> tuple[IntArray, BoolArray]:
    """(n, k) which of k found points is nearest to each that is wanted, and (n,) whether none serves twice."""
    apart = norm(wanted[:, :, None] - found[:, None])
    nearest = apart.argmin(axis=-1)
    return nearest, np.asarray((np.sort(nearest, axis=1) == np.arange(nearest.shape[1])).all(axis=1))


def _taken(rows: Array, places: IntArray) -> Array:
    """(n, k, ...) of each of n tables the rows at its own places (n, k)."""
    return np.asarray(rows[np.arange(len(rows))[:, None], places])


def _face_pairs(found: IntArray, wanted: IntArray, faces: int) -> tuple[IntArray, BoolArray]:
    """(n, f) which found face has the edges of each wanted one, and (n,) whether all have one to themselves."""
    own, other = _bits(found, faces), _bits(wanted, faces)
    turn, other_turn = own.argsort(axis=1), other.argsort(axis=1)
    ordered = np.take_along_axis(own, turn, axis=1)
    alike = (ordered == np.take_along_axis(other, other_turn, axis=1)).all(axis=1)
    alike &= (np.diff(ordered, axis=1) > 0).all(axis=1)
    pairs = np.empty_like(turn)
    np.put_along_axis(pairs, other_turn, turn, axis=1)
    return pairs, np.asarray(alike)


def _bits(edge_faces: IntArray, faces: int) -> IntArray:
    """(n, f) the edges of each face as the bits of a number."""
    bounds = (edge_faces[:, :, :, None] == np.arange(faces)).any(axis=2)
    return np.asarray((bounds * (1 << np.arange(bounds.shape[1], dtype=np.int64))[:, None]).sum(axis=1))
