"""From the fits of a study to study.json."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from cadpanel.delivery.records.from_fit import reference_record
from cadpanel.delivery.records.settings import comparison_settings_record
from cadpanel.delivery.records.study import StudyModel, StudyRowModel
from cadpanel.delivery.records.summary import summary
from cadpanel.fitting.result import FitResult
from cadpanel.fitting.settings import FitSettings
from cadpanel.reference.model import Reference


class Fitted(Protocol):
    """One fit of a study, as it goes into a row; `studies.held_points.Point` is one."""

    @property
    def reference(self) -> Reference:
        """What was approximated."""
        ...

    @property
    def settings(self) -> FitSettings:
        """How."""
        ...

    @property
    def result(self) -> FitResult | None:
        """What came of it; None where it was refused."""
        ...

    @property
    def begun(self) -> str:
        """From where: "alone", "tighter" or "wider"."""
        ...

    @property
    def refused(self) -> str:
        """Why it was refused, in one sentence."""
        ...

    @property
    def knee(self) -> bool:
        """Whether it is the knee of its curve."""
        ...


def study_record(fitted: Sequence[Fitted]) -> StudyModel:
    """What study.json holds, of the fits in the order of its rows."""
    first = fitted[0]
    shared = comparison_settings_record(first.reference, first.settings)
    return StudyModel(
        reference=reference_record(first.reference),
        settings=shared.model_copy(update={"gap_tolerance": None}),
        max_deviation=first.settings.max_deviation,
        rows=tuple(map(_row, fitted)),
    )


def _row(one: Fitted) -> StudyRowModel:
    divide = one.reference.settings.divide
    result = one.result
    return StudyRowModel.model_validate(
        {
            "divide": divide if isinstance(divide, int) else None,
            "panels": len(one.reference.panels),
            "feature": one.settings.feature_name,
            "gap_tolerance": one.settings.widest_gap,
            "knee": one.knee,
            "begun": one.begun,
            "refused": one.refused or None,
            "summary": None if result is None else summary(result.measures, result.local, one.settings),
            "gap_price": None if result is None else result.gap_price,
        }
    )
