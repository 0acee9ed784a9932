"""The reference as a thin surface and an outline to look at, from its samples alone. Millimetres."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.spatial import Delaunay, QhullError, cKDTree

from cadpanel.arrays import Array, IntArray
from cadpanel.geometry.polyline import inside_edges
from cadpanel.geometry.skin_mesh import SkinMesh
from cadpanel.reference.model import PanelReference

_ROUND, _INSIDE = 64, 96
"""Points that are shown of an outline and of the samples inside it, at most; of more every second one, or third."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Ghost:
    """What a panel approximates.

    Attributes:
        points: (v, 3) the first of them all round its outline, the others inside, mm.
        outline: how many lie on the outline.
        triangles: (f, 3) between them; none where the samples do not make a surface.
    """

    points: Array
    outline: int
    triangles: IntArray


def ghost(reference: PanelReference, mesh: SkinMesh) -> Ghost:
    """A panel's reference; its points are joined as they lie on the chart of the fitted skin's mesh."""
    outline = _thinned(outline_of(reference), _ROUND)
    points = np.concatenate([outline, _thinned(reference.points, _INSIDE)])
    flat = _on_chart(points, mesh)
    try:
        triangles = Delaunay(flat).simplices.astype(np.intp)
    except QhullError:  # all on one line, as far as the chart can tell
        triangles = np.empty((0, 3), dtype=np.intp)
    rim = flat[: len(outline)]
    inside = inside_edges(flat[triangles].mean(axis=1), rim, np.roll(rim, -1, axis=0))
    return Ghost(points=points, outline=len(outline), triangles=triangles[inside])


def outline_of(reference: PanelReference) -> Array:
    """(q, 3) the outline as one round, each corner once, mm."""
    edges = reference.edges
    if reference.four_sided:
        (end_0, end_1), (side_0, side_1) = reference.ends, reference.sides
        edges = (end_0, side_1, end_1[::-1], side_0[::-1])
    return np.concatenate([edge[:-1] for edge in edges])


def _thinned(points: Array, most: int) -> Array:
    return points[:: math.ceil(len(points) / most)]


def _on_chart(points: Array, mesh: SkinMesh) -> Array:
    """(m, 2) where points near a mesh lie on its chart: beside their nearest vertices."""
    _, nearest = cKDTree(mesh.points).query(points)
    beside = np.einsum("mwx,mx->mw", mesh.ways[nearest], points - mesh.points[nearest])
    return np.asarray(mesh.chart[nearest] + beside)
