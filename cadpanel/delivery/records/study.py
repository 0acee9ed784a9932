"""study.json and study.csv: what gaps cost, one row for each combination that was fitted."""

from __future__ import annotations

import csv
import io
from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field

from cadpanel.delivery.records.jsonfile import NonNegative, NonNegativeCount, Positive, Record, read_json, write_json
from cadpanel.delivery.records.report import ReferenceModel, SummaryModel, UnitsModel
from cadpanel.delivery.records.settings import ComparisonSettingsModel
from cadpanel.errors import DeliveryError


class StudyRowModel(Record):
    """One combination.

    Attributes:
        divide: the number of panels along each strip that was asked for; None where the file was cut otherwise.
        panels: how many there are in all.
        feature: name of the shape feature.
        gap_tolerance: largest gap allowed, mm.
        knee: whether a wider gap than this is worth little more, for this feature and number of panels.
        begun: from where the fit that counts began: "alone" (every panel by itself), "tighter" or "wider" (the answer
            to the neighbouring gap, which is also an answer to this one where it is the tighter).
        refused: why it could not be fitted; None where it was.
        summary: its measures; None where it was refused.
        gap_price: mm of RMS deviation that one mm more of gap would save; None where it is not known.
    """

    divide: NonNegativeCount | None
    panels: NonNegativeCount
    feature: str
    gap_tolerance: Positive
    knee: bool
    begun: Literal["alone", "tighter", "wider"]
    refused: str | None
    summary: SummaryModel | None
    gap_price: NonNegative | None


class StudyModel(Record):
    """study.json as a whole; `rows` go from the tightest gap to the widest, feature by feature, number by number.

    Attributes:
        reference: the file as it was cut first.
        settings: what all rows share; their gaps and features stand in the rows.
        max_deviation: how far a panel was allowed to lie from the drawing, mm; None where that was not asked.
        rows: one a combination.
    """

    schema_name: Literal["cadpanel.study/1"] = Field(default="cadpanel.study/1", alias="schema")
    units: UnitsModel = UnitsModel()
    reference: ReferenceModel
    settings: ComparisonSettingsModel
    max_deviation: Annotated[float, Field(gt=0.0)] | None
    rows: tuple[StudyRowModel, ...]


def read_study(path: Path) -> StudyModel:
    """The study in a file.

    Raises:
        DeliveryError: it cannot be read or is no study; one sentence says where.
    """
    return read_json(path, StudyModel, schema="cadpanel.study/1", what="a cadpanel study")


def write_study(study: StudyModel, json_path: Path, csv_path: Path) -> None:
    """Write a study as JSON, and its rows as a table with a comma between the columns.

    Raises:
        DeliveryError: one of the files cannot be written.
    """
    write_json(study, json_path)
    try:
        csv_path.write_bytes(_table(study).encode())
    except OSError as error:
        raise DeliveryError(f"'{csv_path}' cannot be written: {error.strerror}.") from error


def _table(study: StudyModel) -> str:
    own = [name for name in StudyRowModel.model_fields if name != "summary"]
    measured = list(SummaryModel.model_fields)
    text = io.StringIO()
    lines = csv.writer(text, lineterminator="\n")
    lines.writerow([*own, *measured])
    for row in study.rows:
        measures = [None if row.summary is None else getattr(row.summary, name) for name in measured]
        lines.writerow([*(getattr(row, name) for name in own), *measures])
    return text.getvalue()
