"""Lines on a patch that turn back along themselves, as what is nearest to a curve does beside a tight bend.

Where a curve passes a bend within its radius, the feet of its points run ahead and come back. That part of the line
lies on itself, and parts of it on what leads there: it separates nothing, and on which side of itself it lies hangs on
the last bit of the numbers. The kernel, which goes on along the edge next to the one that it came from, is lost there.
"""

from __future__ import annotations

import numpy as np

from cadpanel.arrays import Array, BoolArray, IntArray
from cadpanel.brep.faces.boundary import evaluate
from cadpanel.brep.faces.face_patch import Patch
from cadpanel.brep.kernel.tolerances import CLOSE
from cadpanel.geometry.vectors import norm


def turns_back(patch: Patch, before: Array, at: Array, after: Array) -> BoolArray:
    """Whether a line turns back along itself: the shorter of both ways to its neighbours lies on the longer one.

    Args:
        patch: on which.
        before: (m, 2) parameters from which the line comes.
        at: (m, 2) where it turns.
        after: (m, 2) to where it goes on.

    Returns:
        (m,) of each.
    """
    points, along_u, along_v = evaluate(patch.surface, np.stack([at, before, after]))
    # Along the surface, which may bend much on the way; but where it has a pole, only the points tell the ways apart.
    ways = [step[:, :1] * along_u[0] + step[:, 1:] * along_v[0] for step in (before - at, after - at)]
    lengths = [norm(way) for way in ways]
    products = np.sum(ways[0] * ways[1], axis=1)
    back = (products >= 0.0) & (np.sum((points[1] - points[0]) * (points[2] - points[0]), axis=1) >= 0.0)
    longer = np.maximum(np.maximum(*lengths), np.finfo(float).tiny)
    aside = np.minimum(*lengths) ** 2 - (products / longer) ** 2
    return np.asarray(back & (aside <= CLOSE**2), dtype=np.bool_)


def kept_unfolded(patch: Patch, line: Array) -> IntArray:
    """The numbers of the points of a line (k, 2) that are left when it never turns back along itself; both ends are."""
    kept = np.arange(len(line))
    while len(kept) > 2:
        own = line[kept]
        tips = turns_back(patch, own[:-2], own[1:-1], own[2:])
        if not tips.any():
            break
        kept = np.delete(kept, np.flatnonzero(tips) + 1)
    return kept
