"""compare.json: the paper's Table 1 for one reference, (two-stage, concurrent) x (cylinder, cone)."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

from pydantic import Field, model_validator

from cadpanel.delivery.records.jsonfile import NonNegative, Record, read_json, write_json
from cadpanel.delivery.records.report import ReferenceModel, SummaryModel, UnitsModel
from cadpanel.delivery.records.settings import ComparisonSettingsModel


class ColumnModel(Record):
    """One feature fitted by one method.

    Attributes:
        feature: name of the shape feature.
        method: name of the method.
        max_corner_gap: largest corner gap of each seam, in the order of the file's seams, mm.
        summary: the measures of the whole fit.
        local_rms_deviation: RMS deviation of the same feature where each panel is fitted alone, mm.
        seconds: wall-clock time of the fit, the methods that it starts from and is held against included.
    """

    feature: str
    method: str
    max_corner_gap: tuple[NonNegative, ...]
    summary: SummaryModel
    local_rms_deviation: NonNegative
    seconds: NonNegative


class ComparisonModel(Record):
    """compare.json as a whole: one row a seam, one column for each feature and method."""

    schema_name: Literal["cadpanel.compare/1"] = Field(default="cadpanel.compare/1", alias="schema")
    units: UnitsModel = UnitsModel()
    reference: ReferenceModel
    settings: ComparisonSettingsModel
    seams: tuple[tuple[str, str], ...]
    columns: tuple[ColumnModel, ...]

    @model_validator(mode="after")
    def _check_that_parts_agree(self) -> ComparisonModel:
        if len(self.seams) != self.reference.seams:
            raise ValueError(f"the reference counts {self.reference.seams} seams, the list {len(self.seams)}")
        for column in self.columns:
            if len(column.max_corner_gap) != len(self.seams):
                raise ValueError(
                    f"the column {column.method}, {column.feature} has {len(column.max_corner_gap)} gaps "
                    f"for {len(self.seams)} seams"
                )
        return self


def read_comparison(path: Path) -> ComparisonModel:
    """The comparison in a file.

    Raises:
        DeliveryError: it cannot be read or is not a comparison; one sentence says where.
    """
    return read_json(path, ComparisonModel, schema="cadpanel.compare/1", what="a cadpanel comparison")


def write_comparison(comparison: ComparisonModel, path: Path) -> None:
    """Write the comparison; the same comparison gives the same bytes.

    Raises:
        DeliveryError: it cannot be written.
    """
    write_json(comparison, path)
