"""Gaps of single seams: narrower where people stand before them, wider where nobody sees them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from cadpanel.arrays import Array, BoolArray, IntArray
from cadpanel.errors import SettingsError
from cadpanel.features.rulings import PanelFeature
from cadpanel.fitting.rules.rule import Fitted, Outcome, Posed, Rule, seams_between, words_of
from cadpanel.geometry.limits import WIDEST_JOINT
from cadpanel.reference.model import Reference
from cadpanel.setting import require

_PARTS = ("gap", "width", "step", "shift")
_LEAST = 1e-3


@dataclass(frozen=True, slots=True, kw_only=True)
class SeamRule(Rule):
    """What some seams may have of gaps, instead of what all may.

    Attributes:
        between: two words: seams between a panel that the first means and one that the second means.
        gap, width, step, shift: mm.
        joint: clear width between the two sheets, mm, when they are built; what a delivery proves of it is in the
            report's seams.
    """

    table: ClassVar[str] = "seam"

    between: tuple[str, ...]
    gap: float | None = None
    width: float | None = None
    step: float | None = None
    shift: float | None = None
    joint: float | None = None

    def __post_init__(self) -> None:
        """Refuse what says nothing, or no lengths.

        Raises:
            SettingsError: saying what is wanted.
        """
        object.__setattr__(self, "between", words_of(self.between, "the two panels that a [[seam]] lies between"))
        if len(self.between) != 2:
            raise SettingsError("a [[seam]] lies between two panels: between = ['NW-03', 'NW-04'], or ['NW-*', 'NW-*']")
        for part, value in self._asked().items():
            require(f"{part} of a [[seam]]", value, least=_LEAST, unit=" mm")
        if self.joint is not None:
            require("joint of a [[seam]]", self.joint, least=0.0, most=WIDEST_JOINT, unit=" mm")
            object.__setattr__(self, "joint", float(self.joint))
        if not self._asked() and self.joint is None:
            raise SettingsError("a [[seam]] says what is allowed there: gap, width, step or shift, or its joint, mm")

    def gaps(self, names: Sequence[str], seam_panels: IntArray) -> dict[str, Array]:
        """See `Rule.gaps`."""
        own = self._seams(names, seam_panels)
        return {part: np.where(own, value, np.nan) for part, value in self._asked().items()}

    def joints(self, names: Sequence[str], seam_panels: IntArray) -> dict[int, float]:
        """See `Rule.joints`."""
        if self.joint is None:
            return {}
        return dict.fromkeys(np.flatnonzero(self._seams(names, seam_panels)).tolist(), self.joint)

    def pose(self, reference: Reference, features: Sequence[PanelFeature]) -> list[Posed]:
        """See `Rule.pose`."""
        del features
        names = [panel.name for panel in reference.panels]
        panels = np.array([seam.panels for seam in reference.seams], dtype=np.intp).reshape(-1, 2)
        own, rule = self._seams(names, panels), "|".join(self.between)
        return [_Allowed(rule, part, own, value) for part, value in self._asked().items()]

    def _asked(self) -> dict[str, float]:
        found = {part: getattr(self, part) for part in _PARTS}
        return {part: value for part, value in found.items() if value is not None}

    def _seams(self, names: Sequence[str], seam_panels: IntArray) -> BoolArray:
        return seams_between(self.between, names, seam_panels, self.table)


class _Allowed(Posed):
    """A part of the gaps of some seams."""

    def __init__(self, rule: str, part: str, own: BoolArray, allowed: float) -> None:
        self._rule, self._part, self._own, self._allowed = rule, part, own, allowed

    def outcome(self, fitted: Fitted) -> Outcome:
        """See `Posed.outcome`."""
        found = float(fitted.gaps[self._part][self._own].max())
        return Outcome(rule=f"seam {self._rule}", measure=f"largest {self._part}", found=found, allowed=self._allowed)
