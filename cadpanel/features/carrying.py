"""How a ruling is carried over planes and cones, and how the ruling on arrival follows the patches' dimensions.

How a frame moves over a patch, seen from where it starts, hangs on the patch's dimensions alone. So the moves over all
patches of all panels are worked out at once, and a walk only puts one after the other.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array
from cadpanel.features.patches import DIMENSIONS, Kind
from cadpanel.geometry.frames import skew

POINT = 3
"""Where the point stands in a frame: rows b, t, n, p."""


@dataclass(frozen=True, slots=True)
class Moves:
    """Moves of frames over patches, seen from the frames that they start from.

    Attributes:
        frames: (..., 4, 3) rows b, t, n and p of the frames on arrival.
        twist: (..., 6, d) the twist of the frame on arrival for each dimension of the patch, None if not asked for.
    """

    frames: Array
    twist: Array | None

    def twists(self, start: Array) -> Array:
        """(..., 6, d) the twists of frames that started at (..., 4, 3), while these are held."""
        if self.twist is None:
            raise ValueError("the moves were worked out without derivatives")
        # omega turns with the frame, and v as well; what is turned about a point far off moves there besides.
        axes = np.swapaxes(start[..., :POINT, :], -1, -2)
        seen = np.zeros((*start.shape[:-2], 6, 6))
        seen[..., :3, :3] = seen[..., 3:, 3:] = axes
        seen[..., 3:, :3] = skew(start[..., POINT, :]) @ axes
        turned: Array = seen @ self.twist
        return turned


def carry(moved: Array, start: Array) -> Array:
    """(..., 4, 3) where frames (..., 4, 3) arrive that move by `moved` (..., 4, 3), seen from where they start."""
    arrived: Array = moved @ start[..., :POINT, :]
    arrived[..., POINT, :] += start[..., POINT, :]
    return arrived


def moves_over(kind: Kind, dimensions: Array, way: Array, *, derivatives: bool) -> Moves:
    """Moves over patches of one kind.

    Args:
        kind: of the patches.
        dimensions: (..., d) the patches' dimensions, see `patches.DIMENSIONS`.
        way: (...) +1.0 walks over the whole patch towards b, -1.0 towards -b, +-0.5 half of it, and so on.
        derivatives: whether twists are wanted.
    """
    over = _over_plane if kind == "plane" else _over_cone
    frames = np.zeros((*dimensions.shape[:-1], 4, 3))
    twist = np.zeros((*dimensions.shape[:-1], 6, len(DIMENSIONS[kind]))) if derivatives else None
    over(frames, twist, dimensions, way)
    return Moves(frames, twist)


def _over_plane(frames: Array, twist: Array | None, dimensions: Array, way: Array) -> None:
    """Along b by the share `way` of the width, then about n by that share of the turn."""
    moved = way[..., None] * dimensions
    width, turn = moved[..., 0], moved[..., 1]
    # Right-handed about n: t turns towards n x t = -b, b turns towards t.
    frames[..., 0, 0] = frames[..., 1, 1] = np.cos(turn)
    frames[..., 0, 1] = np.sin(turn)
    frames[..., 1, 0] = -frames[..., 0, 1]
    frames[..., 2, 2] = 1.0
    frames[..., POINT, 0] = width
    if twist is not None:
        twist[..., 3, 0] = twist[..., 2, 1] = way
        twist[..., 4, 1] = -way * width


def _over_cone(frames: Array, twist: Array | None, dimensions: Array, way: Array) -> None:
    """About the axis by the share `way` of the sweep.

    The axis (0, cos g, -sin g) and b are square to each other, and with outward = b x axis = (0, sin g, cos g) they
    make a frame that turns in its own plane. The axis passes through the centre (0, 0, -radius).
    """
    radius, half_angle = dimensions[..., 0], dimensions[..., 1]
    sweep = way * dimensions[..., 2]
    narrow, wide, cosine, sine = np.cos(half_angle), np.sin(half_angle), np.cos(sweep), np.sin(sweep)
    across, over = narrow * sine, wide * sine
    # The normal leaves where it was by narrow times (sine, wide (cosine - 1), narrow (cosine - 1)).
    back = cosine - 1.0
    aside, down = narrow * wide * back, narrow * narrow * back
    frames[..., 0, 0] = cosine
    frames[..., 0, 1], frames[..., 1, 0] = -over, over
    frames[..., 0, 2], frames[..., 2, 0] = -across, across
    frames[..., 1, 2] = frames[..., 2, 1] = aside
    frames[..., 1, 1], frames[..., 2, 2] = 1.0 + wide * wide * back, 1.0 + down
    frames[..., POINT, 0], frames[..., POINT, 1], frames[..., POINT, 2] = radius * across, radius * aside, radius * down
    if twist is not None:
        twist[..., 3, 0], twist[..., 4, 0], twist[..., 5, 0] = across, aside, down
        # Tilting the axis by the half angle is a rotation about -b at the start, undone about -b on arrival.
        twist[..., 0, 1], twist[..., 1, 1], twist[..., 2, 1] = back, -over, -across
        twist[..., 3, 1], twist[..., 4, 1] = -radius * over, -radius * back
        twist[..., 1, 2], twist[..., 2, 2] = way * narrow, -way * wide
        twist[..., 3, 2] = way * radius * narrow
