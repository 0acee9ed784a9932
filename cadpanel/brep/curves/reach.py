"""How far off a surface curves and points may lie to be taken for its own."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cadpanel.arrays import Array
from cadpanel.brep.faces.closest_points import Search
from cadpanel.brep.skin.adjacency import Surface

# What lies on a limit lies within it, however that is rounded, mm.
ON_LIMIT = 1e-6
# A curve may lie this far off a surface, as a part of the surface's size, and at least this many mm.
NEAR_PART = 0.01
NEAR = 10.0
# A chord may lie farther off in its middle by this part of its length: where the surface turns by some 65 degrees on
# the way.
SAG_PART = 0.15


def reach_of(surface: Surface) -> float:
    """How far off a surface a curve may lie, mm."""
    return max(NEAR, NEAR_PART * surface.size) + ON_LIMIT


def sags(parts: Array, length: float) -> Array:
    """By how much farther off a surface the points of a chord may lie than its ends, mm.

    Args:
        parts: (q,) of the way from one end to the other at which they lie; beyond the ends by none.
        length: of the chord, mm.
    """
    within = np.clip(parts, 0.0, 1.0)
    return 4.0 * SAG_PART * length * within * (1.0 - within)


def far_off(surfaces: Sequence[Surface], points: Array) -> tuple[int, float] | None:
    """The one of (m, 3) points that lies farthest off all surfaces, and how far, mm; None where all are near one."""
    distances = np.full(len(points), np.inf)
    near = np.zeros(len(points), dtype=np.bool_)
    for surface in surfaces:
        own = np.min([Search(face.patch).feet(points).distances for face in surface.faces], axis=0)
        distances, near = np.minimum(distances, own), near | (own <= reach_of(surface))
    if near.all():
        return None
    worst = int(np.where(near, -np.inf, distances).argmax())
    return worst, float(distances[worst])
