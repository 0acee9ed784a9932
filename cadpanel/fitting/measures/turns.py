"""How far fitted panels' edges turn from the drawing's, how level they are, and how evenly they follow one another."""

from __future__ import annotations

import numpy as np

from cadpanel.arrays import Array
from cadpanel.features.edge_pieces import boundary_points, edge_pieces, places, turns
from cadpanel.features.panel_edges import ARC_SHARES
from cadpanel.fitting.measures.edges import Alike, PanelEdges
from cadpanel.reference.across_seams import across_seams, unevenness
from cadpanel.reference.edge_planes import edge_planes, turned_edges
from cadpanel.reference.level_seams import level_edges
from cadpanel.reference.model import Reference


def edge_turns(edges: PanelEdges, reference: Reference) -> Array:
    """(panels, most edges) largest angle of a piece of each edge with the plane of the drawn one, radians.

    Of edges that may turn it is 0, see `reference.edge_planes.turned_edges`.
    """
    planes, lengths = edge_planes(reference.panels)
    found = np.zeros(lengths.shape)
    for group in edges.groups:
        own, count = group.members, _corners(group)
        pieces, points = edge_pieces(group.edges), _boundary(group, edges)
        sines = turns(
            points[:, places(pieces.points, count)], planes[own][:, pieces.edge], lengths[own][:, pieces.edge]
        )
        for edge in range(len(group.edges)):
            largest = np.abs(sines[:, pieces.edge == edge]).max(axis=1)
            found[own, edge] = np.arcsin(np.minimum(largest, 1.0))
    return np.where(turned_edges(reference), found, 0.0)


def off_level(edges: PanelEdges, reference: Reference) -> Array:
    """(panels,) the largest distance of a place on a level seam from its drawn plane, mm; nan where there is none.

    As it is held: at corners, and at points on arcs.
    """
    level = level_edges(reference)
    found = np.full(len(reference.panels), np.nan)
    for group in edges.groups:
        boundary, row = _boundary(group, edges), np.full(len(found), -1)
        row[group.members] = np.arange(len(group.members))
        for place, edge in enumerate(group.edges):
            own = np.flatnonzero((row[level.panels] >= 0) & (level.edges == place))
            rows = row[level.panels[own]]
            points = boundary[rows[:, None], places(np.array(boundary_points(edge)), _corners(group))]
            off = np.einsum("rqx,rx->rq", points + edges.centre - level.points[own][:, None], level.normals[own])
            found[group.members[rows]] = np.fmax(found[group.members[rows]], np.abs(off).max(axis=1, initial=0.0))
    return found


def _corners(group: Alike) -> int:
    return int(group.corners.shape[1] * group.corners.shape[2])


def _boundary(group: Alike, edges: PanelEdges) -> Array:
    """(m, corners + arcs, 3) corners, then points inside the arcs of both ends, from the middle of all."""
    corners = group.corners.reshape(len(group.members), _corners(group), 3) - edges.centre
    return np.concatenate([corners, _arcs(group, edges)], axis=1)


def _arcs(group: Alike, edges: PanelEdges) -> Array:
    """(m, arcs, 3) points inside the arcs of both ends, end by end."""
    own = len(group.members)
    shares = [i + share for i, curved in enumerate(group.edges[0].curved) if curved for share in ARC_SHARES]
    if not shares:
        return np.zeros((own, 0, 3))
    at = np.tile(shares, (own, 1))
    return np.concatenate([group.curves(end, edges.centre).follow(at)[0] for end in (0, 1)], axis=1)


def seam_unevenness(edges: PanelEdges, reference: Reference) -> Array:
    """(seams,) see `reference.across_seams.unevenness`, mm; 0 where a panel has no ends."""
    drift = np.zeros((len(reference.panels), 4, 3))
    for group in edges.groups:
        if group.four_sided:
            drawn = np.array([reference.panels[i].corners for i in group.members.tolist()])
            drift[group.members] = (group.corners[:, :, [0, -1]] - drawn).reshape(-1, 4, 3)
    met = across_seams(reference.panels, reference.seams)
    found = np.zeros(len(reference.seams))
    found[met.index] = unevenness(drift, met).max(axis=1, initial=0.0)
    return found
