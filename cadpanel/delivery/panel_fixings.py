"""The fixing holes of one panel, in its flat pattern, in its sheet and on its skin."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array
from cadpanel.delivery.settings import SheetSettings
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.geometry.fixings import FixingRule, Fixings, Hole, fixings, hole_bending
from cadpanel.geometry.flat_places import FlatPlace, flat_places
from cadpanel.geometry.panel import Panel
from cadpanel.geometry.sheet_checks import sheet_depth
from cadpanel.geometry.unroll import FlatPattern, neutral_offset, unroll


@dataclass(frozen=True, slots=True, kw_only=True)
class PanelFixings:
    """The holes of a panel.

    Attributes:
        rule: that they follow.
        found: the holes on the flat pattern.
        pattern: the panel's.
        places: its patches, on the skin and in the plane.
        area: of all holes on the surface that is unrolled, mm2.
        skin_area: what they take of the skin, mm2.
        volume: what they take of the sheet, mm3.
    """

    rule: FixingRule
    found: Fixings
    pattern: FlatPattern
    places: tuple[FlatPlace, ...]
    area: float
    skin_area: float
    volume: float

    @property
    def holes(self) -> tuple[Hole, ...]:
        """The same for those who drill them."""
        return tuple(
            Hole(patch=hole.patch, place=self.places[hole.patch], middle=hole.place, diameter=self.rule.diameter)
            for hole in self.found.holes
        )

    @property
    def middles(self) -> Array:
        """(h, 2) on the flat pattern, mm."""
        return np.array([hole.place for hole in self.found.holes]).reshape(-1, 2)


def panel_fixings(shape: Panel, sheet: SheetSettings, shop: ShopSettings) -> PanelFixings | None:
    """The holes that are asked for, of a panel as it is built; None where none are.

    Raises:
        PanelError: the panel bends both ways, and the K-factor is not 0.5.
    """
    if shop.fixings is None:
        return None
    diameter, pitch, distance = shop.fixings
    rule = FixingRule(diameter=diameter, pitch=pitch, distance=distance)
    offset = neutral_offset(shape, sheet.thickness, sheet.skin_side, shop.k_factor)
    pattern = unroll(shape, offset)
    places, found = flat_places(shape, pattern, offset), fixings(pattern, rule)
    one = 0.25 * math.pi * diameter**2
    area = one * len(found.holes)
    bending = sum(hole_bending(places[hole.patch], hole.place, diameter) for hole in found.holes)
    near, far = sorted((-offset, sheet_depth(sheet.thickness, sheet.skin_side) - offset))
    return PanelFixings(
        rule=rule,
        found=found,
        pattern=pattern,
        places=places,
        area=area,
        # An element of the unrolled surface has (1 + h / r) times its area at the height h over it.
        skin_area=area - offset * bending,
        volume=area * (far - near) + 0.5 * bending * (far**2 - near**2),
    )
