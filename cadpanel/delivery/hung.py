"""How a delivery hangs in the assembly of a whole building: all that is needed of its report for that."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from cadpanel.delivery.records.report import ReportModel


@dataclass(frozen=True, slots=True)
class Hung:
    """How a delivery hangs in an assembly.

    Attributes:
        schema: of its STEP file.
        placed: (3,) where its coordinates begin in the model, mm.
    """

    schema: Literal["AP242", "AP214"]
    placed: tuple[float, float, float]


def hung_by(report: ReportModel) -> Hung:
    """What a report says of it: a file in local coordinates is put where these lie in the model."""
    placed = (0.0, 0.0, 0.0) if report.origin.kept else report.origin.offset
    return Hung(report.settings.step_schema, placed)
