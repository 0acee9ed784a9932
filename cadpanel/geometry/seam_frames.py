"""The three directions at the corners of a seam: square to it in the skins, out of the skins, and along it."""

from __future__ import annotations

import numpy as np

from cadpanel.arrays import Array
from cadpanel.geometry.vectors import cross, dot, unit

WIDTH, STEP, SHIFT = 0, 1, 2
"""The rows of a frame: the parts of a gap."""


def seam_frames(tangents: Array, normals: Array) -> Array:
    """(s, m, 3, 3) unit vectors in rows: of the width, of the step and of the shift.

    Args:
        tangents: (s, m, 3) along s seams at m places each, as far as they lie in the skin; of any length.
        normals: (s, m, 3) of the skins there, of any length.
    """
    out = unit(normals)
    along = unit(tangents - dot(tangents, out)[..., None] * out)
    return np.stack([cross(out, along), out, along], axis=2)


def tangents_at(corners: Array) -> Array:
    """(s, m, 3) the directions of seams at their corners (s, m, 3): from the corner before to the one after.

    Over an arc, which bends out of the skin's tangent plane, what lies in that plane is the arc's tangent.
    """
    steps = unit(np.diff(corners, axis=1))
    return np.concatenate([steps[:, :1], steps[:, :-1] + steps[:, 1:], steps[:, -1:]], axis=1)
