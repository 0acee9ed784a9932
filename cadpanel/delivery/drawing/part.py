"""The drawing of one flat part: its contour, where it bends, how it is rolled, and what is written on it."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from cadpanel.arrays import Array
from cadpanel.delivery.drawing.entities import Circle, Contour, Drawing, Entity, Line
from cadpanel.delivery.drawing.marks import info, marks
from cadpanel.delivery.records.flat_parts import FlatPart
from cadpanel.delivery.records.report import PanelModel, SeamModel
from cadpanel.delivery.settings import SheetSettings
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.geometry.biarcs import arc_chains
from cadpanel.geometry.flat_curves import joined

_MIDDLE = np.array([0.5])


def part_drawings(
    parts: Sequence[FlatPart],
    records: Sequence[PanelModel],
    seams: Sequence[SeamModel],
    sheet: SheetSettings,
    shop: ShopSettings,
) -> list[Drawing]:
    """One drawing a part, seen from outside, in the order of the parts."""
    chains = contours(parts, shop.chord)
    neighbours = neighbours_of(seams)
    drawings: list[Drawing] = []
    for part, record, contour in zip(parts, records, chains, strict=True):
        drawn: list[Entity] = [Contour(shop.layer("CUT"), contour)]
        if part.fixings is not None:
            drawn += [
                Circle(shop.layer("CUT"), middle, 0.5 * part.fixings.rule.diameter) for middle in part.fixings.middles
            ]
        if not shop.dxf_contour_only:
            drawn += [Line(shop.layer("BEND"), *line) for line in bend_lines(part)]
            drawn += [Line(shop.layer("ROLL"), *line) for line in roll_lines(part, shop.roll_pitch)]
            drawn += marks(part, neighbours.get(record.name, {}), shop.layer("MARK"))
            drawn += info(part, record, sheet, shop)
        drawings.append(tuple(drawn))
    return drawings


def contours(parts: Sequence[FlatPart], chord: float) -> list[Array]:
    """(v, 3) the contour of each part as a closed chain of arcs within `chord` mm."""
    curves = [part.pattern.curves for part in parts]
    chains = iter(arc_chains(joined(curves), chord))
    return [np.concatenate([next(chains) for _ in range(len(own))]) for own in curves]


def bend_lines(part: FlatPart) -> Array:
    """(m, 2, 2) the lines along which patches meet, and the middle line of each bend."""
    middles = [part.pattern.rulings(bend, _MIDDLE) for bend in part.pattern.bends]
    return np.concatenate([part.pattern.tangents, *middles])


def roll_lines(part: FlatPart, pitch: float) -> Array:
    """(m, 2, 2) rulings inside of the bends, by equal parts of the sweep and at most `pitch` mm apart at the ends."""
    found = [np.empty((0, 2, 2))]
    for bend, numbers in zip(part.pattern.bends, part.bends, strict=True):
        spaces = max(1, math.ceil(max(numbers.lengths) / pitch - 1e-9))
        shares = np.arange(1, spaces) / spaces
        # The middle line is drawn as one of the bend's.
        found.append(part.pattern.rulings(bend, shares[np.abs(shares - 0.5) > 1e-6]))
    return np.concatenate(found)


def neighbours_of(seams: Sequence[SeamModel]) -> Mapping[str, Mapping[str, str]]:
    """By panel and edge the name of the panel that it meets there."""
    found: dict[str, dict[str, str]] = {}
    for seam in seams:
        for own in (0, 1):
            found.setdefault(seam.panels[own], {})[seam.edges[own]] = seam.panels[1 - own]
    return found
