"""Patches and cut planes of all panels in arrays, whatever their features, and how they follow the unknowns."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np

from cadpanel.arrays import Array, BoolArray, IntArray
from cadpanel.features.cut_planes import unit_cut_plane_rates, unit_cut_planes
from cadpanel.features.distance import middle, patch_outers, skin_numbers
from cadpanel.features.layout import Layout
from cadpanel.features.rulings import Walk
from cadpanel.geometry.cone import Skins
from cadpanel.geometry.vectors import dot


@dataclass(frozen=True, slots=True)
class Surfaces:
    """Patches of all panels, K at most, each in its panel's frame.

    Attributes:
        numbers: (panels, K, 11) the patches, see `features.distance.skin_numbers`.
        curved: (panels, K) whether it is a cone or cylinder.
        outer: (panels, K, 8, size) how their inner numbers follow the unknowns, or None without derivatives.
        count: (panels,) number of patches.
        ruling_p, ruling_b: (panels, K + 1, 3) the bounding rulings; of a polygon its plane, once.
        middle: (panels,) the patch on which the panel has turned half of its way.
        middle_p, middle_b: (panels, 3) the ruling there.
    """

    numbers: Array
    curved: BoolArray
    outer: Array | None
    count: IntArray
    middle: IntArray
    ruling_p: Array
    ruling_b: Array
    middle_p: Array
    middle_b: Array

    def assign(self, x: Array, panel: IntArray) -> IntArray:
        """(g, q) the patch of each point x (g, q, 3) in the frame of its panel (g,); see `features.distance.assign`."""
        p, b = self.ruling_p[panel], self.ruling_b[panel]
        beyond = x @ np.swapaxes(b, 1, 2) > dot(p, b)[:, None]
        right = dot(x - self.middle_p[panel][:, None], self.middle_b[panel][:, None]) > 0.0
        middle, count = self.middle[panel, None], self.count[panel, None]
        patch = np.broadcast_to(middle, right.shape).copy()
        passed = right
        for i in range(1, self.curved.shape[1]):
            asked = (i > middle) & (i < count)
            passed = np.where(asked, passed & beyond[..., i], passed)
            patch += asked & passed
        passed = ~right
        for i in range(self.curved.shape[1] - 1, 0, -1):
            asked = i <= middle
            passed = np.where(asked, passed & ~beyond[..., i], passed)
            patch -= asked & passed
        return patch

    def distance(self, x: Array, panel: IntArray, patch: IntArray) -> Array:
        """Signed distance (g, q) of points x (g, q, 3) to patches (g, q) of panels (g,)."""
        return self._under(panel, patch).distance(np.moveaxis(x, 2, 0))

    def distance_inner(self, x: Array, panel: IntArray, patch: IntArray) -> tuple[Array, Array]:
        """The same, and its inner derivative (g, q, 8)."""
        distance, inner = self._under(panel, patch).distance_inner(np.moveaxis(x, 2, 0))
        return distance, np.moveaxis(inner, 0, 2)

    def _under(self, panel: IntArray, patch: IntArray) -> Skins:
        own = panel[:, None]
        return Skins.of_rows(np.moveaxis(self.numbers[own, patch], 2, 0), self.curved[own, patch])


def surfaces_of(layout: Layout, walks: Sequence[Walk]) -> Surfaces:
    """The patches of all panels."""
    parts = [_surfaces(walked) for walked in walks]
    outers = [part.outer for part in parts if part.outer is not None]
    merged = {
        one.name: layout.gather([getattr(part, one.name) for part in parts])
        for one in fields(Surfaces)
        if one.name != "outer"
    }
    return Surfaces(**merged, outer=layout.gather(outers) if len(outers) == len(parts) else None)


def _surfaces(walked: Walk) -> Surfaces:
    feature, (panels, patches) = walked.feature, walked.carriers.frames.shape[:2]
    begin = middle(walked)
    rulings = walked.edges if walked.edges.p.shape[1] else walked.anchor
    return Surfaces(
        numbers=skin_numbers(walked),
        curved=np.broadcast_to(np.array(feature.curved), (panels, patches)),
        outer=None if walked.carriers.twist is None else feature.by_unknowns(patch_outers(walked)),
        count=np.full(panels, patches),
        middle=begin.patch,
        ruling_p=rulings.p,
        ruling_b=rulings.b,
        middle_p=begin.p,
        middle_b=begin.b,
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
