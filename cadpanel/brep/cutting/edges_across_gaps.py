"""Pieces of faces that lie along each other across a gap within the tolerance, where they share no edge."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from OCP.BRepAdaptor import BRepAdaptor_Curve
from OCP.TopoDS import TopoDS_Edge
from scipy.spatial import cKDTree

from cadpanel.arrays import Array
from cadpanel.geometry.polyline import arc_length, distances_to_polylines
from cadpanel.geometry.vectors import norm

# Points along an edge.
POINTS = 17
# The middles of two edges along each other lie no farther apart than this part of the longer one, or this many
# tolerances; and so many parts of both lie within the tolerance of the other one.
MIDDLES, TOLERANCES, ALONG = 0.05, 5.0, 0.5


def bridges(edges: Sequence[TopoDS_Edge], faces: Sequence[int], tolerance: float) -> list[tuple[int, int]]:
    """Pairs of edges of different faces that lie along each other.

    Args:
        edges: each on the border of one piece alone.
        faces: the face that each one's piece is of.
        tolerance: how far apart they may lie, mm.
    """
    if len(set(faces)) < 2:
        return []
    lines = np.array([points_along(edge) for edge in edges])
    reached = arc_length(lines)
    lengths = reached[:, -1]
    middles = np.array(
        [
            [np.interp(0.5 * along[-1], along, line[:, axis]) for axis in range(3)]
            for along, line in zip(reached, lines, strict=True)
        ]
    )
    reach = np.maximum(TOLERANCES * tolerance, MIDDLES * lengths)
    near = cKDTree(middles).query_ball_point(middles, reach)
    owners = np.asarray(faces)
    pairs = {
        (min(one, other), max(one, other))
        for one, others in enumerate(near)
        for other in others
        if owners[one] != owners[other]
    }
    return sorted(pair for pair in pairs if _along(lines[list(pair)], tolerance))


def _along(lines: Array, tolerance: float) -> bool:
    """Whether two lines (2, q, 3) lie along each other over most of both."""
    there, back = (distances_to_polylines(lines[[k]], lines[[1 - k]])[0] <= tolerance for k in range(2))
    return bool(min(np.mean(there), np.mean(back)) >= ALONG and norm(np.ptp(lines[0], axis=0)) > tolerance)


def points_along(edge: TopoDS_Edge) -> Array:
    """(POINTS, 3) points along an edge, mm."""
    curve = BRepAdaptor_Curve(edge)
    places = np.linspace(curve.FirstParameter(), curve.LastParameter(), POINTS)
    return np.array([curve.Value(place).Coord() for place in places.tolist()])
