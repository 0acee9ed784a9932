"""What the user asks of a fit, checked when it is made."""

from __future__ import annotations

import math
from dataclasses import dataclass
from numbers import Integral, Real
from typing import Literal, get_args

from cadpanel.errors import SettingsError
from cadpanel.features.catalogue import AUTO, Tilt, for_corners
from cadpanel.features.patch_checks import greatest_radius
from cadpanel.features.rulings import PanelFeature
from cadpanel.fitting.bends.asked import Blend, blends_of

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
        feature: name of the shape feature in the catalogue; "auto" for the cheapest one that stays within
            `max_deviation`, panel by panel; or a `Feature` composed by the user.
        max_deviation: mm that no panel may deviate from its reference where the feature is chosen automatically.
        tilt: "free" lets cut planes tilt into a mitre, "fixed" holds them upright as the paper does.
        method: "local", "two_stage" or "concurrent".
        gap_tolerance: mm that no gap may exceed, at corners and along whole seams.
        drift_along: how far a corner may move along its free edge, as a share of the panel's length.
        drift_across: the same across its free edge, which is what people see.
        blend: which stretch across the panels becomes their curved patches, where that is not to be told by the
            surface's normals: "410-540" (mm from side 0), "40-55%", "NW-03=410-540" for one panel, or several of these.
        min_radius: mm, the tightest that the shop can roll; no cone or cylinder gets tighter anywhere.
        weights: the paper's objective instead of a tolerance, or None.
        restarts: further starts from perturbed local fits; the best result counts.
        seed: of the perturbations.
    """

    feature: str | PanelFeature = "plane-cone-plane"
    max_deviation: float | None = None
    tilt: Tilt = "free"
    method: Method = "concurrent"
    gap_tolerance: float = 1.0
    drift_along: float = 0.05
    drift_across: float = 0.02
    min_radius: float = 10.0
    blend: tuple[Blend, ...] = ()
    weights: Weights | None = None
    restarts: int = 0
    seed: int = 0

    def __post_init__(self) -> None:
        """Check every setting.

        Raises:
            SettingsError: a setting is out of range; the message says which and what it may be.
        """
        named: object = self.feature
        if not isinstance(named, str | PanelFeature):
            raise SettingsError(f"a feature is named, or is a Feature, not {named!r}")
        if isinstance(self.feature, str) and self.feature != AUTO:
            for_corners(self.feature, tilt=self.tilt)
        if self.tilt not in get_args(Tilt):
            raise SettingsError(f"tilt must be 'free' or 'fixed', not '{self.tilt}'")
        if not isinstance(self.feature, str) and self.tilt == "fixed":
            raise SettingsError("a composed feature says itself how its ends are cut; leave the tilt out")
        if self.method not in get_args(Method):
            raise SettingsError(f"there is no method '{self.method}'; choose one of: {', '.join(get_args(Method))}")
        if self.max_deviation is not None:
            require("largest deviation", self.max_deviation, least=1e-3, unit=" mm")
        if (self.feature == AUTO) != (self.max_deviation is not None):
            raise SettingsError(
                f"the feature '{AUTO}' and a largest deviation go together: the first is chosen by the second"
            )
        require("gap tolerance", self.gap_tolerance, least=1e-3, unit=" mm")
        require("drift along the strip", self.drift_along, least=1e-4, most=0.5)
        require("drift across the free edges", self.drift_across, least=1e-4, most=0.5)
        require("least radius", self.min_radius, least=0.1, unit=" mm")
        if not isinstance(self.feature, str):
            _require_rollable(self.feature, self.min_radius)
        require_whole("number of restarts", self.restarts, least=0, most=1000)
        require_whole("seed", self.seed, least=0)
        _require_weights(self.weights)
        object.__setattr__(self, "blend", blends_of(self.blend))
        if self.blend and self.automatic:
            raise SettingsError(f"with the feature '{AUTO}' it is not known which panels have a blend: name a feature")
        if self.weights is not None and self.method == "local":
            raise SettingsError("the local method fits each panel alone and takes no weights; leave one of the two out")

    @property
    def automatic(self) -> bool:
        """Whether each panel gets the cheapest feature that will do."""
        return self.feature == AUTO

    @property
    def feature_name(self) -> str:
        """The feature as reports call it."""
        return self.feature if isinstance(self.feature, str) else self.feature.name

    def feature_for(self, corners: int) -> PanelFeature:
        """The feature of a panel with so many corners, where all panels have the same."""
        if isinstance(self.feature, str):
            return for_corners(self.feature, tilt=self.tilt)(corners)
        return self.feature


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


def _require_rollable(feature: PanelFeature, min_radius: float) -> None:
    """Refuse a feature whose author asks for a tighter radius than the shop can roll."""
    for i, patch in enumerate(feature.patches):
        if patch.kind != "plane" and greatest_radius(patch) < min_radius:
            raise SettingsError(
                f"the radius of patch {i} of '{feature.name}' is tighter than the least radius of {min_radius:g} mm: "
                "ask for a larger one, or allow a tighter one"
            )


def _require_weights(value: object) -> None:
    if not isinstance(value, Weights | None):
        raise SettingsError(f"the weights must be Weights or None, not {value!r}")
