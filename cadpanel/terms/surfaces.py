"""Patches and cut planes of all panels in arrays, whatever their features, and how they follow the unknowns."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array, BoolArray, IntArray
from cadpanel.features.cut_planes import unit_cut_plane_rates, unit_cut_planes
from cadpanel.features.distance import middle, patch_outers, skins_of
from cadpanel.features.layout import Layout
from cadpanel.features.rulings import Walk
from cadpanel.geometry.cone import Skins
from cadpanel.geometry.patch_under import outwards
from cadpanel.geometry.vectors import dot


@dataclass(frozen=True, slots=True)
class Surfaces:
    """Patches of all panels, K at most, each in its panel's frame.

    Attributes:
        rows: (17, panels, K) the patches, see `geometry.cone.skin_rows`.
        curved: (panels, K) whether it is a cone or cylinder.
        outer: (panels, K, 8, size) how their inner numbers follow the unknowns, or None without derivatives.
        count: (panels,) number of patches, None where all have K.
        ruling_p, ruling_b: (panels, K + 1, 3) the bounding rulings; of a polygon its plane, once.
        middle: (panels,) the patch on which the panel has turned half of its way.
        middle_p, middle_b: (panels, 3) the ruling there.
    """

    rows: Array
    curved: BoolArray
    outer: Array | None
    count: IntArray | None
    middle: IntArray
    ruling_p: Array
    ruling_b: Array
    middle_p: Array
    middle_b: Array

    def assign(self, x: Array, panel: IntArray) -> IntArray:
        """(g, q) the patch of each point x (g, q, 3) in the frame of its panel (g,); see `features.distance.assign`."""
        p, b = self.ruling_p[panel, 1:-1], self.ruling_b[panel, 1:-1]
        right = dot(x - self.middle_p[panel][:, None], self.middle_b[panel][:, None]) > 0.0
        past = b @ x.swapaxes(1, 2) > dot(p, b)[..., None]
        return outwards(right, past, self.middle[panel], None if self.count is None else self.count[panel])

    def distance(self, x: Array, panel: IntArray, patch: IntArray) -> Array:
        """Signed distance (g, q) of points x (g, q, 3) to patches (g, q) of panels (g,)."""
        return self._under(panel, patch).distance(np.moveaxis(x, 2, 0))

    def distance_inner(self, x: Array, panel: IntArray, patch: IntArray, *, cones: bool = False) -> tuple[Array, Array]:
        """The same, and its inner derivative (g, q, 8); `cones` where it is known that all these patches are."""
        distance, inner = self._under(panel, patch, cones=cones).distance_inner(np.moveaxis(x, 2, 0))
        return distance, np.moveaxis(inner, 0, 2)

    def places(self, panel: IntArray, patch: IntArray) -> IntArray:
        """(g, q) the places of patches (g, q) of panels (g,), counted panel by panel."""
        return np.asarray(self.rows.shape[2] * panel[:, None] + patch, dtype=np.intp)

    def _under(self, panel: IntArray, patch: IntArray, *, cones: bool = False) -> Skins:
        place = self.places(panel, patch)
        curved = True if cones or self.curved.all() else np.take(self.curved, place)
        return Skins(np.take(self.rows.reshape(len(self.rows), -1), place, axis=1), curved)


def surfaces_of(layout: Layout, walks: Sequence[Walk]) -> Surfaces:
    """The patches of all panels."""
    begins = [middle(walked) for walked in walks]
    rulings = [walked.edges if walked.edges.p.shape[1] else walked.anchor for walked in walks]
    rows = [np.moveaxis(skins_of(walked), 0, 2) for walked in walks]
    outers = [walked.feature.by_unknowns(patch_outers(walked)) for walked in walks if walked.carriers.twist is not None]
    return Surfaces(
        rows=np.ascontiguousarray(np.moveaxis(layout.gather(rows), 2, 0)),
        curved=layout.curved,
        outer=layout.gather(outers) if len(outers) == len(walks) else None,
        count=None if len(walks) == 1 else layout.patches,
        middle=layout.gather([begin.patch for begin in begins]),
        ruling_p=layout.gather([ruling.p for ruling in rulings]),
        ruling_b=layout.gather([ruling.b for ruling in rulings]),
        middle_p=layout.gather([begin.p for begin in begins]),
        middle_b=layout.gather([begin.b for begin in begins]),
    )


@dataclass(frozen=True, slots=True)
class CutPlanes:
    """Cut planes m . x = s of all panels, E at most, m of unit length; 0 where a panel has fewer or none.

    Attributes:
        m: (panels, E, 3).
        s: (panels, E).
        dm: (panels, E, 3, size) how m follows the unknowns, or None without derivatives.
        ds: (panels, E, size).
    """

    m: Array
    s: Array
    dm: Array | None
    ds: Array | None


def cut_planes_of(layout: Layout, walks: Sequence[Walk]) -> CutPlanes:
    """The cut planes of all panels."""
    parts = [_cut_planes(walked) for walked in walks]
    m, s = layout.gather([part.m for part in parts]), layout.gather([part.s for part in parts])
    dm, ds = [part.dm for part in parts if part.dm is not None], [part.ds for part in parts if part.ds is not None]
    known = len(dm) == len(parts)
    return CutPlanes(m, s, layout.gather(dm) if known else None, layout.gather(ds) if known else None)


def _cut_planes(walked: Walk) -> CutPlanes:
    m, s = unit_cut_planes(walked)
    if walked.carriers.twist is None:
        return CutPlanes(m, s, None, None)
    dm, ds = (walked.feature.by_unknowns(rates) for rates in unit_cut_plane_rates(walked))
    return CutPlanes(m, s, dm, ds)
