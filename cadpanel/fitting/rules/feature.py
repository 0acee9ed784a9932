"""The feature of single panels: a flat one in a strip of folds, or a die of one's own catalogue."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

from cadpanel.errors import SettingsError
from cadpanel.features.catalogue import AUTO, for_corners
from cadpanel.features.rulings import PanelFeature
from cadpanel.fitting.rules.rule import Fitted, Outcome, Posed, Rule, called, places_of, words_of
from cadpanel.reference.model import Reference


@dataclass(frozen=True, slots=True, kw_only=True)
class FeatureRule(Rule):
    """Some panels have another feature.

    Attributes:
        panels: names.
        feature: of the catalogue.
    """

    table: ClassVar[str] = "feature"
    of_fit: ClassVar[bool] = False

    panels: tuple[str, ...]
    feature: str

    def __post_init__(self) -> None:
        """Refuse what is no feature.

        Raises:
            SettingsError: naming those that there are.
        """
        object.__setattr__(self, "panels", words_of(self.panels, "the panels of a [[feature]]"))
        if self.feature == AUTO:
            raise SettingsError(f"a [[feature]] of single panels is one of the catalogue, not '{AUTO}'")
        for_corners(self.feature)

    def features(self, names: Sequence[str]) -> dict[int, str]:
        """See `Rule.features`."""
        return dict.fromkeys(places_of(self.panels, names, self.table), self.feature)

    def pose(self, reference: Reference, features: Sequence[PanelFeature]) -> list[Posed]:
        """See `Rule.pose`."""
        del features
        names = [panel.name for panel in reference.panels]
        return [_Given(names, places_of(self.panels, names, self.table), self.feature)]


class _Given(Posed):
    """Panels that have a feature."""

    def __init__(self, names: Sequence[str], panels: Sequence[int], feature: str) -> None:
        self._panels, self._feature = panels, feature
        self._rule = f"{called([names[i] for i in panels])}: {feature}"

    def outcome(self, fitted: Fitted) -> Outcome:
        """See `Posed.outcome`."""
        others = sum(fitted.shapes[i].feature != self._feature for i in self._panels)
        return Outcome(rule=self._rule, measure="panels of another feature", found=others, allowed=0, unit="")
