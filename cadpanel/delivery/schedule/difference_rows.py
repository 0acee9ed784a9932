"""The rows of a difference of two deliveries."""

from __future__ import annotations

from cadpanel.delivery.records.difference import DifferenceModel
from cadpanel.delivery.schedule.csv_text import Row

HEADINGS = (
    *("panel", "before", "status", "cut again", "bend again", "corners moved mm", "contour mm", "bend lines mm"),
    *(
        "holes mm",
        "inner radius mm",
        "sweep deg",
        "bevel deg",
        "blank area mm2",
        "mass kg",
        "feature before",
        "feature now",
    ),
)


def difference_rows(found: DifferenceModel) -> list[Row]:
    """One row a panel under headings."""
    rows: list[Row] = [HEADINGS]
    for panel in found.panels:
        flat = (panel.contour, panel.bend_lines, panel.holes)
        lengths = (panel.moved, *flat, panel.radius, panel.sweep, panel.bevel, panel.area)
        rows.append(
            (
                *(panel.name, panel.before, panel.status, _yes(panel.cut_again), _yes(panel.bend_again)),
                *(None if value is None else round(value, 4) + 0.0 for value in (*lengths, panel.mass)),
                *(panel.features or (None, None)),
            )
        )
    return rows


def _yes(value: bool) -> str:
    return "yes" if value else "no"
