"""How far fitted panels' corners drifted from their references', and which way; millimetres."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.fitting.measures.edges import PanelEdges
from cadpanel.geometry.vectors import dot, norm
from cadpanel.reference.model import Reference
from cadpanel.reference.strip import strips_of


@dataclass(frozen=True, slots=True)
class Drifts:
    """Drift of every panel, mm.

    Attributes:
        whole: (panels,) of the outer corner that drifted most.
        along: (panels,) of the corner, inner ones included, that drifted most along the strip; of a polygon, whose ends
            cannot be told from its sides, the whole drift.
        across: (panels,) of the outer corner that drifted most across its free edge; 0 of a polygon.
    """

    whole: Array
    along: Array
    across: Array


def drifts(edges: PanelEdges, reference: Reference) -> Drifts:
    """The drift of all panels."""
    found = Drifts(*np.zeros((3, len(reference.panels))))
    for group in edges.groups:
        own, measured = group.members, _of_chains if group.four_sided else _of_polygons
        found.whole[own], found.along[own], found.across[own] = measured(group.corners, reference, own)
    return found


def _of_chains(corners: Array, reference: Reference, members: IntArray) -> tuple[Array, Array, Array]:
    """Of n chains with corners (n, 2, k + 1, 3)."""
    strips = strips_of([reference.panels[i] for i in members.tolist()], corners.shape[2])
    along, outer, way = strips.along(corners), strips.outer_drift(corners), strips.direction[:, :, [0, -1]]
    across = outer - dot(outer, way)[..., None] * way
    return norm(outer).max(axis=(1, 2)), along.max(axis=(1, 2)), norm(across).max(axis=(1, 2))


def _of_polygons(corners: Array, reference: Reference, members: IntArray) -> tuple[Array, Array, Array]:
    """Of n polygons with corners (n, 1, c, 3)."""
    own = np.array([reference.panels[i].corners.reshape(-1, 3) for i in members])
    whole = norm(corners[:, 0] - own).max(axis=1)
    return whole, whole, np.zeros(len(members))
