"""The plane in which two panels meet at a seam, and what of a panel's edge decides it. Millimetres."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from cadpanel.arrays import Array
from cadpanel.errors import PanelError
from cadpanel.geometry.panel import CutPlane, Panel, PanelEdge
from cadpanel.geometry.vectors import cross, unit

STEEPEST_WALL = np.sin(np.radians(10.0))
"""Least cosine between a wall's normal and the way out of the sheet: beyond it the sheet would end in a blade."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SeamEdges:
    """Two panels that meet: their places in a list, and the edge of each, "end 1" or "edge 3".

    Attributes:
        joint: clear width between the two sheets, mm, where it is another than that of all.
    """

    panels: tuple[int, int]
    edges: tuple[str, str]
    joint: float | None = None

    def width(self, of_all: float) -> float:
        """The clear width of its joint where all others have `of_all`, mm."""
        return of_all if self.joint is None else self.joint


def seam_plane(panels: tuple[Panel, Panel], edges: tuple[str, str]) -> CutPlane:
    """The plane in the middle of a seam, its normal out of the first panel.

    It halves the angle between the two skins along straight edges. An edge that bends lies in the plane in which the
    fit has cut it, and that of the seam is the mean of the two. The farthest corner on one side of it is as far away as
    the farthest on the other.

    Raises:
        PanelError: the two skins fold back on each other.
    """
    first, second = (panel.edge(edge) for panel, edge in zip(panels, edges, strict=True))
    normal = _bisector(first, second)
    if min(normal @ first.outward, -(normal @ second.outward)) < STEEPEST_WALL:
        raise PanelError(
            panels[0].name,
            f"it folds back on '{panels[1].name}' at its {edges[0]}, and no wall can stand between the two: leave one "
            "of them out, or move the joint away from the crease.",
        )
    corners = np.concatenate([first.corners, second.corners])
    heights = (corners - corners[0]) @ normal
    middle = 0.5 * (heights.min() + heights.max())
    centre = corners.mean(axis=0)
    return CutPlane(point=centre + (middle - (centre - corners[0]) @ normal) * normal, normal=normal)


def _bisector(first: PanelEdge, second: PanelEdge) -> Array:
    """(3,) the unit normal of the seam's plane, out of the first panel."""
    if first.normal is None or second.normal is None:
        bent = [sign * edge.outward for sign, edge in ((1.0, first), (-1.0, second)) if edge.normal is None]
        return np.asarray(unit(np.sum(bent, axis=0)))
    ways = [edge.corners[-1] - edge.corners[0] for edge in (first, second)]
    along = unit(ways[0]) + np.sign(ways[0] @ ways[1]) * unit(ways[1])
    normal = unit(cross(along, first.normal + second.normal))
    return np.asarray(np.sign(normal @ (first.outward - second.outward)) * normal)


def farthest(plane: CutPlane, panel: Panel, edge: str) -> float:
    """How far from a plane the farthest corner of a panel's edge lies, mm."""
    return float(np.abs(plane.beyond(panel.edge(edge).corners)).max())


def turned_round(plane: CutPlane) -> CutPlane:
    """The same plane, its normal the other way."""
    return replace(plane, normal=-plane.normal)
