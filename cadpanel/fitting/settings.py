"""What the user asks of a fit, checked when it is made."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from numbers import Integral, Real
from typing import Literal, get_args

from cadpanel.errors import SettingsError
from cadpanel.features.catalogue import feature
from cadpanel.features.feature import Feature, Tilt

SMALLEST_WEIGHT, LARGEST_WEIGHT = 1e-12, 1e12
"""Weights farther apart would lose each other in the digits of a double."""

Method = Literal["local", "two_stage", "concurrent"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Weights:
    """Weights of the paper's objective (3), for those who want it instead of a tolerance.

    Attributes:
        gap: weight of each squared corner gap.
        deviation: weight of a panel's mean squared deviation.
        drift: weight of each squared corner drift.
    """

    gap: float = 1.0
    deviation: float = 1.0
    drift: float = 1e-4

    def __post_init__(self) -> None:
        """Refuse weights that make no objective.

        Raises:
            SettingsError: a weight is not a number of 0 or more, or no deviation or drift is left to fit.
        """
        for name in ("gap", "deviation", "drift"):
            require(name + " weight", getattr(self, name), least=0.0, most=LARGEST_WEIGHT)
        if self.deviation == 0.0 or self.drift == 0.0:
            raise SettingsError("the weights of deviation and drift must be above 0, or panels may wander off")
        for name in ("deviation", "drift"):
            require(name + " weight", getattr(self, name), least=SMALLEST_WEIGHT, most=LARGEST_WEIGHT)


@dataclass(frozen=True, slots=True, kw_only=True)
class FitSettings:
    """How to fit.

    Attributes:
        feature: name of the shape feature in the catalogue.
        tilt: "free" lets cut planes tilt into a mitre, "fixed" holds them upright as the paper does.
        method: "local", "two_stage" or "concurrent".
        gap_tolerance: mm that no gap may exceed, at corners and along whole seams.
        drift_along: how far a corner may move along its free edge, as a share of the panel's length.
        drift_across: the same across its free edge, which is what people see.
        weights: the paper's objective instead of a tolerance, or None.
        restarts: further starts from perturbed local fits; the best result counts.
        seed: of the perturbations.
    """

    feature: str = "plane-cone-plane"
    tilt: Tilt = "free"
    method: Method = "concurrent"
    gap_tolerance: float = 1.0
    drift_along: float = 0.05
    drift_across: float = 0.02
    weights: Weights | None = None
    restarts: int = 0
    seed: int = 0
    shape_feature: Feature = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check every setting.

        Raises:
            SettingsError: a setting is out of range; the message says which and what it may be.
        """
        object.__setattr__(self, "shape_feature", feature(self.feature, tilt=self.tilt))
        if self.method not in get_args(Method):
            raise SettingsError(f"there is no method '{self.method}'; choose one of: {', '.join(get_args(Method))}")
        require("gap tolerance", self.gap_tolerance, least=1e-3, unit=" mm")
        require("drift along the strip", self.drift_along, least=1e-4, most=0.5)
        require("drift across the free edges", self.drift_across, least=1e-4, most=0.5)
        require_whole("number of restarts", self.restarts, least=0, most=1000)
        require_whole("seed", self.seed, least=0)
        _require_weights(self.weights)
        if self.weights is not None and self.method == "local":
            raise SettingsError("the local method fits each panel alone and takes no weights; leave one of the two out")


def require_whole(what: str, value: object, *, least: int, most: float = math.inf) -> None:
    """Refuse a number outside [least, most], or one that is no whole number.

    Raises:
        SettingsError: with one sentence that names the setting and its range.
    """
    if not isinstance(value, Integral):
        raise SettingsError(f"the {what} must be a whole number, not {value!r}")
    require(what, value, least=least, most=most)


def require(what: str, value: object, *, least: float, most: float = math.inf, unit: str = "") -> None:
    """Refuse a number outside [least, most], or none at all.

    Raises:
        SettingsError: with one sentence that names the setting and its range.
    """
    if not isinstance(value, Real):
        raise SettingsError(f"the {what} must be a number, not {value!r}")
    number = float(value)
    if not math.isfinite(number) or not least <= number <= most:
        span = f"at least {least:g}{unit}" if math.isinf(most) else f"between {least:g}{unit} and {most:g}{unit}"
        raise SettingsError(f"the {what} must be {span}, not {number:g}{unit}")


def _require_weights(value: object) -> None:
    if not isinstance(value, Weights | None):
        raise SettingsError(f"the weights must be Weights or None, not {value!r}")
