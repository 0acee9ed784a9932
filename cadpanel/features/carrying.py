"""How a ruling is carried over a plane or a cone, and how the ruling on arrival follows the patch's dimensions."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array
from cadpanel.features.patches import Kind
from cadpanel.geometry.frames import rotate_about, rotation_twist
from cadpanel.geometry.vectors import cross


@dataclass(frozen=True, slots=True)
class Frames:
    """A batch of n ruling frames: point p, axes b, t, n, each (n, 3)."""

    p: Array
    b: Array
    t: Array
    n: Array


def carry(kind: Kind, frames: Frames, dimensions: Array, way: float) -> tuple[Frames, Array]:
    """Carry frames over a patch.

    Args:
        kind: of the patch.
        frames: n frames on one edge of the patch.
        dimensions: (n, d) the patch's dimensions for each panel, see `patches.DIMENSIONS`.
        way: +1.0 walks over the whole patch towards b, -1.0 towards -b, +-0.5 half of it, and so on.

    Returns:
        the n frames on arrival, and (n, 6, d) the twist of the arrival frame for each dimension while the starting
        frame is held.
    """
    return _over_plane(frames, dimensions, way) if kind == "plane" else _over_cone(frames, dimensions, way)


def _over_plane(frames: Frames, dimensions: Array, way: float) -> tuple[Frames, Array]:
    """Along b by the share `way` of the width, then about n by that share of the turn."""
    width, turn = way * dimensions[:, 0], way * dimensions[:, 1]
    p = frames.p + width[:, None] * frames.b
    cosine, sine = np.cos(turn)[:, None], np.sin(turn)[:, None]
    # Right-handed about n: t turns towards n x t = -b, b turns towards t.
    t = cosine * frames.t - sine * frames.b
    b = cosine * frames.b + sine * frames.t
    twist = np.zeros((len(p), 6, 2))
    twist[:, 3:, 0] = way * frames.b
    twist[:, :, 1] = way * rotation_twist(frames.n, p)
    return Frames(p, b, t, frames.n), twist


def _over_cone(frames: Frames, dimensions: Array, way: float) -> tuple[Frames, Array]:
    """About the axis by the share `way` of the sweep."""
    radius, half_angle, sweep = dimensions[:, 0, None], dimensions[:, 1, None], way * dimensions[:, 2]
    axis = np.cos(half_angle) * frames.t - np.sin(half_angle) * frames.n
    centre = frames.p - radius * frames.n
    t, n = rotate_about(axis, sweep, frames.t), rotate_about(axis, sweep, frames.n)
    arrived = Frames(centre + radius * n, cross(t, n), t, n)
    twist = np.zeros((len(t), 6, 3))
    twist[:, 3:, 0] = n - frames.n
    # Tilting the axis by the half angle is a rotation about -b at the start, undone about -b on arrival.
    omega = arrived.b - frames.b
    twist[:, :3, 1] = omega
    twist[:, 3:, 1] = cross(centre, omega)
    twist[:, :, 2] = way * rotation_twist(axis, centre)
    return arrived, twist
