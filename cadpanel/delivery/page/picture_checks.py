"""Whether the pictures of a page are of the panels that a report tells of: on their faces, out to their corners."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.spatial import cKDTree

from cadpanel.arrays import Array
from cadpanel.delivery.page.packing import LEVELS
from cadpanel.delivery.page.scene import PanelScene
from cadpanel.fitting.measures.deviation import deviations
from cadpanel.geometry.panel import Panel
from cadpanel.geometry.trays import TrayShape

_ROUNDING = 1e-3
"""What boxes and facets are rounded by besides, mm."""


def off_their_panels(shown: Iterator[tuple[PanelScene, Panel]], depth: float) -> Iterator[str]:
    """The names of panels whose pictures lie elsewhere.

    Args:
        shown: panels as a page shows them, each with what the report tells of it.
        depth: from the skin to the sheet's other face, mm along the skin's normal.
    """
    for panel, shape in shown:
        faces = ((panel.points, shape), (panel.other, shape.offset(depth)))
        if any(_off(points, face) for points, face in faces):
            yield panel.name


def _off(points: Array, face: Panel) -> bool:
    """Whether points are not of a face, further than they are rounded: away from it, or short of a corner."""
    allowed = _ROUNDING + float(np.linalg.norm(np.ptp(points, axis=0))) / LEVELS
    corners = face.vertices() if isinstance(face, TrayShape) else face.corners().reshape(-1, 3)
    if not np.max(cKDTree(points).query(corners)[0]) <= allowed:
        return True
    if isinstance(face, TrayShape):
        return False
    return not np.abs(deviations([face], points[None])).max() <= allowed
