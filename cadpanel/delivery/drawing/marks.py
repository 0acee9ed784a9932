"""What is written on a flat part and beside it: names, sides, the way to the strip's start, the numbers of bends."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from cadpanel.arrays import Array
from cadpanel.delivery.drawing.entities import WIDTH_OF_A_SIGN, Entity, Line, Text
from cadpanel.delivery.records.flat_parts import FlatPart
from cadpanel.delivery.records.report import PanelModel
from cadpanel.delivery.settings import SheetSettings
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.geometry.flat_curves import FlatCurves

OUTSIDE = "this face out"
# Height of the panel's name: this part of the blank's width, and between so many mm.
_NAME, _LEAST, _MOST = 0.06, 2.0, 40.0
# Height of what stands along edges, as a part of the name's.
_SMALL = 0.6
# No text is wider than this part of what it stands in.
_FILLED = 0.8
# A smaller bevel, in degrees, is none to all digits that are told, and a smaller difference of two.
_SQUARE = 0.05


def marks(part: FlatPart, neighbours: Mapping[str, str], layer: str) -> list[Entity]:
    """The panel's name, "this face out", an arrow to the strip's start, side 0, and at every edge who is met there."""
    pattern, width = part.pattern, part.blank.height
    middle = _middle(part)
    height = _fitting(max(_LEAST, min(_MOST, _NAME * width)), pattern.name, _FILLED * width)
    small = _SMALL * height
    found: list[Entity] = [
        Text(layer, pattern.name, middle, height),
        Text(layer, OUTSIDE, middle - [0.0, 1.4 * height], _fitting(small, OUTSIDE, _FILLED * width)),
    ]
    if any(edge.startswith("end") for edge in pattern.edges):
        found += _arrow(layer, middle - [0.0, 2.2 * height], 2.0 * height)
    for edge in part.size.edges:
        words = ": ".join(word for word in (_named(edge), neighbours.get(edge, "")) if word)
        if words:
            found.append(_along_edge(part, edge, words, small, layer))
    return found


def info(part: FlatPart, record: PanelModel, sheet: SheetSettings, shop: ShopSettings) -> list[Entity]:
    """Lines of text below the part: thickness, blank, bends, bevels."""
    corners = part.pattern.curves.start
    height = max(_LEAST, min(0.5 * _MOST, 0.5 * _NAME * part.blank.height))
    left, below = float(corners[:, 0].min()), float(corners[:, 1].min()) - 3.0 * height
    found: list[Entity] = []
    for row, words in enumerate(_sentences(part, record, sheet, shop)):
        place = np.array([left, below - 1.8 * height * row])
        found.append(Text(shop.layer("INFO"), words, place, height, left=True))
    return found


def _sentences(part: FlatPart, record: PanelModel, sheet: SheetSettings, shop: ShopSettings) -> Iterator[str]:
    yield f"{record.name}, {record.feature}, thickness {sheet.thickness:g} mm, K-factor {shop.k_factor:g}"
    yield f"blank {part.blank.width:.1f} x {part.blank.height:.1f} mm"
    for number, bend in enumerate(part.bends, start=1):
        yield (
            f"bend {number} {bend.direction}: inner radius {bend.radius[0]:.1f} to {bend.radius[1]:.1f} mm, "
            f"sweep {bend.sweep:.2f} deg, {bend.lengths[0]:.1f} mm at end 0, {bend.lengths[1]:.1f} mm at end 1"
        )
    if part.fixings is not None:
        yield f"{len(part.fixings.found.holes)} holes of {part.fixings.rule.diameter:g} mm"
    for edge, (least, largest) in record.bevels.items():
        if edge.startswith("end") or largest - least >= _SQUARE:
            yield f"{edge}: bevel {least:.1f} to {largest:.1f} deg"
        elif abs(least) >= _SQUARE:
            yield f"{edge}: bevel {least:.1f} deg"


def _named(edge: str) -> str:
    """Side 0 is always marked, and of a polygon edge 0: by it the part is told from its mirror image."""
    return edge if edge in ("side 0", "edge 0") else ""


def _arrow(layer: str, tail: Array, length: float) -> list[Entity]:
    """An arrow downwards, to end 0, which is where the strip begins."""
    tip = tail - [0.0, length]
    wings = [tip + 0.3 * length * np.array([side, 1.0]) for side in (-1.0, 1.0)]
    return [Line(layer, tail, tip), *(Line(layer, wing, tip) for wing in wings)]


def _along_edge(part: FlatPart, edge: str, words: str, height: float, layer: str) -> Text:
    """Words inside of an edge, beside its middle, to be read from below or from the right."""
    rows = [row for row, own in enumerate(part.pattern.edges) if own == edge]
    lengths = [part.size.pieces[row] for row in rows]
    row, share = _halfway(rows, lengths)
    piece = part.pattern.curves.take(slice(row, row + 1))
    place, way = (of(np.array([[share]]))[0, 0] for of in (piece.points, piece.velocities))
    angle = math.atan2(way[1], way[0])
    height = _fitting(height, words, _FILLED * sum(lengths))
    inwards = np.array([-way[1], way[0]]) / math.hypot(*way)
    # Written along a bent edge it must keep clear of the bow, too.
    bow = _bow(part.pattern.curves.take(np.array(rows)), place, inwards, 0.5 * WIDTH_OF_A_SIGN * height * len(words))
    # A turn of just under half a circle is told from one of just over it with a margin.
    upright = angle if -0.5 * math.pi - 1e-6 < angle <= 0.5 * math.pi + 1e-6 else angle - math.copysign(math.pi, angle)
    return Text(layer, words, place + (1.2 * height + bow) * inwards, height, upright)


def _bow(curves: FlatCurves, place: Array, inwards: Array, reach: float) -> float:
    """How far an edge comes inwards within `reach` mm of a place on it."""
    points = curves.points(np.broadcast_to(np.linspace(0.0, 1.0, 33), (len(curves), 33))).reshape(-1, 2) - place
    near = points[np.linalg.norm(points, axis=-1) <= reach]
    return max(0.0, float((near @ inwards).max(initial=0.0)))


def _halfway(rows: Sequence[int], lengths: Sequence[float]) -> tuple[int, float]:
    """The piece that holds the middle of an edge, and about where on it."""
    left = 0.5 * sum(lengths)
    for row, length in zip(rows, lengths, strict=True):
        # An edge whose middle is a corner is taken on the earlier piece, whatever the last digit says.
        if left <= length * (1.0 + 1e-9):
            return row, min(1.0, left / length)
        left -= length
    return rows[-1], 1.0


def _middle(part: FlatPart) -> Array:
    """The middle of the part's area, by the polygon of its corners."""
    points = part.pattern.curves.start
    after = np.roll(points, -1, axis=0)
    doubled = points[:, 0] * after[:, 1] - points[:, 1] * after[:, 0]
    middle: Array = ((points + after) * doubled[:, None]).sum(axis=0) / (3.0 * doubled.sum())
    return middle


def _fitting(height: float, words: str, width: float) -> float:
    """The height at which words stay within a width."""
    return min(height, width / (WIDTH_OF_A_SIGN * max(1, len(words))))
