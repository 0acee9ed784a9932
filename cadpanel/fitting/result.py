"""The result of a fit, and the one call that makes it."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cadpanel.features.catalogue import PanelFeature
from cadpanel.fitting.feature_choice import Choice, can_be_built
from cadpanel.fitting.measures.fit import Measures, measure
from cadpanel.fitting.methods.concurrent import Fitted, fit_concurrent, fit_local, fit_two_stage
from cadpanel.fitting.problem import pose
from cadpanel.fitting.settings import FitSettings
from cadpanel.fitting.shapes import panel_shapes
from cadpanel.geometry.shape import AnyShape
from cadpanel.reference.model import Reference

Array = NDArray[np.float64]

# How often panels may be given a closer feature because closing the seams took them too far.
_PROMOTIONS = 3
# How often they may be given another one because nothing could be built of them.
_REPLACEMENTS = 8
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
        tolerance_met: whether every gap is within the tolerance, every drift within its limit and, where features are
            chosen automatically, every deviation within the largest; with weights gaps and drifts have none to miss.
        starts, agreed: how many starts were made, and how many ended within 1 % of the best.
        iterations: linear systems solved for this result.
        seconds: time of the fit, the baselines included.
    """

    reference: Reference
    settings: FitSettings
    shapes: tuple[AnyShape, ...]
    measures: Measures
    local: Measures
    two_stage: Measures
    tolerance_met: bool
    starts: int
    agreed: int
    iterations: int
    seconds: float

    def shape(self, name: str) -> AnyShape:
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
        allowed = self.settings.max_deviation
        if allowed is not None and m.max_deviation.max() > allowed:
            far = int(m.max_deviation.argmax())
            return (
                f"the largest deviation of {allowed:g} mm is not met: panel '{self.reference.panels[far].name}' is "
                f"{m.max_deviation[far]:.2f} mm away as a {self.shapes[far].feature}, the best that was found; allow "
                "more, allow wider gaps, or divide it further"
            )
        missed = []
        gaps = np.maximum(m.widest_corners, m.seam_gap)
        if len(gaps) and gaps.max() > tolerance:
            worst = int(gaps.argmax())
            a, b = (self.reference.panels[i].name for i in self.reference.seams[worst].panels)
            missed.append(
                f"the gap tolerance of {tolerance:g} mm is not met: the seam between '{a}' and '{b}' stays open by "
                f"{gaps[worst]:.2f} mm"
            )
        limits = (
            ("along", m.drift_along, self.settings.drift_along),
            ("across", m.drift_across, self.settings.drift_across),
        )
        way, drift, limit = max(limits, key=lambda kind: float((kind[1] / m.lengths).max()) / kind[2])
        panel = int(np.argmax(drift / m.lengths))
        if drift[panel] > limit * m.lengths[panel]:
            missed.append(
                f"the drift limits are not met: panel '{self.reference.panels[panel].name}' leaves its outline by "
                f"{drift[panel]:.1f} mm {way} its free edges, where {limit * m.lengths[panel]:.1f} mm are allowed"
            )
        # Where both are missed by far, no wider limit helps: the feature cannot follow.
        advice = ("choose another feature, " if len(missed) > 1 else "") + "allow a larger gap or more drift"
        return f"{', and '.join(missed)}; {advice}"


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
    if not how.automatic:
        features = [how.feature_for(len(panel.edges)) for panel in reference.panels]
        return _fit(reference, how, features, began, progress)
    choice = Choice(reference, how)
    result = _fit(reference, how, choice.features(), began, progress)
    # Closing the seams costs deviation: panels that break a limit over it get a feature that follows better, and those
    # that cannot be built any more another one.
    # The last result that can be built stands.
    buildable: FitResult | None = None
    promotions = replacements = 0
    while True:
        lost = np.array([i for i, shape in enumerate(result.shapes) if not can_be_built(shape)], dtype=np.intp)
        if not len(lost):
            buildable = result
            if result.tolerance_met or promotions == _PROMOTIONS:
                break
            promotions += 1
            changed = choice.promote(_offenders(result))
        else:
            if replacements == _REPLACEMENTS:
                break
            replacements += 1
            changed = choice.forbid(lost)
        if not changed:
            break
        result = _fit(reference, how, choice.features(), began, progress)
    return buildable or result


def _fit(
    reference: Reference,
    how: FitSettings,
    features: Sequence[PanelFeature],
    began: float,
    progress: Progress | None,
) -> FitResult:
    """Fit panels that have these features."""
    posed, starts = pose(reference, features, how.blend)
    local = fit_local(posed, reference, starts, how)

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


def _offenders(result: FitResult) -> NDArray[np.intp]:
    """Indices of the panels that break a limit, or meet another one in a seam that stays open."""
    m, how = result.measures, result.settings
    beyond = np.zeros(len(m.lengths), dtype=bool)
    if how.max_deviation is not None:
        beyond |= m.max_deviation > how.max_deviation
    beyond |= (m.drift_along > how.drift_along * m.lengths) | (m.drift_across > how.drift_across * m.lengths)
    for seam, gap in zip(result.reference.seams, np.maximum(m.widest_corners, m.seam_gap), strict=True):
        beyond[list(seam.panels)] |= gap > how.gap_tolerance
    return np.flatnonzero(beyond)


def keeps_limits(measures: Measures, settings: FitSettings) -> bool:
    """Whether every gap, drift and deviation is within its limit; with weights only a deviation has one to miss."""
    if settings.max_deviation is not None and measures.max_deviation.max() > settings.max_deviation:
        return False
    if settings.weights is not None:
        return True
    return bool(
        measures.max_corner_gap <= settings.gap_tolerance
        and measures.max_seam_gap <= settings.gap_tolerance
        and np.all(measures.drift_along <= settings.drift_along * measures.lengths)
        and np.all(measures.drift_across <= settings.drift_across * measures.lengths)
    )
