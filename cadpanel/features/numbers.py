"""The numbers that describe a feature, by name; some are unknowns of the fit, some are fixed by the feature."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal


@dataclass(frozen=True, slots=True)
class Number:
    """One number of a feature.

    Attributes:
        name: what it is, for example "patch 1: half_angle".
        unit: "length" (in units of the panel size inside the solver), "angle" (radians) or "slope".
        fixed: the value it is held at, in these units, or None where the fit is free to choose it.
    """

    name: str
    unit: Literal["length", "angle", "slope"]
    fixed: float | None = None
