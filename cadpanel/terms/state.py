"""What the terms see: the panels walked at the current unknowns, in each panel's own frame and in common units."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from cadpanel.arrays import Array
from cadpanel.features.layout import Layout
from cadpanel.features.rulings import PanelFeature, Points, Rulings, Walk
from cadpanel.features.walk import arc_rulings
from cadpanel.terms.surfaces import CutPlanes, Surfaces, cut_planes_of, surfaces_of


@dataclass(frozen=True)
class State:
    """The panels at one set of unknowns; points are worked out when a term first asks for them.

    Attributes:
        layout: which panels have which feature.
        walks: one a group: rulings and their twists, in the panels' frames, lengths in units of the solver's length.
    """

    layout: Layout
    walks: tuple[Walk, ...]

    @cached_property
    def own_corners(self) -> tuple[Points, ...]:
        """For each group the corners (n, corners, 3), and their derivatives (n, corners, 3, N) by its numbers."""
        pairs = zip(self.layout.groups, self.walks, strict=True)
        return tuple(group.feature.corners(walked) for group, walked in pairs)

    @cached_property
    def corners(self) -> Points:
        """Corners (panels, corners, 3), and their derivatives (panels, corners, 3, size) by the unknowns."""
        return self._points(self.own_corners)

    @cached_property
    def arcs(self) -> Points:
        """Points inside the conic arcs of the ends (panels, arcs, 3), and their derivatives."""
        pairs = zip(self.layout.groups, self.walks, strict=True)
        return self._points([group.feature.arcs(walked) for group, walked in pairs])

    @cached_property
    def normals(self) -> Points:
        """The skins' unit normals (panels, corners, 3) at the corners, and their derivatives."""
        pairs = zip(self.layout.groups, self.walks, strict=True)
        return self._points([_corner_normals(group.feature, walked) for group, walked in pairs])

    @cached_property
    def boundary_normals(self) -> Points:
        """The skins' unit normals at the corners and at the arc points after each other, and their derivatives."""
        inside = self._points([_arc_normals(walked) for walked in self.walks])
        position = np.concatenate([self.normals.position, inside.position], axis=1)
        if self.normals.jacobian is None or inside.jacobian is None:
            return Points(position, None)
        return Points(position, np.concatenate([self.normals.jacobian, inside.jacobian], axis=1))

    @cached_property
    def boundary(self) -> Points:
        """Corners and arc points after each other, and their derivatives."""
        position = np.concatenate([self.corners.position, self.arcs.position], axis=1)
        if self.corners.jacobian is None or self.arcs.jacobian is None:
            return Points(position, None)
        return Points(position, np.concatenate([self.corners.jacobian, self.arcs.jacobian], axis=1))

    @cached_property
    def surfaces(self) -> Surfaces:
        """The patches of all panels."""
        return surfaces_of(self.layout, self.walks)

    @cached_property
    def cuts(self) -> CutPlanes:
        """The planes that cut the ends of all panels."""
        return cut_planes_of(self.layout, self.walks)

    def _points(self, found: Sequence[Points]) -> Points:
        position = self.layout.gather([points.position for points in found])
        slopes = [
            group.feature.by_unknowns(points.jacobian)
            for group, points in zip(self.layout.groups, found, strict=True)
            if points.jacobian is not None
        ]
        return Points(position, self.layout.gather(slopes) if len(slopes) == len(found) else None)


def _corner_normals(feature: PanelFeature, walked: Walk) -> Points:
    """Those of the rulings that end there, end by end, or of a polygon's one plane all round."""
    rulings = walked.edges if walked.edges.p.shape[1] else walked.anchor
    rounds = feature.corner_count // rulings.n.shape[1]
    return _normals(rulings, rounds)


def _arc_normals(walked: Walk) -> Points:
    """Those of the rulings inside curved patches, end by end; none of polygons."""
    inside = arc_rulings(walked) if walked.edges.p.shape[1] else walked.edges
    return _normals(inside, 2)


def _normals(rulings: Rulings, rounds: int) -> Points:
    """The skins' normals along rulings, so many times after each other."""
    normals = np.tile(rulings.n, (1, rounds, 1))
    if rulings.twist is None:
        return Points(normals, None)
    # A direction that is carried with a ruling turns by its twist: dn = omega x n.
    turned = np.cross(rulings.twist[:, :, :3], rulings.n[..., None], axis=2)
    return Points(normals, np.tile(turned, (1, rounds, 1, 1)))


def slopes(points: Points) -> Array:
    """The derivatives of points.

    Raises:
        ValueError: the state was walked without derivatives.
    """
    if points.jacobian is None:
        raise ValueError("the state was walked without derivatives")
    return points.jacobian
