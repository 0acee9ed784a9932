"""Folded flat panels: a quadrilateral, and one whose walls lean by given amounts."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cadpanel.geometry.panel import CutPlane
from cadpanel.geometry.returns import ReturnRule
from cadpanel.geometry.shape import PolygonShape
from cadpanel.geometry.sheet_checks import SkinSide, sheet_depth
from cadpanel.geometry.trays import TrayShape, foldable_edges, folded_tray

RULE = ReturnRule(length=30.0, inner_radius=2.5)
THICKNESS = 3.0


def flat(leans: Sequence[float], skin_side: SkinSide = "outer", scale: float = 1.0) -> PolygonShape:
    """A panel of about a metre with as many edges as leans, turned in space."""
    turns = 2.0 * np.pi * (np.arange(len(leans)) + 0.2 * np.sin(np.arange(len(leans)))) / len(leans)
    x, y, normal = np.linalg.qr(np.array([[1.0, 0.3, -0.2], [0.1, 1.0, 0.4], [0.2, -0.1, 1.0]]).T)[0].T
    normal = np.cross(x, y)
    corners = 600.0 * scale * (np.outer(np.cos(turns), x) + np.outer(np.sin(turns), y)) + [5000.0, -3000.0, 800.0]
    shape = PolygonShape(name="T", feature="planar-polygon", outline=corners, normal=normal)
    planes = {}
    for edge, lean in enumerate(leans):
        own = shape.edge(f"edge {edge}")
        out = own.outward - lean * normal
        planes[f"edge {edge}"] = CutPlane(point=own.corners[0], normal=out / np.linalg.norm(out))
    return shape.cut_back(planes, sheet_depth(THICKNESS, skin_side))


def tray(
    leans: Sequence[float] = (0.08, -0.05, 0.0, 0.12),
    skin_side: SkinSide = "outer",
    edges: tuple[str, ...] | None = None,
    scale: float = 1.0,
) -> TrayShape:
    """The same with returns along some edges, or all that are long enough."""
    shape = flat(leans, skin_side, scale)
    found = foldable_edges(shape, RULE, THICKNESS, skin_side)[0] if edges is None else edges
    return folded_tray(shape, found, RULE, THICKNESS, skin_side)
