"""Rows as a file that spreadsheets read: commas, UTF-8 with a mark of it, and no cell that runs as a formula."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Sequence
from decimal import Decimal

Cell = str | int | float | Decimal | None
Row = Sequence[Cell]
_MARK = "\ufeff"  # without it, Excel takes the file for another encoding
_FORMULAS = ("=", "+", "-", "@", "\t", "\r")


def csv_bytes(rows: Iterable[Row]) -> bytes:
    """A file; numbers as they are, nothing where there is none."""
    stream = io.StringIO()
    csv.writer(stream, lineterminator="\r\n").writerows([_shown(cell) for cell in row] for row in rows)
    return (_MARK + stream.getvalue()).encode("utf-8", errors="backslashreplace")


def _shown(cell: Cell) -> str:
    """Text that a spreadsheet would run is quoted as text, as spreadsheets do it."""
    if cell is None:
        return ""
    if isinstance(cell, str):
        return f"'{cell}" if cell.startswith(_FORMULAS) else cell
    return f"{cell:f}" if isinstance(cell, Decimal) else str(cell)
