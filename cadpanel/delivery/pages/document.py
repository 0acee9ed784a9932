"""All pages: the overview, and one a panel with its flat pattern, its folded shape and its numbers."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime

import numpy as np

from cadpanel.brep.building.meshing import triangles_of
from cadpanel.delivery.contents import Contents
from cadpanel.delivery.drawing.part import neighbours_of
from cadpanel.delivery.pages.flat_view import draw_flat
from cadpanel.delivery.pages.folded_view import draw_folded, panel_view
from cadpanel.delivery.pages.overview import draw_overview
from cadpanel.delivery.pages.paper import HEIGHT, MARGIN, WIDTH, Box, Paper
from cadpanel.delivery.pages.tables import BENDS, EDGES, bend_rows, draw_block, draw_table, edge_rows, fixing_rows
from cadpanel.delivery.part_data import part_number
from cadpanel.delivery.sheets import PanelSheet

_RIGHT = 130.0
"""Width of the column with the folded view, the tables and the block."""
_FRAME = Box(left=MARGIN, bottom=MARGIN, width=WIDTH - 2.0 * MARGIN, height=HEIGHT - 2.0 * MARGIN)
_FLAT = Box(left=MARGIN, bottom=MARGIN, width=WIDTH - 2.0 * MARGIN - _RIGHT, height=HEIGHT - 2.0 * MARGIN)
_FOLDED = Box(left=WIDTH - MARGIN - _RIGHT + 10.0, bottom=205.0, width=_RIGHT - 20.0, height=75.0)
_CHORD, _ANGLE = 0.2, 0.4
"""How far and by how many radians the facets of a folded view may lie off its faces, mm on paper."""
_EDGES_BELOW = 16
_TABLES = (WIDTH - MARGIN - _RIGHT + 2.0, 195.0)


def pdf_bytes(contents: Contents, sheets: Sequence[PanelSheet], date: datetime) -> bytes:
    """A whole file; the same delivery at the same date gives the same bytes."""
    paper = Paper(contents.title, contents.shop.author)
    _overview_page(paper, contents, sheets, date)
    for place in range(len(sheets)):
        paper.turn()
        _panel_page(paper, contents, sheets, place, date)
    return paper.data()


def _overview_page(paper: Paper, contents: Contents, sheets: Sequence[PanelSheet], date: datetime) -> None:
    _frame(paper)
    rows = [
        ("project", contents.title),
        ("panels", str(len(sheets))),
        *_of_all(contents, date),
        ("page", f"1 / {len(sheets) + 1}"),
    ]
    draw_block(paper, rows, WIDTH - MARGIN, MARGIN, _RIGHT)
    height = _FRAME.height - 60.0
    box = Box(left=_FRAME.left + 10.0, bottom=_FRAME.bottom + 50.0, width=_FRAME.width - 20.0, height=height)
    draw_overview(paper, [sheet.shape for sheet in sheets], contents.records, box)


def _panel_page(paper: Paper, contents: Contents, sheets: Sequence[PanelSheet], place: int, date: datetime) -> None:
    record, part, built = contents.records[place], contents.parts[place], sheets[place]
    neighbours = neighbours_of(contents.seams).get(record.name, {})
    _frame(paper)
    scale = draw_flat(paper, part, neighbours, _FLAT)
    # As fine as paper shows it, so that pages stay small and are read quickly.
    chord = _CHORD * part.blank.width / _FOLDED.width
    draw_folded(paper, triangles_of(built.solid, chord, _ANGLE), panel_view(built.shape), _FOLDED)
    left, top = _TABLES
    if part.bends:
        _, foot = draw_table(paper, BENDS, bend_rows(part.bends), left, top)
        top = foot - 6.0
    edges = edge_rows(part, neighbours)
    # A polygon may have more edges than rows fit below one another.
    for start in range(0, len(edges), _EDGES_BELOW):
        right, _ = draw_table(paper, EDGES, edges[start : start + _EDGES_BELOW], left, top)
        left = right + 3.0
    blank = part.blank
    rows = [
        ("panel", record.name),
        ("part number", part_number(contents.title, record.name)),
        ("feature", record.feature),
        ("blank", f"{blank.width:.1f} x {blank.height:.1f} mm, {blank.area * 1e-6:.4f} m2"),
        ("mass", "" if record.mass is None else f"{record.mass:.2f} kg"),
        ("stock sheet", blank.stock or "-"),
        *fixing_rows(part),
        ("drawing", f"{blank.file}.dxf"),
        *_of_all(contents, date),
        ("scale", f"1 : {round(1.0 / scale)}"),
        ("page", f"{place + 2} / {len(sheets) + 1}"),
    ]
    draw_block(paper, rows, WIDTH - MARGIN, MARGIN, _RIGHT)


def _of_all(contents: Contents, date: datetime) -> list[tuple[str, str]]:
    shop = contents.shop
    named = [("author", shop.author), ("organization", shop.organization)]
    return [
        ("sheet", ", ".join(filter(None, (f"{contents.sheet.thickness:g} mm", shop.material)))),
        *((what, value) for what, value in named if value),
        ("units", "mm, degrees"),
        *([("coordinates", contents.where)] if contents.where else []),
        ("date", date.strftime("%Y-%m-%d")),
    ]


def _frame(paper: Paper) -> None:
    left, bottom, right, top = MARGIN, MARGIN, WIDTH - MARGIN, HEIGHT - MARGIN
    paper.contour(np.array([[left, bottom], [right, bottom], [right, top], [left, top]]), width=0.5)
