"""Closed surfaces of triangles: corners that lie on one another made one, and what such a surface encloses."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from cadpanel.arrays import Array, IntArray


@dataclass(frozen=True, slots=True, kw_only=True)
class Triangles:
    """A surface of triangles.

    Attributes:
        points: (v, 3) corners.
        normals: (v, 3) outward unit normals of the surface that the triangles stand for; a corner on an edge between
            two faces is there twice.
        corners: (t, 3) the three points of each triangle, counterclockwise seen from outside.
    """

    points: Array
    normals: Array
    corners: IntArray

    def volume(self) -> float:
        """What is enclosed; positive where normals point outwards. Exact for any origin near the points."""
        places = self.points - self.points.mean(axis=0)
        first, second, third = (places[self.corners[:, side]] for side in range(3))
        return float(np.einsum("ij,ij->i", first, np.cross(second, third)).sum() / 6.0)


def merged(points: Array, within: float) -> tuple[Array, IntArray]:
    """Points (v, 3) of which those that lie within a distance of each other are one: (m, 3), and each point's place.

    Which points belong together must not hang on a digit: they lie on one another, or far apart.
    """
    pairs = cKDTree(points).query_pairs(within, output_type="ndarray")
    graph = coo_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(len(points), len(points)))
    _, labels = connected_components(graph, directed=False)
    # In the order in which they come first, which is the same wherever this runs.
    _, first, place = np.unique(labels, return_index=True, return_inverse=True)
    order = np.argsort(first)
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    return points[first[order]], rank[place]


def is_closed(corners: IntArray) -> bool:
    """Whether every side of every triangle (t, 3) is run through once each way."""
    sides = np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]])
    ways, counts = np.unique(sides, axis=0, return_counts=True)
    back = np.unique(sides[:, ::-1], axis=0)
    return bool((counts == 1).all() and ways.shape == back.shape and (ways == back).all())


SHOWN_DEVIATION = 1.0
"""How far FreeCAD's triangles may lie from a panel, percent of its size; FreeCAD's own is 0.5."""


def shown_deflection(points: Array, deviation: float = SHOWN_DEVIATION) -> float:
    """How far triangles may lie from the shape that they show in FreeCAD, mm.

    Args:
        points: (n, 3) corners of all triangles.
        deviation: percent of a third of length, width and height together.
    """
    return float(np.ptp(points, axis=0).sum()) / 300.0 * deviation
