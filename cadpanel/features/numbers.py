"""The numbers that describe a feature, by name; the fit chooses some, within bounds or without, and some are fixed."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from numbers import Real
from typing import Literal

from cadpanel.errors import SettingsError

Value = float | tuple[float | None, float | None] | None
"""What a feature says of a number: its value, its bounds (None for an open side), or nothing, and the fit chooses."""

LARGEST = 1e9
"""No length in mm or angle beyond this is one of a panel."""

Unit = Literal["length", "angle", "slope", "curvature", "root length"]

POWERS: dict[Unit, float] = {"length": 1.0, "angle": 0.0, "slope": 0.0, "curvature": -1.0, "root length": 0.5}
"""The power of a length that each unit counts in, by which numbers follow the unit of length."""


@dataclass(frozen=True, slots=True)
class Number:
    """One number of a feature.

    Attributes:
        name: what it is, for example "patch 1: half_angle".
        unit: one of POWERS; lengths in mm or units of the solver's length (a curvature in one over them), angles in
            radians.
        fixed: the value it is held at, or None where the fit is free to choose it.
        lower, upper: bounds of what the fit may choose.
    """

    name: str
    unit: Unit
    fixed: float | None = None
    lower: float = -math.inf
    upper: float = math.inf

    @staticmethod
    def of(name: str, unit: Unit, value: Value) -> Number:
        """The number that a feature's author describes by a value, by bounds or by nothing.

        Raises:
            SettingsError: the value is no finite number, or the bounds leave nothing between them.
        """
        if value is None:
            return Number(name, unit)
        if isinstance(value, tuple):
            if len(value) != 2:
                raise SettingsError(f"the bounds of '{name}' must be two numbers (least, greatest), not {value!r}")
            lower, upper = (
                _finite(name, bound, open_) for bound, open_ in zip(value, (-math.inf, math.inf), strict=True)
            )
            if not lower < upper:
                raise SettingsError(f"the bounds of '{name}' leave nothing between {lower:g} and {upper:g}")
            return Number(name, unit, None, lower, upper)
        return Number(name, unit, _finite(name, value, math.nan))

    def require(self, least: float, greatest: float, why: str) -> Number:
        """This number, once it is seen that it may lie between two values.

        Raises:
            SettingsError: its value, or one of its bounds, lies outside; `why` completes the sentence.
        """
        given = (self.fixed,) if self.fixed is not None else (self.lower, self.upper)
        if any(math.isfinite(value) and not least <= value <= greatest for value in given):
            raise SettingsError(f"'{self.name}' must lie between {least:.6g} and {greatest:.6g}: {why}")
        return self

    @property
    def sign(self) -> int:
        """1 or -1 where no value but 0 can have another sign, else 0."""
        least, greatest = (self.lower, self.upper) if self.fixed is None else (self.fixed, self.fixed)
        return int(least >= 0.0 < greatest) - int(greatest <= 0.0 > least)

    def within(self, patch: int) -> Number:
        """The same number as one of patch `patch` of a chain."""
        return replace(self, name=f"patch {patch}: {self.name}")

    def in_units(self, length: float) -> Number:
        """The same number with lengths counted in units of `length` mm."""
        one = length ** POWERS[self.unit]
        fixed = None if self.fixed is None else self.fixed / one
        return replace(self, fixed=fixed, lower=self.lower / one, upper=self.upper / one)


def _finite(name: str, value: object, open_: float) -> float:
    if value is None and math.isinf(open_):
        return open_
    if isinstance(value, bool) or not isinstance(value, Real):
        number = math.nan
    else:
        try:
            number = float(value)
        except OverflowError:  # a whole number of hundreds of digits
            number = math.inf
    if not abs(number) <= LARGEST:
        raise SettingsError(f"'{name}' must be a finite number, two bounds or nothing, not {repr(value)[:40]}")
    return number
