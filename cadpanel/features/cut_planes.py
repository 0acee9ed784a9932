"""The planes that cut the ends of walked panels, and how they follow the numbers."""

from __future__ import annotations

import numpy as np

from cadpanel.arrays import Array
from cadpanel.features.rulings import PanelFeature, Walk, once
from cadpanel.geometry.frames import point_velocity
from cadpanel.geometry.vectors import beside, cross, dot


@once
def cut_planes(walked: Walk) -> tuple[Array, Array]:
    """The cut planes m . x = s: m (panels, ends, 3), not of unit length, and s (panels, ends)."""
    feature = walked.feature
    cuts = walked.values[:, feature.cut_numbers]
    m = np.ones(cuts.shape)
    m[..., 0], m[..., 2] = cuts[..., 1], cuts[..., 2]
    if not carried(feature):
        return m, cuts[..., 0]
    anchor = walked.anchor
    m = m @ beside([anchor.b[:, 0], anchor.t[:, 0], anchor.n[:, 0]])
    return m, cuts[..., 0] + dot(m, anchor.p)


@once
def cut_plane_rates(walked: Walk) -> tuple[Array, Array]:
    """How `cut_planes` follow the numbers: dm (panels, ends, 3, N) and ds (panels, ends, N)."""
    feature, anchor = walked.feature, walked.anchor
    panels, count = walked.values.shape
    ends = len(feature.cut_numbers)
    dm, ds = np.zeros((panels, ends, 3, count)), np.zeros((panels, ends, count))
    for end, (place, skew, tilt) in enumerate(feature.cut_numbers.tolist()):
        ds[:, end, place] = 1.0
        if not carried(feature):
            dm[:, end, 0, skew] = dm[:, end, 2, tilt] = 1.0
            continue
        for number, axis in ((skew, anchor.b), (tilt, anchor.n)):
            dm[:, end, :, number] = axis[:, 0]
            ds[:, end, number] = dot(axis[:, 0], anchor.p[:, 0])
    if carried(feature):
        if anchor.twist is None:
            raise ValueError("the panels were walked without derivatives")
        m, _ = cut_planes(walked)
        turned = cross(np.swapaxes(anchor.twist[:, :, :3], 2, 3), m[:, :, None])
        dm += np.swapaxes(turned, 2, 3)
        # The plane's point p moves along: d(m . p) = dm . p + m . v(p).
        ds += dot(turned, anchor.p[:, :, None]) + np.einsum(
            "pex,pxj->pej", m, point_velocity(anchor.twist[:, 0], anchor.p[:, 0])
        )
    return dm, ds


@once
def unit_cut_planes(walked: Walk) -> tuple[Array, Array]:
    """`cut_planes` with m of unit length."""
    m, s = cut_planes(walked)
    size = np.sqrt(dot(m, m))
    return m / size[..., None], s / size


@once
def unit_cut_plane_rates(walked: Walk) -> tuple[Array, Array]:
    """How `unit_cut_planes` follow the numbers: dm (panels, ends, 3, N) and ds (panels, ends, N)."""
    (m, _), (unit, place), (dm, ds) = cut_planes(walked), unit_cut_planes(walked), cut_plane_rates(walked)
    size = np.sqrt(dot(m, m))[..., None]
    growth = (unit[..., None, :] @ dm)[..., 0, :]
    return (dm - unit[..., None] * growth[..., None, :]) / size[..., None], (ds - place[..., None] * growth) / size


def carried(feature: PanelFeature) -> bool:
    """Whether the cut planes move with the anchor ruling."""
    return feature.cuts == "square"
