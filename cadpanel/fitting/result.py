"""The result of a fit, and the one call that makes it."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cadpanel.fitting.measures import Measures, measure
from cadpanel.fitting.methods import Fitted, fit_concurrent, fit_local, fit_two_stage
from cadpanel.fitting.problem import Problem, problem
from cadpanel.fitting.settings import FitSettings
from cadpanel.fitting.shapes import panel_shapes
from cadpanel.fitting.start import SampleArrays, start
from cadpanel.geometry.shape import PanelShape
from cadpanel.reference.model import Reference

Array = NDArray[np.float64]

# What the method, the round and the largest excess over a tolerance are told to while a fit runs.
Progress = Callable[[str, int, float], None]


@dataclass(frozen=True, slots=True)
class FitResult:
    """Fitted panels and what they are worth.

    Attributes:
        reference: what was approximated.
        settings: how.
        shapes: the panels, in the order of the reference.
        measures: gaps, deviation and drift of this result.
        local, two_stage: the same measures for the methods that it is held against.
        tolerance_met: whether every gap is within the tolerance and every drift within its limit; with weights there
            is no tolerance to miss, and this is True.
        starts, agreed: how many starts were made, and how many ended within 1 % of the best.
        iterations: linear systems solved for this result.
        seconds: time of the fit, the baselines included.
    """

    reference: Reference
    settings: FitSettings
    shapes: tuple[PanelShape, ...]
    measures: Measures
    local: Measures
    two_stage: Measures
    tolerance_met: bool
    starts: int
    agreed: int
    iterations: int
    seconds: float

    def shape(self, name: str) -> PanelShape:
        """The panel of that name.

        Raises:
            KeyError: there is none.
        """
        for shape in self.shapes:
            if shape.name == name:
                return shape
        raise KeyError(name)

    def shortfall(self) -> str | None:
        """One sentence on the worst seam or panel if the tolerance or a limit does not hold, else None."""
        if self.tolerance_met:
            return None
        m, tolerance = self.measures, self.settings.gap_tolerance
        gaps = np.maximum(m.corner_gaps.max(axis=1, initial=0.0), m.seam_gap)
        if len(gaps) and gaps.max() > tolerance:
            worst = int(gaps.argmax())
            a, b = (self.reference.panels[i].name for i in self.reference.seams[worst].panels)
            return (
                f"the gap tolerance of {tolerance:g} mm is not met: the seam between '{a}' and '{b}' stays open by "
                f"{gaps[worst]:.2f} mm; allow a larger gap or more drift"
            )
        limits = (
            ("along", m.drift_along, self.settings.drift_along),
            ("across", m.drift_across, self.settings.drift_across),
        )
        way, drift, limit = max(limits, key=lambda kind: float((kind[1].max(axis=(1, 2)) / m.lengths).max()) / kind[2])
        panel = int(np.argmax(drift.max(axis=(1, 2)) / m.lengths))
        return (
            f"the drift limits are not met: panel '{self.reference.panels[panel].name}' leaves its outline by "
            f"{drift[panel].max():.1f} mm {way} its free edges, where {limit * m.lengths[panel]:.1f} mm are allowed; "
            "allow more drift or a larger gap"
        )


def fit(reference: Reference, settings: FitSettings | None = None, progress: Progress | None = None) -> FitResult:
    """Fit all panels of a reference.

    Args:
        reference: what is to be approximated.
        settings: how; by default concurrent plane-cone-plane with gaps of at most 1 mm.
        progress: told of every round of the concurrent fit.

    Raises:
        PanelError: a panel's faces are nothing that the feature could approximate.
        SettingsError: no starting values are known for the feature.
    """
    began = time.perf_counter()
    how = settings or FitSettings()
    posed, begin = pose(reference, how)
    local = fit_local(posed, reference, begin)

    def tell(round_: int, excess: float) -> None:
        if progress is not None:
            progress("concurrent", round_, excess)

    staged = fit_two_stage(posed, local.unknowns, how)
    chosen: Fitted = {
        "local": lambda: local,
        "two_stage": lambda: staged,
        "concurrent": lambda: fit_concurrent(posed, local.unknowns, how, tell),
    }[how.method]()
    measures = measure(posed, reference, chosen.unknowns)
    return FitResult(
        reference=reference,
        settings=how,
        shapes=panel_shapes(posed, reference, chosen.unknowns),
        measures=measures,
        local=measure(posed, reference, local.unknowns),
        two_stage=measure(posed, reference, staged.unknowns),
        tolerance_met=keeps_limits(measures, how),
        starts=chosen.starts,
        agreed=chosen.agreed,
        iterations=chosen.iterations,
        seconds=time.perf_counter() - began,
    )


def pose(reference: Reference, settings: FitSettings) -> tuple[Problem, Array]:
    """The problem of a reference, and the first unknowns (panels, free)."""
    feature = settings.shape_feature
    samples = SampleArrays.of(reference)
    begin = start(reference, feature, samples)
    return problem(reference, feature, samples, begin), begin.values[:, feature.free]


def keeps_limits(measures: Measures, settings: FitSettings) -> bool:
    """Whether every gap and every drift is within its limit; with weights there is none to miss."""
    if settings.weights is not None:
        return True
    lengths = measures.lengths[:, None, None]
    return bool(
        measures.max_corner_gap <= settings.gap_tolerance
        and measures.max_seam_gap <= settings.gap_tolerance
        and np.all(measures.drift_along <= settings.drift_along * lengths)
        and np.all(measures.drift_across <= settings.drift_across * lengths)
    )
