"""The rows of a setting-out table, from the records of a report alone."""

from __future__ import annotations

from collections.abc import Iterator
from decimal import Decimal

from cadpanel.delivery.contents import Contents
from cadpanel.delivery.records.report import PanelModel
from cadpanel.delivery.schedule.csv_text import Row

HEADINGS = ("panel", "corner", "x mm", "y mm", "z mm")
# Digits behind the point: far finer than anyone sets out, and nothing is lost where the model lies on a map.
_DIGITS = Decimal("0.0001")


def setting_out_rows(contents: Contents) -> Iterator[Row]:
    """Headings, the corners of every skin, those in which patches meet among them, and the middles of its holes."""
    yield HEADINGS
    for panel in contents.records:
        for corner, place in (*_corners(panel), *_fixings(panel)):
            # Map-grid coordinates have ten digits before the point: a double would lose those behind it.
            sums = [Decimal(own) + Decimal(offset) for own, offset in zip(place, contents.origin, strict=True)]
            yield (panel.name, corner, *(number.quantize(_DIGITS) + 0 for number in sums))


def _corners(panel: PanelModel) -> Iterator[tuple[str, tuple[float, float, float]]]:
    """Corners with their names: by end and ruling of a chain, by number round a polygon."""
    if len(panel.corners) == 1:
        for number, place in enumerate(panel.corners[0]):
            yield f"corner {number}", place
        return
    last = len(panel.patches)
    for end, row in enumerate(panel.corners):
        for ruling, place in enumerate(row):
            side = {0: "side 0", last: "side 1"}.get(ruling, f"ruling {ruling}")
            yield f"end {end}, {side}", place


def _fixings(panel: PanelModel) -> Iterator[tuple[str, tuple[float, float, float]]]:
    """Middles of fixing holes on the skin, numbered along the flat pattern's outline."""
    for number, hole in enumerate(panel.fixings, start=1):
        yield f"fixing {number}, {hole.edge}", hole.point
