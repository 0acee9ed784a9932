"""The pieces of a panel's edges by which their turn is told: from corner to corner, an arc in two halves."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.features.panel_edges import ARC_SHARES, Edge

SHORT = 0.1
"""A piece counts as at least this share of its edge: what is shorter cannot be seen to lean."""
_MIDDLE = ARC_SHARES.index(1 / 2)


@dataclass(frozen=True, slots=True, kw_only=True)
class EdgePieces:
    """The pieces of one panel's edges.

    Attributes:
        edge: (n,) which edge each lies on.
        points: (n, 2) its ends: 0 and more for the panel's corners, -1 and less for its arc points.
    """

    edge: IntArray
    points: IntArray


def places(points: IntArray, corners: int) -> IntArray:
    """Places of such points where arc points stand after so many corners."""
    return np.where(points < 0, corners - 1 - points, points)


def boundary_points(edge: Edge) -> list[int]:
    """The corners and arc points of an edge, as `EdgePieces.points` tells them."""
    return [*edge.corners, *(-1 - arc for arc in edge.arcs)]


def edge_pieces(edges: tuple[Edge, ...]) -> EdgePieces:
    """The pieces of edges."""
    found = []
    for place, edge in enumerate(edges):
        arcs = iter(range(0, len(edge.arcs), len(ARC_SHARES)))
        for piece, (first, last) in enumerate(zip(edge.corners[:-1], edge.corners[1:], strict=True)):
            stops = [first, last]
            if edge.curved[piece]:
                stops.insert(1, -1 - edge.arcs[next(arcs) + _MIDDLE])
            found += [(place, *pair) for pair in pairwise(stops)]
    table = np.array(found, dtype=np.intp)
    return EdgePieces(edge=table[:, 0], points=table[:, 1:])


def turns(ends: Array, planes: Array, lengths: Array) -> Array:
    """(...) sines of the angles between pieces with these ends (..., 2, 3) and the planes with the normals (..., 3).

    Args:
        ends: from which point to which, in any unit.
        planes: unit normals of the planes in which the drawing has the edges.
        lengths: (...) of the drawn edges, in the same unit.
    """
    across = ends[..., 1, :] - ends[..., 0, :]
    size = np.sqrt(np.einsum("...x,...x->...", across, across))
    # Where nothing is limited a piece has no length at all.
    counted = np.maximum(np.maximum(size, SHORT * lengths), np.finfo(float).tiny)
    sines: Array = np.einsum("...x,...x->...", across, planes) / counted
    return sines
