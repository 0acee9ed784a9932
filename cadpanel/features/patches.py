"""Patches: planes, cones and cylinders, each told by numbers of its own that the fit may choose.

A patch that is new to the package is one class here (or in a user's own file) with the same four members. Its surface
is a plane, a cone or a cylinder, as nothing else is rolled or folded exactly; what is new is the numbers that tell of
it, which the fit then chooses, bounds or holds. Whoever needs the surface (distances, normals, the walk, limits,
solids) asks for its dimensions, and whoever lays a start asks for the numbers of some dimensions. A cylinder told by
the curvature of its sheet, which is bent to a radius of 2 m at most:

    @dataclass(frozen=True)
    class Bent:
        kind = "cylinder"

        def numbers(self):
            return Number("sweep", "angle"), Number("curvature", "curvature", lower=1 / 2000.0)

        def dimensions(self, values):
            sweep, curvature = values.T
            zero = np.zeros_like(sweep)
            radius = [zero, -1.0 / curvature**2]
            rates = np.stack([radius, [zero, zero], [zero + 1.0, zero]])
            return Dimensions(np.stack([1.0 / curvature, zero, sweep], axis=1), np.moveaxis(rates, 2, 0))

        def numbers_for(self, dimensions):
            return np.stack([dimensions[:, 2], 1.0 / dimensions[:, 0]], axis=1)

A patch that lacks a member, or whose members disagree, is refused when a feature is made of it: see `patch_checks`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np

from cadpanel.arrays import Array
from cadpanel.errors import SettingsError
from cadpanel.features.numbers import LARGEST, Number, Value

Kind = Literal["plane", "cone", "cylinder"]

DIMENSIONS: dict[Kind, tuple[str, ...]] = {
    "plane": ("width", "turn"),
    "cone": ("radius", "half_angle", "sweep"),
    "cylinder": ("radius", "half_angle", "sweep"),
}
"""What a patch of each kind measures, in this order; see `Plane` and `Cone`. A cylinder's half angle is 0."""

_QUARTER = 0.5 * np.pi


@dataclass(frozen=True, slots=True)
class Dimensions:
    """What n patches of one kind measure, whatever numbers they are told by.

    Attributes:
        values: (n, d) as DIMENSIONS lists them, lengths in the unit of the patch's own numbers, angles in radians.
        rates: (n, d, numbers) how they follow the patch's own numbers, None where the numbers are the dimensions.
    """

    values: Array
    rates: Array | None = None

    def by_numbers(self) -> Array:
        """The rates (n or 1, d, numbers)."""
        return np.eye(self.values.shape[1])[None] if self.rates is None else self.rates

    def take(self, part: slice) -> Dimensions:
        """Those of some of the panels."""
        return Dimensions(self.values[part], None if self.rates is None else self.rates[part])


class Patch(Protocol):
    """What a chain asks of a patch. Patches are keys of dictionaries: a frozen dataclass is one.

    Attributes:
        kind: "plane", "cone" or "cylinder", as reports and solids name it.
    """

    @property
    def kind(self) -> Kind:
        """How reports and solids name it."""
        ...

    def numbers(self) -> tuple[Number, ...]:
        """The patch's own numbers, each with its unit and what its author holds it at or within."""
        ...

    def dimensions(self, values: Array) -> Dimensions:
        """What patches with these numbers (n, numbers) measure.

        The numbers come in any unit of length, so lengths that are no number of the patch have no place here.
        """
        ...

    def numbers_for(self, dimensions: Array) -> Array:
        """(n, numbers) the numbers of patches with these dimensions (n, d), or of those nearest to them.

        Whatever the author holds: that is seen to afterwards.
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

    def dimensions(self, values: Array) -> Dimensions:
        """The numbers themselves."""
        return Dimensions(values)

    def numbers_for(self, dimensions: Array) -> Array:
        """The dimensions themselves."""
        return dimensions


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

    def dimensions(self, values: Array) -> Dimensions:
        """The numbers themselves."""
        return Dimensions(values)

    def numbers_for(self, dimensions: Array) -> Array:
        """The dimensions themselves."""
        return dimensions


def Cylinder(*, radius: Value = None, sweep: Value = None) -> Cone:  # noqa: N802 - named like its siblings
    """A circular cylinder: the cone whose half angle is held at 0 (2 numbers)."""
    return Cone(radius=radius, half_angle=0.0, sweep=sweep)
