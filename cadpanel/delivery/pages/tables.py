"""Tables on a page: the numbers of bends and edges, and the block that says what the page is."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from cadpanel.delivery.pages.paper import Paper, width_of
from cadpanel.delivery.records.blanks import BendModel
from cadpanel.delivery.records.flat_parts import FlatPart

ROW = 4.6
"""Height of a row, mm."""
_LETTERS = 2.2
_PAD = 1.2

BENDS = ("bend", "way", "inner radius", "sweep", "half angle", "at end 0", "at end 1", "angle 0", "angle 1", "hits")
EDGES = ("edge", "length", "meets", "bevel")


def bend_rows(bends: Sequence[BendModel]) -> list[tuple[str, ...]]:
    """One row a bend, mm and degrees."""
    return [
        (
            str(number),
            bend.direction,
            f"{bend.radius[0]:.1f} - {bend.radius[1]:.1f}",
            f"{bend.sweep:.2f}",
            f"{bend.half_angle:.3f}",
            *(f"{length:.1f}" for length in bend.lengths),
            *(f"{angle:.2f}" for angle in bend.angles),
            str(bend.hits),
        )
        for number, bend in enumerate(bends, start=1)
    ]


def edge_rows(part: FlatPart, neighbours: Mapping[str, str]) -> list[tuple[str, ...]]:
    """One row an edge of the blank, mm and degrees."""
    rows: list[tuple[str, ...]] = []
    for edge, length in part.size.edges.items():
        least, largest = part.bevels.get(edge, (0.0, 0.0))
        bevel = f"{least:.1f}" if abs(largest - least) < 0.05 else f"{least:.1f} to {largest:.1f}"
        rows.append((edge, f"{length:.1f}", neighbours.get(edge, ""), bevel))
    return rows


def fixing_rows(part: FlatPart) -> list[tuple[str, str]]:
    """How many holes a part has, of which diameter; nothing where none are asked for."""
    if part.fixings is None:
        return []
    return [("fixing holes", f"{len(part.circles)} of {part.fixings.rule.diameter:g} mm")]


def draw_table(
    paper: Paper, headings: Sequence[str], rows: Sequence[Sequence[str]], left: float, top: float
) -> tuple[float, float]:
    """Draw a table from its upper left corner; returns its right side and its foot."""
    columns = list(zip(headings, *rows, strict=True))
    widths = [
        max(width_of(words, _LETTERS, bold=not place) for place, words in enumerate(column)) + 2.0 * _PAD
        for column in columns
    ]
    stops = left + np.concatenate([[0.0], np.cumsum(widths)])
    foot = top - ROW * (len(rows) + 1)
    for y in (top, top - ROW, foot):
        paper.lines(np.array([[left, y], [stops[-1], y]]), width=0.18)
    for number, row in enumerate((headings, *rows), start=1):
        for x, words in zip(stops.tolist(), row, strict=False):
            paper.words(words, (x + _PAD, top - ROW * number + 1.3), _LETTERS, bold=number == 1)
    return float(stops[-1]), foot


def draw_block(paper: Paper, rows: Sequence[tuple[str, str]], right: float, bottom: float, width: float) -> None:
    """Draw what a page says of itself, words and their values, in the lower right corner."""
    top, left = bottom + ROW * len(rows), right - width
    box = np.array([[left, bottom], [right, bottom], [right, top], [left, top]])
    paper.contour(box, width=0.35)
    for number, (what, value) in enumerate(rows, start=1):
        y = top - ROW * number
        paper.lines(np.array([[left, y], [right, y]]), width=0.1)
        paper.words(what, (left + _PAD, y + 1.3), _LETTERS)
        height = _LETTERS * min(1.0, (width - 30.0) / max(width_of(value, _LETTERS, bold=True), 1e-9))
        paper.words(value, (left + 28.0, y + 1.3), height, bold=True)
