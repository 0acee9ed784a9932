"""summary.json and summary.csv: what came of a job, a row a region."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field

from cadpanel.delivery.records.jsonfile import NonNegative, NonNegativeCount, Record, json_bytes, read_json
from cadpanel.delivery.records.report import ReportModel
from cadpanel.delivery.schedule.csv_text import Cell, csv_bytes
from cadpanel.delivery.whole_file import write_whole
from cadpanel.errors import DeliveryError

SUMMARY, SUMMARY_TABLE = "summary.json", "summary.csv"
SCHEMA = "cadpanel.summary/1"

STOPPED = 130
"""Code of a run that ended before all regions were done, as a program says that was interrupted."""
Code = Annotated[int, Field(ge=0, le=STOPPED)]
State = Literal["made", "kept", "there", "none", "waiting"]
_MEASURED = ("rms_deviation", "max_deviation", "max_corner_gap", "max_seam_gap", "max_width", "max_step", "max_shift")


class RowModel(Record):
    """One region.

    Attributes:
        region: its name, and that of its folder.
        state: "made" now; "kept" from an earlier run; "there" as it stood in the folder; "none" where there is no
            delivery; "waiting" where the run ended before its turn.
        panels: how many.
        rms_deviation: root mean square over all samples, mm.
        max_deviation: largest distance of the drawing from the panels, mm.
        max_corner_gap, max_seam_gap, max_width, max_step, max_shift: the largest gaps and parts of them, mm.
        met: whether everything that is asked of the region holds; None where nothing was made.
        seconds: from reading to the proof, when it was made.
        tries: how often it was tried now.
        said: what is missed, or why there is no delivery.
        details: where in the program a failure was that nobody foresaw.
    """

    region: str
    state: State
    panels: NonNegativeCount | None = None
    rms_deviation: NonNegative | None = None
    max_deviation: NonNegative | None = None
    max_corner_gap: NonNegative | None = None
    max_seam_gap: NonNegative | None = None
    max_width: NonNegative | None = None
    max_step: NonNegative | None = None
    max_shift: NonNegative | None = None
    met: bool | None = None
    seconds: NonNegative | None = None
    tries: NonNegativeCount = 0
    said: str | None = None
    details: str = ""


class SummaryModel(Record):
    """summary.json as a whole; rows in the order of the job, `code` as the run ended.

    Attributes:
        code: 0 all holds; 1 something asked for is missed; 2 a region was refused; 3 one failed as nobody foresaw; 130
            the run ended before all were done.
        rows: a region each.
        assembly: name of the STEP file in which the panels of all regions hang; None where there is none.
        unassembled: in sentences, which regions do not hang in it, or why there is none, where they have files for it.
        remarks: in sentences, what else whoever started it should know: of deliveries in the folder that are not what
            the job asks for, and of results that could not be kept.
    """

    schema_name: Literal["cadpanel.summary/1"] = Field(default="cadpanel.summary/1", alias="schema")
    code: Code
    rows: tuple[RowModel, ...]
    assembly: str | None = None
    unassembled: str | None = None
    remarks: tuple[str, ...] = ()


def row_of(region: str, report: ReportModel, state: State, said: str | None, tries: int) -> RowModel:
    """The row of a region that is delivered."""
    timing = report.timing
    return RowModel(
        region=region,
        state=state,
        panels=len(report.panels),
        met=said is None,
        seconds=timing.read + timing.fit + timing.build + timing.write + timing.verify,
        tries=tries,
        said=said,
        **{name: getattr(report.summary, name) for name in _MEASURED},
    )


def read_summary(path: Path) -> SummaryModel:
    """The summary in a file.

    Raises:
        DeliveryError: it cannot be read or is no summary; one sentence says where.
    """
    return read_json(path, SummaryModel, schema=SCHEMA, what="a summary of a cadpanel job")


def write_summary(summary: SummaryModel, folder: Path) -> None:
    """Write both files, each whole or not at all; `details` stand in summary.json alone.

    Raises:
        DeliveryError: one of them cannot be written; an earlier one is as it was then.
    """
    heads = [name for name in RowModel.model_fields if name != "details"]
    rows: list[list[Cell]] = [[_cell(getattr(row, name)) for name in heads] for row in summary.rows]
    files = {SUMMARY: json_bytes(summary, folder / SUMMARY), SUMMARY_TABLE: csv_bytes([heads, *rows])}
    for name, data in files.items():
        try:
            write_whole(folder / name, data)
        except OSError as error:
            raise DeliveryError(f"'{folder / name}' cannot be written: {error.strerror or error}.") from error


def _cell(value: str | float | int | bool | None) -> Cell:
    return ("yes" if value else "no") if isinstance(value, bool) else value
