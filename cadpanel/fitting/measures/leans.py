"""By how much flat flanges that were fitted alone would have to lean their seams to meet without a step; radians.

Two flanges meet in the line in which their planes cross. On a flange that twists along the strip that line is not the
drawn seam, and no limit of gaps brings the two together (see `brep.skin.conjugate` for the same on the surface).
"""

from __future__ import annotations

import numpy as np

from cadpanel.arrays import Array
from cadpanel.geometry.panel import Chain, Panel
from cadpanel.geometry.patches import ConePatch
from cadpanel.geometry.vectors import cross, norm
from cadpanel.reference.model import Seam

# Planes that differ by less, radians, cross in no line that tells anything.
_LEAST_KINK = 1e-3


def leans(first: Panel, second: Panel, seam: Seam) -> Array:
    """(flanges,) the angles of those lines with the seam, of flanges that face each other along it.

    Empty where an edge is no end, patches do not face each other, or their planes hardly differ.
    """
    chains = [shape for shape in (first, second) if isinstance(shape, Chain)]
    if len(chains) < 2 or max(seam.edges) > 1 or len(first.patches) != len(second.patches):
        return np.zeros(0)
    one, other = chains
    count = len(one.patches)
    corners = np.asarray(one.corners())[seam.edges[0]]
    found = []
    for patch in range(count):
        beside = count - 1 - patch if seam.reversed else patch
        if isinstance(one.patches[patch], ConePatch) or isinstance(other.patches[beside], ConePatch):
            continue
        line = cross(one.normals[patch], other.normals[beside])
        drawn = corners[patch + 1] - corners[patch]
        if norm(line) >= _LEAST_KINK:
            sine = float(norm(cross(line, drawn)) / (norm(line) * norm(drawn)))
            found.append(np.arcsin(min(sine, 1.0)))
    return np.array(found)
