"""Patches and cut planes of all panels in arrays, whatever their features, and how they follow the unknowns."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np

from cadpanel.arrays import Array, BoolArray, IntArray
from cadpanel.features.cut_planes import cut_plane_rates, cut_planes
from cadpanel.features.distance import middle, patch_outer, round_numbers
from cadpanel.features.layout import Layout
from cadpanel.features.rulings import Walk
from cadpanel.geometry.cone import cone_distance, cone_distance_inner, plane_distance, plane_inner
from cadpanel.geometry.vectors import dot


@dataclass(frozen=True, slots=True)
class Surfaces:
    """Patches of all panels, K at most, each in its panel's frame.

    Attributes:
        p, t, n: (panels, K, 3) the rulings that the patches are measured at.
        radius, half_angle: (panels, K), 0 for planes.
        curved: (panels, K) whether it is a cone or cylinder.
        outer: (panels, K, 8, size) how their inner numbers follow the unknowns, or None without derivatives.
        count: (panels,) number of patches.
        sweep: (panels, K), 0 for planes.
        ruling_p, ruling_b, ruling_t, ruling_n: (panels, K + 1, 3) the bounding rulings; of a polygon its plane, once.
        middle: (panels,) the patch on which the panel has turned half of its way.
        middle_p, middle_b: (panels, 3) the ruling there.
    """

    p: Array
    t: Array
    n: Array
    radius: Array
    half_angle: Array
    sweep: Array
    curved: BoolArray
    outer: Array | None
    count: IntArray
    middle: IntArray
    ruling_p: Array
    ruling_b: Array
    ruling_t: Array
    ruling_n: Array
    middle_p: Array
    middle_b: Array

    def assign(self, x: Array, panel: IntArray) -> IntArray:
        """(g, q) the patch of each point x (g, q, 3) in the frame of its panel (g,); see `features.distance.assign`."""

        def past(p: Array, b: Array) -> BoolArray:
            return np.asarray(dot(x - p[:, None], b[:, None]) > 0.0)

        right = past(self.middle_p[panel], self.middle_b[panel])
        middle, count = self.middle[panel, None], self.count[panel, None]
        beyond = [past(self.ruling_p[panel, i], self.ruling_b[panel, i]) for i in range(self.p.shape[1])]
        patch = np.broadcast_to(middle, right.shape).copy()
        passed = right
        for i in range(1, self.p.shape[1]):
            asked = (i > middle) & (i < count)
            passed = np.where(asked, passed & beyond[i], passed)
            patch += asked & passed
        passed = ~right
        for i in range(self.p.shape[1] - 1, 0, -1):
            asked = i <= middle
            passed = np.where(asked, passed & ~beyond[i], passed)
            patch -= asked & passed
        return patch

    def distance(self, x: Array, panel: IntArray, patch: IntArray) -> Array:
        """Signed distance (g, q) of points x (g, q, 3) to patches (g, q) of panels (g,)."""
        points, cone, curved = self._under(x, panel, patch)
        distance = np.where(curved, cone_distance(points, *cone), plane_distance(points, cone[0], cone[2]))
        return distance.reshape(patch.shape)

    def distance_inner(self, x: Array, panel: IntArray, patch: IntArray) -> tuple[Array, Array]:
        """The same, and its inner derivative (g, q, 8)."""
        points, cone, curved = self._under(x, panel, patch)
        round_, inner = cone_distance_inner(points, *cone)
        distance = np.where(curved, round_, plane_distance(points, cone[0], cone[2]))
        inner = np.where(curved[..., None], inner, plane_inner(points, cone[2]))
        return distance.reshape(patch.shape), inner.reshape(*patch.shape, -1)

    def _under(
        self, x: Array, panel: IntArray, patch: IntArray
    ) -> tuple[Array, tuple[Array, Array, Array, Array, Array], BoolArray]:
        """All points (3, g q, 1), the numbers p, t, n, radius and half angle of their patches, and which are curved."""
        place = (panel[:, None] * self.p.shape[1] + patch).reshape(-1)
        p, t, n = (axis.reshape(-1, 3)[place] for axis in (self.p, self.t, self.n))
        radius, half_angle, curved = (one.reshape(-1)[place] for one in (self.radius, self.half_angle, self.curved))
        return x.reshape(-1, 1, 3).transpose(2, 0, 1), (p, t, n, radius, half_angle), curved[:, None]


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
    feature, carriers = walked.feature, walked.carriers
    panels, patches = carriers.p.shape[:2]
    radius, half_angle, sweep = round_numbers(walked)
    begin = middle(walked)
    outer = None
    if carriers.twist is not None:
        outer = np.stack([feature.by_unknowns(patch_outer(walked, i)) for i in range(patches)], axis=1)
    rulings = walked.edges if walked.edges.p.shape[1] else walked.anchor
    return Surfaces(
        p=carriers.p,
        t=carriers.t,
        n=carriers.n,
        radius=radius,
        half_angle=half_angle,
        sweep=sweep,
        curved=np.broadcast_to(np.array(feature.curved), (panels, patches)),
        outer=outer,
        count=np.full(panels, patches),
        middle=begin.patch,
        ruling_p=rulings.p,
        ruling_b=rulings.b,
        ruling_t=rulings.t,
        ruling_n=rulings.n,
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
    m, s = cut_planes(walked)
    size = np.sqrt(dot(m, m))
    unit, place = m / size[..., None], s / size
    if walked.carriers.twist is None:
        return CutPlanes(unit, place, None, None)
    dm, ds = (walked.feature.by_unknowns(rates) for rates in cut_plane_rates(walked))
    growth = (unit[..., None, :] @ dm)[..., 0, :]
    dm = (dm - unit[..., None] * growth[..., None, :]) / size[..., None, None]
    ds = (ds - place[..., None] * growth) / size[..., None]
    return CutPlanes(unit, place, dm, ds)
