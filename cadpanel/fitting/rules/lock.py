"""Locked corners and panels: they stay where the drawing has them, or as an earlier delivery made them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.errors import SettingsError
from cadpanel.features.rulings import PanelFeature
from cadpanel.fitting.rules.boundary import boundary_of, places_in
from cadpanel.fitting.rules.rule import Fitted, Outcome, Place, Posed, Rule, called, places_of, words_of
from cadpanel.reference.model import PanelReference, Reference
from cadpanel.setting import Range, require
from cadpanel.terms.limits.limit import Panels
from cadpanel.terms.rules.near import NearTerm
from cadpanel.terms.term import HeldTerm

# The terms hold a little less than is asked for, so that rounding in a file cannot break the promise.
_MARGIN = 1e-3

Points = tuple[tuple[float, float, float], ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class LockRule(Rule):
    """Corners of some panels stay where they are drawn, or whole panels as they were delivered.

    Attributes:
        panels: names.
        corners: which of the outer corners, in the order of the drawn panel: of a panel with ends and sides 0 and 1 at
            end 0, side 0 and side 1, 2 and 3 at end 1; all if not given.
        within: mm.
        delivery: folder of an earlier delivery, in which the panels have the same names; the drawing if not given.
        made: of each of the panels, in the order of the drawing, its boundary in that delivery, mm; the program fills
            it in, so that a report is enough to run the fit again.
    """

    table: ClassVar[str] = "lock"

    panels: tuple[str, ...]
    corners: tuple[int, ...] = ()
    within: float = 0.1
    delivery: str = ""
    made: tuple[Points, ...] = ()

    def __post_init__(self) -> None:
        """Refuse what cannot be held.

        Raises:
            SettingsError: saying what may be asked.
        """
        object.__setattr__(self, "panels", words_of(self.panels, "the panels of a [[lock]]"))
        require("distance within which a [[lock]] holds", self.within, least=1e-3, unit=" mm")
        given: object = self.corners
        corners = tuple(given) if isinstance(given, list | tuple) else (given,)
        for corner in corners:
            Range(what="corner of a [[lock]]", least=0, whole=True).check(corner)
        object.__setattr__(self, "corners", corners)
        if not isinstance(self.delivery, str):
            raise SettingsError(f"the delivery of a [[lock]] is a folder, not {self.delivery!r:.80}")
        if corners and self.delivery:
            raise SettingsError("a [[lock]] to a delivery is about whole panels: leave its corners out")
        made = tuple(tuple((float(x), float(y), float(z)) for x, y, z in points) for points in self.made)
        object.__setattr__(self, "made", made)

    @property
    def unread(self) -> bool:
        """Whether it is about a delivery that was not read yet."""
        return bool(self.delivery) and not self.made

    def pose(self, reference: Reference, features: Sequence[PanelFeature]) -> list[Posed]:
        """See `Rule.pose`."""
        names = [panel.name for panel in reference.panels]
        panels = places_of(self.panels, names, self.table)
        if self.delivery:
            if len(self.made) != len(panels):
                raise SettingsError(f"what '{self.delivery}' holds of the panels of a [[lock]] was not read")
            held = [(np.arange(len(points)), np.array(points)) for points in self.made]
            for panel, (places, _) in zip(panels, held, strict=True):
                self._require_same(names[panel], features[panel], len(places))
        else:
            held = [self._drawn(reference.panels[i], features[i]) for i in panels]
        where = f"as in {self.delivery}" if self.delivery else "in the drawn place"
        rule = f"{called([names[i] for i in panels])} {where}"
        return [_Locked(rule, names, panels, held, self.within, tuple(panels) if self.made else ())]

    def _require_same(self, name: str, feature: PanelFeature, count: int) -> None:
        arcs = 6 * sum(feature.curved) if feature.four_sided else 0
        if count not in (feature.corner_count, feature.corner_count + arcs):
            raise SettingsError(
                f"panel '{name}' in '{self.delivery}' is no {feature.name}: give it the feature that it has there by a "
                "[[feature]]"
            )

    def _drawn(self, panel: PanelReference, feature: PanelFeature) -> tuple[IntArray, Array]:
        """Which of a panel's corners are locked, and where they are drawn."""
        drawn = panel.corners.reshape(-1, 3)
        which = np.array(self.corners or range(len(drawn)))
        if which.max() >= len(drawn):
            raise SettingsError(
                f"a [[lock]] names corner {which.max()} of panel '{panel.name}', which has corners 0 to "
                f"{len(drawn) - 1}"
            )
        count = feature.corner_count
        outer = np.array([0, count // 2 - 1, count // 2, count - 1]) if feature.four_sided else np.arange(count)
        return outer[which], drawn[which]


class _Locked(Posed):
    """Boundary points of panels that stay near given ones."""

    def __init__(
        self,
        rule: str,
        names: Sequence[str],
        panels: Sequence[int],
        held: Sequence[tuple[IntArray, Array]],
        within: float,
        frozen: tuple[int, ...],
    ) -> None:
        self._rule, self._within, self.frozen = rule, within, frozen
        self._held = list(zip(panels, held, strict=True))
        self._names = [names[i] for i in panels]

    def held(self, panels: Panels, pair_of: Mapping[tuple[int, int], int]) -> list[HeldTerm]:
        """See `Posed.held`."""
        del pair_of
        place, own, stand, points = panels.place, [], [], []
        for panel, (which, there) in self._held:
            own.append(np.full(len(which), panel))
            stand.append(places_in(panels.layout, panel)[which])
            local = (there - place.centre - place.origins[panel]) @ place.axes[panel]
            points.append(local / place.length)
        panel_of = np.concatenate(own)
        within = np.full(len(panel_of), (1.0 - _MARGIN) * self._within / place.length)
        return [NearTerm(panel_of, np.concatenate(stand), np.concatenate(points), within, panels.layout.panels)]

    def places(self) -> list[Place]:
        """See `Posed.places`."""
        within = (self._within,) * 3
        return [
            Place(self._rule, panel, point, tuple(at), within)
            for panel, (which, there) in self._held
            for point, at in zip(which.tolist(), there.tolist(), strict=True)
        ]

    def outcome(self, fitted: Fitted) -> Outcome:
        """See `Posed.outcome`."""
        found = {}
        for name, (panel, (which, there)) in zip(self._names, self._held, strict=True):
            found[name] = float(np.linalg.norm(boundary_of(fitted.shapes[panel])[which] - there, axis=1).max())
        return Outcome(
            rule=self._rule,
            measure="largest distance",
            found=max(found.values()),
            allowed=self._within,
            values=found,
        )
