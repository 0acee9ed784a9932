"""The drawn edges that lie on no seam: the free outline of the surface, edge by edge."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.geometry.vectors import norm, unit
from cadpanel.reference.model import Reference

# Lines go on straight beyond their ends by this share of their length: a corner may slide along the outline.
_BEYOND = 0.25


@dataclass(frozen=True, slots=True, kw_only=True)
class FreeEdges:
    """f free edges.

    Attributes:
        panels: (f,) whose.
        edges: (f,) which of the panel's.
        lines: (f, r, 3) points of the drawn ones, mm, which go on straight beyond their ends; one that has fewer points
            than another stands still at its end.
    """

    panels: IntArray
    edges: IntArray
    lines: Array


def free_edges(reference: Reference) -> FreeEdges:
    """All free edges, panel by panel."""
    on_seams = {place for seam in reference.seams for place in zip(seam.panels, seam.edges, strict=True)}
    places = [
        (panel, edge)
        for panel, one in enumerate(reference.panels)
        for edge in range(len(one.edges))
        if (panel, edge) not in on_seams
    ]
    drawn = [reference.panels[panel].edges[edge] for panel, edge in places]
    lines = np.zeros((len(places), 2 + max(map(len, drawn), default=0), 3))
    sizes = np.zeros(len(places))
    for row, line in enumerate(drawn):
        lines[row, 1 : len(line) + 1] = line
        sizes[row] = norm(np.diff(line, axis=0)).sum()
    first, last = (np.array([line[end] for line in drawn]).reshape(-1, 3) for end in (0, -1))
    inner = (np.array([line[end] for line in drawn]).reshape(-1, 3) for end in (1, -2))
    ahead = [unit(end - beside) for end, beside in zip((first, last), inner, strict=True)]
    beyond = _BEYOND * sizes[:, None]
    lines[:, 0] = first + beyond * ahead[0]
    ends = last + beyond * ahead[1]
    for row, line in enumerate(drawn):
        lines[row, len(line) + 1 :] = ends[row]
    panels, edges = np.array(places, dtype=np.intp).reshape(-1, 2).T
    return FreeEdges(panels=panels, edges=edges, lines=lines)
