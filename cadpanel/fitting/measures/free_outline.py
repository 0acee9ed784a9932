"""How far the free outline of fitted panels is from the drawn one, as a line; millimetres."""

from __future__ import annotations

import numpy as np

from cadpanel.arrays import Array
from cadpanel.fitting.measures.edges import PanelEdges
from cadpanel.geometry.line_feet import line_feet
from cadpanel.geometry.vectors import norm
from cadpanel.reference.free_edges import free_edges
from cadpanel.reference.model import Reference

# Places along each piece of an edge.
_ALONG = 16


def outline_drift(edges: PanelEdges, reference: Reference) -> Array:
    """(panels,) largest distance of a panel's free edges from the drawn ones, which go on straight; 0 without any."""
    found = np.zeros(len(reference.panels))
    free = free_edges(reference)
    batch, row = edges.batch[free.panels, free.edges], edges.row[free.panels, free.edges]
    for kind in np.unique(batch).tolist():
        own = np.flatnonzero(batch == kind)
        pieces = len(edges.pieces[kind])
        at = np.linspace(0.0, pieces, _ALONG * pieces + 1)
        points = edges.curves[kind].take(row[own]).follow(np.tile(at, (len(own), 1)))[0] + edges.centre
        off = norm(points - line_feet(points, free.lines[own])[0]).max(axis=1)
        np.maximum.at(found, free.panels[own], off)
    return found
