"""Patches: each carries one ruling to the next, and tells how the next moves when one of its numbers changes.

A patch that is new to the package is one class here (or in a user's own file) with the same four members.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np

from cadpanel.arrays import Array
from cadpanel.errors import SettingsError
from cadpanel.features.numbers import LARGEST, Number, Value
from cadpanel.geometry.frames import rotate_about, rotation_twist
from cadpanel.geometry.vectors import cross

_QUARTER = 0.5 * np.pi


@dataclass(frozen=True, slots=True)
class Frames:
    """A batch of n ruling frames: point p, axes b, t, n, each (n, 3)."""

    p: Array
    b: Array
    t: Array
    n: Array


class Patch(Protocol):
    """What the chain asks of a patch.

    Attributes:
        kind: "plane", "cone" or "cylinder", as reports and solids name it.
    """

    @property
    def kind(self) -> Literal["plane", "cone", "cylinder"]:
        """How reports and solids name it."""
        ...

    def numbers(self) -> tuple[Number, ...]:
        """The patch's own numbers in the order in which `carry` takes them."""
        ...

    def carry(self, frames: Frames, values: Array, way: float) -> tuple[Frames, Array]:
        """Carry the frames over the patch.

        Args:
            frames: n frames on one edge of the patch.
            values: (n, numbers) the patch's numbers for each panel.
            way: +1.0 walks over the whole patch towards b, -1.0 towards -b, +-0.5 half of it, and so on.

        Returns:
            the n frames on arrival, and (n, 6, numbers) the twist of the arrival frame for each number while the
            starting frame is held.
        """
        ...


@dataclass(frozen=True, slots=True, kw_only=True)
class Plane:
    """A flat patch: the ruling moves by a width along b and turns in the plane by an angle (2 numbers).

    Attributes:
        width: mm; a number fixes it, two bound it, None leaves it to the fit.
        turn: radians, likewise.
    """

    width: Value = None
    turn: Value = None

    def __post_init__(self) -> None:
        """Refuse numbers that are none."""
        self.numbers()

    @property
    def kind(self) -> Literal["plane"]:
        """How reports and solids name it."""
        return "plane"

    def numbers(self) -> tuple[Number, ...]:
        """Width (length) and turn (angle about n, counted the way of the walk)."""
        return (
            Number.of("width", "length", self.width).require(0.0, LARGEST, "a flange has no width below 0"),
            Number.of("turn", "angle", self.turn).require(
                -_QUARTER, _QUARTER, "the edges of a flange differ in direction by less than a quarter turn"
            ),
        )

    def carry(self, frames: Frames, values: Array, way: float) -> tuple[Frames, Array]:
        """See `Patch.carry`; on a plane only the sign of `way` and its share of both numbers matter."""
        width, turn = way * values[:, 0], way * values[:, 1]
        p = frames.p + width[:, None] * frames.b
        cosine, sine = np.cos(turn)[:, None], np.sin(turn)[:, None]
        # Right-handed about n: t turns towards n x t = -b, b turns towards t.
        t = cosine * frames.t - sine * frames.b
        b = cosine * frames.b + sine * frames.t
        twist = np.zeros((len(p), 6, 2))
        twist[:, 3:, 0] = way * frames.b
        twist[:, :, 1] = way * rotation_twist(frames.n, p)
        return Frames(p, b, t, frames.n), twist


@dataclass(frozen=True, slots=True, kw_only=True)
class Cone:
    """A right circular cone: the ruling turns about the axis by the sweep angle (3 numbers).

    The axis passes through c = p - radius n in the direction a = cos(half_angle) t - sin(half_angle) n; half_angle = 0
    is exactly the cylinder, and nothing blows up there.

    Attributes:
        radius: normal radius at the patch's first ruling from the anchor (in the middle of the anchor patch), mm,
            positive where the patch is convex outwards; a number fixes it, two bound it, None leaves it to the fit.
        half_angle: radians, likewise; positive where a convex cone widens from end 0 to end 1.
        sweep: radians, likewise, of the same sign as the radius.
    """

    radius: Value = None
    half_angle: Value = None
    sweep: Value = None

    def __post_init__(self) -> None:
        """Refuse numbers that are none, a radius of 0, and a radius and sweep of different signs.

        Raises:
            SettingsError: naming the numbers.
        """
        radius, _, sweep = self.numbers()
        if radius.fixed == 0.0:
            raise SettingsError("the 'radius' of a cone or cylinder must not be 0: that is a line or a point, no patch")
        if radius.sign * sweep.sign < 0:
            raise SettingsError(
                f"the 'radius' {self.radius!r} and the 'sweep' {self.sweep!r} of a cone or cylinder must have one "
                "sign: positive where it is convex outwards, negative where it is concave"
            )

    @property
    def kind(self) -> Literal["cone", "cylinder"]:
        """A cone whose half angle is held at 0 is named for what it is."""
        return "cylinder" if self.half_angle == 0.0 else "cone"

    def numbers(self) -> tuple[Number, ...]:
        """Normal radius at p (length), half angle and sweep (angles)."""
        return (
            Number.of("radius", "length", self.radius),
            Number.of("half_angle", "angle", self.half_angle).require(
                -_QUARTER, _QUARTER, "a cone of a quarter turn, in radians, is a disc"
            ),
            Number.of("sweep", "angle", self.sweep).require(
                -np.pi, np.pi, "no roll or fold goes round by more than half a turn, in radians"
            ),
        )

    def carry(self, frames: Frames, values: Array, way: float) -> tuple[Frames, Array]:
        """See `Patch.carry`; `way` is the share of the sweep."""
        radius, half_angle, sweep = values[:, 0, None], values[:, 1, None], way * values[:, 2]
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


def Cylinder(*, radius: Value = None, sweep: Value = None) -> Cone:  # noqa: N802 - named like its siblings
    """A circular cylinder: the cone whose half angle is held at 0 (2 numbers)."""
    return Cone(radius=radius, half_angle=0.0, sweep=sweep)
