"""The patches of a panel as plain numbers: planes, cones and cylinders between two rulings. Millimetres and radians."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal


@dataclass(frozen=True, slots=True, kw_only=True)
class PlanePatch:
    """A flat patch between two consecutive rulings; its plane is that of either ruling (they agree)."""

    kind: Literal["plane"] = "plane"


@dataclass(frozen=True, slots=True, kw_only=True)
class ConePatch:
    """A right circular cone (a cylinder where half_angle is 0) between ruling i and ruling i + 1.

    With the frame (p, t, n) of ruling i, the axis passes through c = p - radius * n in the direction
    a = cos(half_angle) * t - sin(half_angle) * n, and turning ruling i about that axis by `sweep` (right-handed) gives
    ruling i + 1. The apex is never stored: it runs to infinity exactly where real panels lie.

    Attributes:
        radius: normal radius in mm, the distance from p to the axis measured along n, nowhere 0. Positive where the
            patch is convex towards n, negative where it is concave.
        half_angle: in radians, signed: positive where the cone widens along t (for a positive radius).
        sweep: in radians, of the same sign as the radius, so that the walk goes towards b = t x n.
        kind: "cylinder" where the feature asks for one (half_angle is then exactly 0), else "cone".
    """

    radius: float
    half_angle: float
    sweep: float
    kind: Literal["cone", "cylinder"] = "cone"


Patch = PlanePatch | ConePatch
