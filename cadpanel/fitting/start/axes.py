"""About which direction the normals of a panel turn."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cadpanel.arrays import Array
from cadpanel.fitting.samples import SampleArrays
from cadpanel.geometry.vectors import dot, unit
from cadpanel.reference.model import PanelReference

# The direction in which the normals turn least is the axis, unless it is further off the way from end to end than this.
_ASTRAY = np.cos(np.radians(40.0))


def turning_axes(panels: Sequence[PanelReference], samples: SampleArrays) -> Array:
    """(n, 3) the direction about which the normals of n panels turn: that in which they spread least.

    On a cone and on the planes tangent to it all normals enclose one angle with the axis, so that it is exact there.
    """
    corners = np.array([panel.corners for panel in panels])
    chord = unit((corners[:, 1] - corners[:, 0]).mean(axis=1))
    weights = samples.weights / samples.weights.sum(axis=1, keepdims=True)
    off = samples.normals - np.einsum("pm,pmx->px", weights, samples.normals)[:, None]
    _, directions = np.linalg.eigh(np.einsum("pm,pmx,pmy->pxy", weights, off, off))
    least = directions[:, :, 0]
    least = least * np.where(dot(least, chord) < 0.0, -1.0, 1.0)[:, None]
    astray = dot(least, chord) < _ASTRAY
    return np.where(astray[:, None], chord, least)
