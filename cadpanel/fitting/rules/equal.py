"""Groups of panels whose bends are alike: one radius, one half angle, one tool."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import ClassVar

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.errors import SettingsError
from cadpanel.features.rulings import PanelFeature
from cadpanel.fitting.rules.bends import NUMBERS, bends_of, common, require_bends
from cadpanel.fitting.rules.rule import Bends, Fitted, Outcome, Posed, Rule, called, places_of, words_of
from cadpanel.reference.model import Reference
from cadpanel.terms.limits.limit import Panels
from cadpanel.terms.rules.alike import HALF_ANGLE, RADIUS, AlikeTerm
from cadpanel.terms.term import HeldTerm

# How nearly alike panels are held while all is solved, a share of the radius or radians; then they are made equal.
_NEARLY = 1e-3
SAME_RADIUS, SAME_ANGLE = 1e-6, 1e-6
"""mm and degrees within which two bends are equal: what doubles leave of equal numbers."""


@dataclass(frozen=True, slots=True, kw_only=True)
class EqualRule(Rule):
    """Panels with bends of one radius, one half angle, or both.

    Attributes:
        panels: names.
        radius: whether their radii are equal, halfway between the ends.
        half_angle: whether their half angles are.
    """

    table: ClassVar[str] = "equal"

    panels: tuple[str, ...]
    radius: bool = False
    half_angle: bool = False

    def __post_init__(self) -> None:
        """Refuse what makes nothing equal.

        Raises:
            SettingsError: saying what to write.
        """
        object.__setattr__(self, "panels", words_of(self.panels, "the panels of an [[equal]]"))
        if not all(value is True or value is False for value in (self.radius, self.half_angle)):
            raise SettingsError("radius and half_angle of an [[equal]] are true or false")
        if not (self.radius or self.half_angle):
            raise SettingsError("an [[equal]] says what is equal: radius = true, half_angle = true, or both")

    def pose(self, reference: Reference, features: Sequence[PanelFeature]) -> list[Posed]:
        """See `Rule.pose`."""
        names = [panel.name for panel in reference.panels]
        panels = places_of(self.panels, names, self.table)
        if len(panels) < 2:
            raise SettingsError(f"an [[equal]] is about two panels at least, and there is only '{names[panels[0]]}'")
        bends = require_bends(names, panels, features, self.table)
        asked = zip(NUMBERS, (self.radius, self.half_angle), strict=True)
        return [Alike(names, np.array(panels), bends, what) for what, wanted in asked if wanted]


class Alike(Posed):
    """Panels with bends that are alike in one number."""

    def __init__(
        self, names: Sequence[str], panels: IntArray, bends: int, what: str, side: Array | None = None
    ) -> None:
        """Make the `what` of panels (n,) equal, or equal but for the signs (n,) of their sides."""
        self._side = np.ones(len(panels)) if side is None else side
        self._panels, self._bends, self._number = panels, bends, NUMBERS.index(what)
        self._names = [names[i] for i in panels.tolist()]
        # A chain of neighbours leaves the matrix of a strip as narrow as it is.
        self.links = np.array(list(pairwise(panels.tolist())), dtype=np.intp).reshape(-1, 2)

    def held(self, panels: Panels, pair_of: Mapping[tuple[int, int], int]) -> list[HeldTerm]:
        """See `Posed.held`."""
        first, second = self.links.T
        pair = np.array([pair_of[one, two] for one, two in self.links.tolist()], dtype=np.intp)
        what = (RADIUS, HALF_ANGLE)[self._number]
        count = panels.layout.panels
        sides = np.ones(count)
        sides[self._panels] = self._side
        return [AlikeTerm(first, second, pair, bends=self._bends, what=what, within=_NEARLY, sides=sides)]

    def settled(self, bends: Bends, choice: int) -> Bends:
        """See `Posed.settled`."""
        del choice
        values, held = bends.values.copy(), bends.held.copy()
        turned = bends.values.copy()
        turned[self._panels, :, 1] *= self._side[:, None]
        alike = common(replace(bends, values=turned), self._panels)[: self._bends, self._number]
        signs = self._side[:, None] if self._number else 1.0
        values[self._panels, : self._bends, self._number] = signs * alike
        held[self._panels, : self._bends, self._number] = True
        return replace(bends, values=values, held=held)

    def outcome(self, fitted: Fitted) -> Outcome:
        """See `Posed.outcome`."""
        found = bends_of([fitted.shapes[i] for i in self._panels])[:, : self._bends, self._number]
        angles = bool(self._number)
        shown = np.degrees(self._side[:, None] * found) if angles else found
        return Outcome(
            rule=f"{called(self._names)}: equal {'half angle' if angles else 'radius'}",
            measure="spread of half angles" if angles else "spread of radii",
            found=float(np.ptp(shown, axis=0).max()),
            allowed=SAME_ANGLE if angles else SAME_RADIUS,
            unit="degrees" if angles else "mm",
            values=dict(zip(self._names, shown[:, 0].tolist(), strict=True)),
        )
