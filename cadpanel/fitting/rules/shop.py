"""The shop's tools: radii that it can roll and press."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.errors import SettingsError
from cadpanel.features.rulings import PanelFeature
from cadpanel.fitting.rules.bends import bends_of, numbers_of, require_bends
from cadpanel.fitting.rules.equal import SAME_RADIUS
from cadpanel.fitting.rules.rule import Bends, Fitted, Outcome, Posed, Rule
from cadpanel.reference.model import Reference
from cadpanel.setting import require
from cadpanel.terms.limits.min_radius import MinRadius


@dataclass(frozen=True, slots=True, kw_only=True)
class ShopRule(Rule):
    """Bends have radii of a list, halfway between the ends.

    Attributes:
        radii: of the tools, mm.
        add: what a skin's radius has more than its tool's, mm: the thickness, where tools lie inside and the skin is
            the outer face.
    """

    table: ClassVar[str] = "shop"
    several: ClassVar[bool] = False

    radii: tuple[float, ...]
    add: float = 0.0

    def __post_init__(self) -> None:
        """Refuse what are no radii.

        Raises:
            SettingsError: naming the one that is none.
        """
        asked: object = self.radii
        given = asked if isinstance(asked, list | tuple) else ()
        if not given:
            raise SettingsError("the [shop] has radii = [300, 350, ...], mm")
        require("what is to be added to the radii of the [shop]", self.add, least=-1e5, most=1e5, unit=" mm")
        for radius in given:
            require("radius of a tool of the [shop]", radius, least=0.1, unit=" mm")
            require("radius of the skin over a tool of the [shop]", radius + self.add, least=0.1, unit=" mm")
        object.__setattr__(self, "radii", tuple(sorted({float(radius) for radius in given})))

    def check(self, allowed: Mapping[str, float]) -> None:
        """See `Rule.check`: a tool rolls no tighter than the least radius."""
        widest, least = self.radii[-1] + self.add, allowed[MinRadius.name]
        if widest < least:
            raise SettingsError(
                f"the widest tool of the [shop] makes a radius of {widest:g} mm, where {least:g} mm is the least: "
                "name a wider tool, or allow a tighter radius"
            )

    def pose(self, reference: Reference, features: Sequence[PanelFeature]) -> list[Posed]:
        """See `Rule.pose`; flat panels need no tool."""
        names = [panel.name for panel in reference.panels]
        bent = [i for i, feature in enumerate(features) if any(feature.curved)]
        if not bent:
            raise SettingsError("the radii of the [shop] are about bends, and no panel has one: choose another feature")
        for panel in bent:
            require_bends(names, [panel], features, self.table)
            for number in numbers_of(features[panel], "radius"):
                if number is not None and features[panel].numbers[number].fixed is not None:
                    raise SettingsError(
                        f"the radius of '{features[panel].name}' is fixed by its author: leave the [shop] out, or let "
                        "the fit choose it"
                    )
        return [_Tools(names, np.array(bent), np.array(self.radii) + self.add, reference)]


class _Tools(Posed):
    """Panels with bends of tools' radii.

    Each panel gets the tool nearest to what was best for it; or else, as neighbours with other radii may not meet, all
    that hang together get one.
    """

    choices = 2

    def __init__(self, names: Sequence[str], panels: IntArray, radii: Array, reference: Reference) -> None:
        self._panels, self._radii = panels, radii
        self._names = [names[i] for i in panels.tolist()]
        self._together = _together(len(names), reference)

    def settled(self, bends: Bends, choice: int) -> Bends:
        """See `Posed.settled`."""
        values, held = bends.values.copy(), bends.held.copy()
        own = values[self._panels, :, 0]
        if choice:
            label = self._together[self._panels]
            for one in np.unique(label):
                mean = np.exp(np.nanmean(np.log(own[label == one]), axis=0))
                own[label == one] = np.where(np.isnan(own[label == one]), np.nan, mean)
        there = ~np.isnan(own)
        values[self._panels, :, 0] = np.where(there, self._nearest(own), np.nan)
        held[self._panels, :, 0] = there
        return replace(bends, values=values, held=held)

    def _nearest(self, radii: Array) -> Array:
        """The tools' radii nearest to these, by their ratios."""
        off = np.abs(np.log(np.where(np.isnan(radii), 1.0, radii))[..., None] - np.log(self._radii))
        return np.asarray(self._radii[off.argmin(axis=-1)])

    def outcome(self, fitted: Fitted) -> Outcome:
        """See `Posed.outcome`."""
        found = bends_of([fitted.shapes[i] for i in self._panels])[..., 0]
        off = np.abs(found[..., None] - self._radii).min(axis=-1)
        return Outcome(
            rule="radii of the shop's tools",
            measure="distance from the nearest",
            found=float(np.nanmax(off)),
            allowed=SAME_RADIUS,
            values=dict(zip(self._names, found[:, 0].tolist(), strict=True)),
        )


def _together(count: int, reference: Reference) -> IntArray:
    """(panels,) a label for each set of panels that seams connect."""
    label = np.arange(count)
    for seam in reference.seams:
        low, high = sorted(label[list(seam.panels)].tolist())
        label[label == high] = low
    return label
