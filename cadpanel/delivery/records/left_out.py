"""Seams that a report leaves out: edges of two panels that meet, and nothing is said of it."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.spatial import cKDTree

from cadpanel.arrays import Array
from cadpanel.delivery.records.report import PanelModel, ReportModel
from cadpanel.geometry.shape import edge_corners

CLOSE = 0.5
"""Share of the tolerance within which edges are a seam on the drawing: edges drawn farther apart may come near."""
CHAIN_EDGES = ("end 0", "end 1", "side 0", "side 1")


def seams_left_out(report: ReportModel) -> Iterator[str]:
    """One sentence for every two edges that meet at both ends, and of which the report tells no seam.

    Edges of which a part meets another panel, as in a brick bond, are not looked for.
    """
    told = {frozenset(zip(seam.panels, seam.edges, strict=True)) for seam in report.seams}
    edges = [(panel, edge) for panel in report.panels for edge in _edges(panel)]
    if not edges:
        return
    ends = np.array([edge_corners(_corners(panel), edge)[[0, -1]] for panel, edge in edges])
    near = CLOSE * report.settings.seam_tolerance
    for i, j in sorted(cKDTree(ends.mean(axis=1)).query_pairs(near)):
        (first, one), (second, other) = edges[i], edges[j]
        ways = (ends[j], ends[j, ::-1])
        apart = min(float(np.linalg.norm(ends[i] - way, axis=1).max()) for way in ways)
        known = frozenset({(first.name, one), (second.name, other)}) in told
        if first.name != second.name and apart <= near and not known:
            yield (
                f"Panels '{first.name}' ({one}) and '{second.name}' ({other}) meet within {apart:.3g} mm, and the "
                "report tells no seam between them."
            )


def _edges(panel: PanelModel) -> tuple[str, ...]:
    return CHAIN_EDGES if len(panel.corners) > 1 else tuple(f"edge {place}" for place in range(len(panel.corners[0])))


def _corners(panel: PanelModel) -> Array:
    """As the fit had them, in rows."""
    return np.array(panel.corners if panel.fitted is None else panel.fitted.corners)
