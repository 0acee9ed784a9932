"""Rows as a workbook: text stays text, whatever it begins with, and the same rows give the same bytes."""

from __future__ import annotations

import io
import re
from collections.abc import Iterable
from pathlib import Path
from zipfile import ZIP_DEFLATED, BadZipFile, ZipFile, ZipInfo

from cadpanel.delivery.schedule.csv_text import Cell, Row
from cadpanel.delivery.source_date import archive_date, source_date
from cadpanel.errors import DeliveryError

# What no workbook can hold, and what no name of a sheet can.
_NOT_SHOWN = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f\ufffe\uffff\ud800-\udfff]")
_NOT_IN_A_NAME = re.compile(r"[\\*?:/\[\]]")
_LONGEST_NAME = 31
_WRITTEN = re.compile(rb"(<dcterms:(created|modified)[^>]*>)[^<]*")
_WIDTH = 14


def workbook_bytes(rows: Iterable[Row], title: str) -> bytes:
    """A workbook of one sheet, its first row in bold and in sight."""
    from openpyxl import Workbook
    from openpyxl.styles import Font
    from openpyxl.utils import get_column_letter

    book = Workbook()
    sheet = book.active
    sheet.title = _NOT_IN_A_NAME.sub("_", _shown(title)).strip("'")[:_LONGEST_NAME] or "schedule"
    for number, row in enumerate(cells_of(rows), start=1):
        for column, value in enumerate(row, start=1):
            cell = sheet.cell(number, column)
            cell.value = value
            if isinstance(value, str):
                cell.data_type = "s"  # else a name that begins with = would be a formula
            if number == 1:
                cell.font = Font(bold=True)
                sheet.column_dimensions[get_column_letter(column)].width = _WIDTH
    sheet.freeze_panes = "A2"
    stream = io.BytesIO()
    book.save(stream)
    return _dated(stream)


def cells_of(rows: Iterable[Row]) -> list[list[Cell]]:
    """Rows as a workbook gives them back: without what it cannot hold, and without empty cells at the end."""
    found = [[_shown(cell) if isinstance(cell, str) else cell for cell in row] for row in rows]
    for row in found:
        while row and row[-1] in (None, ""):
            row.pop()
    return [[None if cell == "" else cell for cell in row] for row in found]


def rows_of_workbook(path: Path) -> list[list[Cell]]:
    """The cells of a workbook's first sheet.

    Raises:
        DeliveryError: it cannot be read.
    """
    from openpyxl import load_workbook
    from openpyxl.utils.exceptions import InvalidFileException

    try:
        book = load_workbook(path)
    except OSError as error:
        raise DeliveryError(f"'{path}' cannot be read: {error.strerror or error}.") from error
    except (BadZipFile, InvalidFileException, KeyError, ValueError, SyntaxError) as error:
        raise DeliveryError(f"'{path}' cannot be read: it is no workbook ({error}).") from error
    return cells_of([list(row) for row in book.worksheets[0].iter_rows(values_only=True)])


def _shown(text: str) -> str:
    return _NOT_SHOWN.sub("_", text).replace("\r", "\n")


def _dated(stream: io.BytesIO) -> bytes:
    """The same archive with the date of the environment instead of the time of day."""
    date, moment = source_date(), archive_date()
    out = io.BytesIO()
    with ZipFile(stream) as written, ZipFile(out, "w", ZIP_DEFLATED) as dated:
        for name in written.namelist():
            data = _WRITTEN.sub(rb"\g<1>" + date.strftime("%Y-%m-%dT%H:%M:%SZ").encode(), written.read(name))
            entry = ZipInfo(name, moment)
            entry.compress_type = ZIP_DEFLATED
            dated.writestr(entry, data)
    return out.getvalue()
