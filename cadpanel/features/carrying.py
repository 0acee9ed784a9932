"""How a ruling is carried over a plane or a cone, and how the ruling on arrival follows the patch's dimensions."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array
from cadpanel.features.patches import Kind
from cadpanel.geometry.frames import rotation_twist
from cadpanel.geometry.vectors import cross


@dataclass(frozen=True, slots=True)
class Frames:
    """A batch of n ruling frames: point p, axes b, t, n, each (n, 3)."""

    p: Array
    b: Array
    t: Array
    n: Array


def carry(kind: Kind, frames: Frames, dimensions: Array, way: float | Array) -> tuple[Frames, Array]:
    """Carry frames over a patch.

    Args:
        kind: of the patch.
        frames: n frames on one edge of the patch.
        dimensions: (n, d) the patch's dimensions for each panel, see `patches.DIMENSIONS`.
        way: +1.0 walks over the whole patch towards b, -1.0 towards -b, +-0.5 half of it, and so on; one for all frames
            or one each (n,).

    Returns:
        the n frames on arrival, and (n, 6, d) the twist of the arrival frame for each dimension while the starting
        frame is held.
    """
    return _over_plane(frames, dimensions, way) if kind == "plane" else _over_cone(frames, dimensions, way)


def _over_plane(frames: Frames, dimensions: Array, way: float | Array) -> tuple[Frames, Array]:
    """Along b by the share `way` of the width, then about n by that share of the turn."""
    share = np.asarray(way)[..., None]
    width, turn = share * dimensions[:, :1], share * dimensions[:, 1:]
    p = frames.p + width * frames.b
    cosine, sine = np.cos(turn), np.sin(turn)
    # Right-handed about n: t turns towards n x t = -b, b turns towards t.
    t = cosine * frames.t - sine * frames.b
    b = cosine * frames.b + sine * frames.t
    twist = np.zeros((len(p), 6, 2))
    twist[:, 3:, 0] = share * frames.b
    twist[:, :, 1] = share * rotation_twist(frames.n, p)
    return Frames(p, b, t, frames.n), twist


def _over_cone(frames: Frames, dimensions: Array, way: float | Array) -> tuple[Frames, Array]:
    """About the axis by the share `way` of the sweep.

    The axis and b are square to each other, and with outward = b x axis they make a frame that turns in its own plane.
    """
    share = np.asarray(way)[..., None]
    radius, half_angle, sweep = dimensions[:, :1], dimensions[:, 1:2], share * dimensions[:, 2:]
    narrow, wide, cosine, sine = np.cos(half_angle), np.sin(half_angle), np.cos(sweep), np.sin(sweep)
    axis, outward = narrow * frames.t - wide * frames.n, wide * frames.t + narrow * frames.n
    b, outward = cosine * frames.b - sine * outward, cosine * outward + sine * frames.b
    t, n = narrow * axis + wide * outward, narrow * outward - wide * axis
    centre = frames.p - radius * frames.n
    arrived = Frames(centre + radius * n, b, t, n)
    twist = np.zeros((len(t), 6, 3))
    twist[:, 3:, 0] = n - frames.n
    # Tilting the axis by the half angle is a rotation about -b at the start, undone about -b on arrival.
    omega = b - frames.b
    twist[:, :3, 1] = omega
    twist[:, 3:, 1] = cross(centre, omega)
    twist[:, :, 2] = share * rotation_twist(axis, centre)
    return arrived, twist
