"""Corners of a mesh that coincide become one: many programs give each face corners of its own."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from cadpanel.arrays import Array

Faces = tuple[tuple[int, ...], ...]


def welded(corners: Array, faces: Sequence[Sequence[int]], tolerance: float) -> tuple[Faces, int]:
    """Faces that share the corners which coincide, and how many corners gave way to an earlier one.

    The corners keep their numbers; of those that coincide the first counts. A face loses a corner that coincides with
    its neighbour on that face.

    Args:
        corners: (n, 3) finite, mm.
        faces: the corners of each, in order round it.
        tolerance: corners coincide whose coordinates differ by no more, mm.
    """
    pairs = cKDTree(corners).query_pairs(tolerance, p=np.inf, output_type="ndarray")
    count = len(corners)
    graph = coo_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(count, count))
    _, group = connected_components(graph, directed=False)
    first = np.unique(group, return_index=True)[1][group]
    kept = tuple(_without_repeats(first[list(face)].tolist()) for face in faces)
    return kept, int(np.count_nonzero(first != np.arange(count)))


def _without_repeats(face: list[int]) -> tuple[int, ...]:
    return tuple(corner for before, corner in zip([face[-1], *face[:-1]], face, strict=True) if corner != before)
