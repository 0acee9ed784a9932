"""What the user asks of a fit, checked when it is made."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Literal, TypedDict, get_args

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.errors import SettingsError
from cadpanel.features.catalogue import AUTO, Tilt, for_corners
from cadpanel.features.rulings import PanelFeature
from cadpanel.fitting.bends.asked import Blend, blends_of
from cadpanel.fitting.rules.book import Rules, rules_of
from cadpanel.setting import Option, Range, check_ranges, require, setting
from cadpanel.terms.limits.catalogue import LIMITS
from cadpanel.terms.limits.corner_drift import DriftAcross, DriftAlong
from cadpanel.terms.limits.evenness import Evenness
from cadpanel.terms.limits.kink import Kink
from cadpanel.terms.limits.limit import limit_setting
from cadpanel.terms.limits.min_radius import MinRadius
from cadpanel.terms.limits.outline_drift import DriftOutline
from cadpanel.terms.limits.seam_level import SeamLevel
from cadpanel.terms.limits.seam_turn import SeamTurn
from cadpanel.terms.parts import PARTS

SMALLEST_WEIGHT, LARGEST_WEIGHT = 1e-12, 1e12
"""Weights farther apart would lose each other in the digits of a double."""

WIDTH, STEP, SHIFT = 3.0, 3.0, 3.0
"""mm that the parts of gaps may have if nothing is said of gaps."""

Method = Literal["local", "two_stage", "concurrent", "annealing"]

OF_GAPS = ("gap_tolerance", "joint_tolerance", "step", "shift")
"""The settings that hold gaps, whose place weights take."""

_WEIGHTS = ("gap", "deviation", "drift")


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
        """Refuse weights that make no objective, and keep them as floats.

        Raises:
            SettingsError: a weight is not a number of 0 or more, or no deviation or drift is left to fit.
        """
        for name in _WEIGHTS:
            require(name + " weight", getattr(self, name), least=0.0, most=LARGEST_WEIGHT)
        if self.deviation == 0.0 or self.drift == 0.0:
            raise SettingsError("the weights of deviation and drift must be above 0, or panels may wander off")
        for name in ("deviation", "drift"):
            require(name + " weight", getattr(self, name), least=SMALLEST_WEIGHT, most=LARGEST_WEIGHT)
        for name in _WEIGHTS:
            object.__setattr__(self, name, float(getattr(self, name)))

    @staticmethod
    def parse(text: str) -> Weights:
        """Weights from "gap=1,deviation=1,drift=1e-4", in any order; those left out keep their defaults.

        Raises:
            SettingsError: the text is not of that form.
        """
        found: dict[str, float] = {}
        for part in text.split(","):
            name, equals, value = (piece.strip() for piece in part.partition("="))
            if not equals or name not in _WEIGHTS or name in found:
                raise SettingsError(
                    f"--weights cannot use '{part.strip()}': write each of gap, deviation and drift at most once, "
                    "like gap=1,deviation=1,drift=1e-4."
                )
            try:
                found[name] = float(value)
            except ValueError as error:
                raise SettingsError(f"--weights needs a number for {name}, not '{value}'.") from error
        return Weights(**found)


def _part_of_gap(what: str, usual: float, told: str) -> float | None:
    """The field of a part of gaps that is limited by itself."""
    return setting(
        None,
        within=Range(what=what, least=1e-3, unit=" mm", empty=True),
        option=Option(metavar="MM", help=f"{told} {usual:g} mm, or the gap tolerance, if not given.", told=False),
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class FitSettings:
    """How to fit.

    Attributes:
        feature: name of the shape feature in the catalogue; "auto" for the cheapest one that stays within
            `max_deviation`, panel by panel; or a `Feature` composed by the user.
        max_deviation: mm that no panel may deviate from its reference: by it features are chosen automatically; of a
            feature that is named it is judged whether it keeps to it.
        tilt: "free" lets cut planes tilt into a mitre, "fixed" holds them upright as the paper does.
        method: "local", "two_stage", "concurrent", or "annealing", the paper's algorithm as it is printed.
        gap_tolerance: mm that no gap may exceed, at corners and along whole seams; None where its parts alone are held.
        joint_tolerance: mm that neighbours may lie apart, or over each other, square to the seam in the skin.
        step: mm from skin to skin along their normal.
        shift: mm along the seam between corners that meet. Where neither a part nor the whole gap is asked for, all
            three are held within `WIDTH`, `STEP` and `SHIFT`; where only the whole is, it holds its parts.
        weights: the paper's objective instead of a tolerance, or None.
        seam_turn: degrees that ends, and edges on seams, may turn from the drawn ones.
        evenness: how far corners on seams may lie off the middle between those of the seams before and after, against
            the drawing, as a share of the panel's length.
        seam_level: mm to either side that seams which are drawn level, in a ring that lies in one plane, may leave
            that plane; 1000 for any.
        max_kink: degrees between neighbouring skins across a seam; 180 for any.
        drift_along: how far a corner may move along its free edge, as a share of the panel's length.
        drift_across: the same across its free edge, which is what people see.
        drift_outline: how far the free outline may leave the drawn one anywhere, square to it; 0.5 for any.
        blend: which stretch across the panels becomes their curved patches, where that is not to be told by the
            surface's normals: "410-540" (mm from side 0), "40-55%", "NW-03=410-540" for one panel, or several of these.
        min_radius: mm, the tightest that the shop can roll; no cone or cylinder gets tighter anywhere.
        rules: for single panels and seams, see `fitting.rules`; the name of a TOML file, or what it would hold.
        restarts: further starts from perturbed local fits; the best result counts.
        seed: of the perturbations.
        energy: the paper's E0: the weighted sum of squares, mm2, of panels that seams connect, below which annealing
            ends; None to use up all restarts.
        tau: the paper's convergence tolerance: the step, mm, below which annealing is at a stationary point; angles
            count by a panel's length.
    """

    feature: str | PanelFeature = setting(
        "plane-cone-plane",
        option=Option(takes=str, metavar="NAME", help="Shape of a panel, one of those that 'cadpanel features' lists."),
    )
    max_deviation: float | None = setting(
        None,
        within=Range(what="largest deviation", least=1e-3, unit=" mm", empty=True),
        option=Option(
            metavar="MM", help="How far a panel may lie from the reference; chooses with --feature or --divide auto."
        ),
    )
    tilt: Tilt = setting(
        "free", option=Option(help="May the planes that cut the ends tilt into a mitre, or stand upright?")
    )
    method: Method = setting(
        "concurrent",
        option=Option(help="Each panel alone; then moved about; all at once; or as the paper prints it."),
    )
    gap_tolerance: float | None = setting(
        None,
        within=Range(what="gap tolerance", least=1e-3, unit=" mm", empty=True),
        option=Option(metavar="MM", help="Largest gap between neighbours, along whole seams, instead of its parts."),
    )
    joint_tolerance: float | None = _part_of_gap("joint tolerance", WIDTH, "How far joints may be wider or narrower.")
    step: float | None = _part_of_gap("step", STEP, "Largest step from skin to skin across a seam.")
    shift: float | None = _part_of_gap("shift", SHIFT, "How far corners that meet may lie apart along the seam.")
    weights: Weights | None = setting(
        None,
        option=Option(
            takes=str,
            read=lambda _, text: Weights.parse(text),
            metavar="gap=W,deviation=W,drift=W",
            help="Weigh squares against each other instead of holding a gap tolerance and the limits on drift.",
        ),
    )
    seam_turn: float = limit_setting(SeamTurn)
    evenness: float = limit_setting(Evenness)
    seam_level: float = limit_setting(SeamLevel)
    max_kink: float = limit_setting(Kink)
    drift_along: float = limit_setting(DriftAlong)
    drift_across: float = limit_setting(DriftAcross)
    drift_outline: float = limit_setting(DriftOutline)
    min_radius: float = limit_setting(MinRadius)
    blend: tuple[Blend, ...] = setting(
        (),
        option=Option(
            takes=list[str],
            metavar="[PANEL=]FROM-TO[%]",
            help="Stretch across the panels, mm from side 0, to become the bend; may be repeated, for one panel each.",
            told=False,
        ),
    )
    rules: Rules | None = setting(
        None,
        option=Option(
            takes=str,
            read=lambda _, text: rules_of(text),
            metavar="FILE",
            help="TOML file with rules for single panels and seams: features, locks, equal radii, tools.",
        ),
    )
    restarts: int = setting(
        0,
        within=Range(what="number of restarts", least=0, most=1000, whole=True),
        option=Option(help="Further starts from slightly changed panels; the best counts."),
    )
    seed: int = setting(
        0,
        within=Range(what="seed", least=0, whole=True),
        option=Option(help="Seed of the random numbers for --restarts and annealing."),
    )
    energy: float | None = setting(
        None,
        within=Range(what="acceptable energy", least=0.0, unit=" mm2", empty=True),
        option=Option(metavar="MM2", help="Weighted sum of squares, E0, at which --method annealing ends.", told=False),
    )
    tau: float = setting(
        1e-3,
        within=Range(what="convergence tolerance", least=1e-12, most=1e3, unit=" mm"),
        option=Option(metavar="MM", help="Step below which --method annealing is at a stationary point."),
    )

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
        check_ranges(self)
        if self.feature == AUTO and self.max_deviation is None:
            raise SettingsError(f"the feature '{AUTO}' is chosen by a largest deviation: give one, too")
        if not isinstance(self.feature, str):
            for limit in LIMITS:
                limit.check_feature(self.feature, limit.allowed(self))
        _require_weights(self.weights)
        object.__setattr__(self, "blend", blends_of(self.blend))
        if self.blend and self.automatic:
            raise SettingsError(f"with the feature '{AUTO}' it is not known which panels have a blend: name a feature")
        object.__setattr__(self, "rules", rules_of(self.rules))
        self._check_rules()
        if self.weights is not None and self.method == "local":
            raise SettingsError("the local method fits each panel alone and takes no weights; leave one of the two out")

    def _check_rules(self) -> None:
        if self.rules is None:
            return
        if self.automatic:
            raise SettingsError(f"rules are for panels whose features are named: leave out the feature '{AUTO}'")
        if self.rules.of_fit and (self.weights is not None or self.method != "concurrent"):
            raise SettingsError(
                "all rules but [[feature]] are held while all panels are fitted at once within tolerances: leave out "
                "the weights, or the method"
            )
        for rule in self.rules.rules:
            rule.check(self.allowed)

    @property
    def allowed(self) -> dict[str, float]:
        """Every limit by its name, mm or shares of a panel's length; also those that are no setting."""
        return {limit.name: limit.allowed(self) for limit in LIMITS}

    @property
    def gaps(self) -> dict[str, float]:
        """What is held of gaps, mm: "gap" for the whole of them, "width", "step" and "shift" for their parts."""
        whole = self.gap_tolerance
        usual = (WIDTH, STEP, SHIFT) if whole is None else (np.inf, np.inf, np.inf)
        asked = zip(PARTS, (self.joint_tolerance, self.step, self.shift), usual, strict=True)
        parts = {part: usually if value is None else value for part, value, usually in asked}
        held = {} if whole is None else {"gap": whole}
        return held | {part: value for part, value in parts.items() if value < (np.inf if whole is None else whole)}

    def gaps_of(self, names: Sequence[str], seam_panels: IntArray) -> Mapping[str, float | Array]:
        """The same where rules allow single seams more or less; then of every seam (seams,).

        Args:
            names: of the panels.
            seam_panels: (seams, 2) which panels meet.
        """
        return self.gaps if self.rules is None else self.rules.gaps(self.gaps, names, seam_panels)

    @property
    def widest_gap(self) -> float:
        """The most that is allowed of gaps, or of one of their parts, mm."""
        return max(self.gaps.values())

    def alone(self, method: Method = "local") -> FitSettings:
        """The same for a method that does not fit all panels at once, with those rules that it can follow."""
        rules = None if self.rules is None else self.rules.of_panels_alone()
        return replace(self, method=method, rules=rules)

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

    def features_for(self, names: Sequence[str], corners: Sequence[int]) -> list[PanelFeature]:
        """The feature of every panel, by its name and how many corners it has."""
        own = {} if self.rules is None else self.rules.features(names)
        return [
            for_corners(own[place], tilt=self.tilt)(count) if place in own else self.feature_for(count)
            for place, count in enumerate(corners)
        ]


def _require_weights(value: object) -> None:
    if not isinstance(value, Weights | None):
        raise SettingsError(f"the weights must be Weights or None, not {value!r}")


LIKE_THE_PAPER = FitSettings(gap_tolerance=1.0, seam_turn=90.0, evenness=0.5, seam_level=1000.0, drift_along=0.05)
"""What Table 1 is made under if nothing else is asked for: it is about how far gaps close, and its seams may lean."""


class FitKeywords(TypedDict, total=False):
    """The fields of `FitSettings` as keywords, which type checkers want written out; a test holds the two alike."""

    feature: str | PanelFeature
    max_deviation: float | None
    tilt: Tilt
    method: Method
    gap_tolerance: float | None
    joint_tolerance: float | None
    step: float | None
    shift: float | None
    weights: Weights | None
    seam_turn: float
    evenness: float
    seam_level: float
    max_kink: float
    drift_along: float
    drift_across: float
    drift_outline: float
    min_radius: float
    blend: str | Blend | Sequence[str | Blend]
    rules: str | Path | Mapping[str, Any] | Rules | None
    restarts: int
    seed: int
    energy: float | None
    tau: float
