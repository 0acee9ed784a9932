"""How far the walls at a chain's ends lean from square, ruling by ruling, and where they lean most. Radians."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from cadpanel.arrays import Array
from cadpanel.geometry.cone_sections import axis_frame
from cadpanel.geometry.patches import ConePatch, Patch


def leans(
    rulings: tuple[Array, Array, Array], patches: Sequence[Patch], way_out: Array, spans: Array | None = None
) -> list[float]:
    """The skin's normal n times the way out of a cut plane, where its patches begin and end, and where it is extreme.

    Args:
        rulings: points, directions and normals (k + 1, 3).
        patches: the k patches.
        way_out: (3,) unit normal of the cut plane, out of the panel.
        spans: (k, 2) between which angles the end runs over the patches; all over them if none are given.
    """
    points, directions, normals = rulings
    found: list[float] = []
    for index, patch in enumerate(patches):
        if not isinstance(patch, ConePatch):
            found.append(float(normals[index] @ way_out))
            continue
        span = [0.0, patch.sweep] if spans is None else spans[index].tolist()
        frame = axis_frame(points[index], directions[index], normals[index], patch)
        cosine, sine = math.cos(patch.half_angle), math.sin(patch.half_angle)
        toward, aside = float(frame.radial @ way_out), float(frame.tangential @ way_out)
        found += (frame.normals(np.array(span)) @ way_out).tolist()
        phase, first, last = math.atan2(aside, toward), *sorted(span)
        for half_turn in range(math.ceil((first - phase) / math.pi), math.floor((last - phase) / math.pi) + 1):
            swing = math.hypot(toward, aside) * (-1.0) ** half_turn
            found.append(cosine * swing - sine * float(frame.axis @ way_out))
    return list(found)
