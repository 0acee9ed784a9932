"""Whether panels' ends are cut squarely enough to be built: what `Panel.check` refuses, for all panels at once."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cadpanel.arrays import BoolArray
from cadpanel.fitting.measures.edges import alike
from cadpanel.geometry.chain_checks import LARGEST_ECCENTRICITY, SMALLEST_CUT_COSINE
from cadpanel.geometry.panel import Panel


def too_oblique(shapes: Sequence[Panel]) -> BoolArray:
    """(panels,) which have an end that is cut too obliquely to a ruling, or whose section of a cone is no ellipse.

    Seen along the axis of a cone of half angle g the section by a plane whose normal has the cosine c with the axis is
    a conic of eccentricity tan(g) sqrt(1 - c^2) / c (geometry/cone_sections.py).
    """
    found = np.zeros(len(shapes), dtype=bool)
    for group in alike(shapes):
        if not group.cut_normals.shape[1] or not len(group.half_angle):
            continue
        cosines = np.einsum("prx,pex->per", group.t, group.cut_normals)
        narrow, wide = np.cos(group.half_angle)[..., None], np.sin(group.half_angle)[..., None]
        patches = group.half_angle.shape[1]
        axes = narrow * group.t[:, :patches] - wide * group.n[:, :patches]
        rise = np.einsum("pkx,pex->pek", axes, group.cut_normals)
        curved = (group.radius != 0.0)[:, None]
        lean = np.abs(np.tan(group.half_angle))[:, None] * np.sqrt(np.maximum(1.0 - rise**2, 0.0))
        no_ellipse = curved & ((rise <= 0.0) | (lean > LARGEST_ECCENTRICITY * rise))
        found[group.members] = (cosines < SMALLEST_CUT_COSINE).any(axis=(1, 2)) | no_ellipse.any(axis=(1, 2))
    return found
