"""From a reference to a result: the method, and another feature for panels that need one."""

from __future__ import annotations

import time
from collections.abc import Sequence

import numpy as np

from cadpanel.arrays import IntArray
from cadpanel.errors import SettingsError
from cadpanel.features.rulings import PanelFeature
from cadpanel.fitting.baselines import Baselines
from cadpanel.fitting.feature_choice import Choice, can_be_built
from cadpanel.fitting.measures.fit import measure
from cadpanel.fitting.measures.verdict import keeps_limits, limits_of
from cadpanel.fitting.methods.catalogue import LOCAL, method_for
from cadpanel.fitting.methods.local import fit_local
from cadpanel.fitting.problem import pose
from cadpanel.fitting.result import FitResult, Progress
from cadpanel.fitting.settings import FitSettings
from cadpanel.fitting.shapes import panel_shapes
from cadpanel.reference.model import Reference

# How often panels may be given a closer feature because closing the seams took them too far.
_PROMOTIONS = 3


# How often they may be given another one because nothing could be built of them.
_REPLACEMENTS = 8


def fit(
    reference: Reference,
    settings: FitSettings | None = None,
    progress: Progress | None = None,
    *,
    time_limit: float | None = None,
) -> FitResult:
    """Fit all panels of a reference.

    Args:
        reference: what is to be approximated.
        settings: how; by default concurrent plane-cone-plane with gaps of at most 1 mm.
        progress: told of every step of the concurrent fit; False ends it.
        time_limit: seconds after which the concurrent fit ends with the best so far. What comes before it, the fits of
            every panel alone, is always finished.

    Raises:
        PanelError: a panel's faces are nothing that the feature could approximate.
        SettingsError: no starting values are known for the feature, or a time limit is given beside weights.
    """
    began = time.perf_counter()
    watch = _Watch(progress, None if time_limit is None else began + time_limit)
    how = settings or FitSettings()
    if time_limit is not None and how.weights is not None:
        raise SettingsError("a time limit ends the search for what holds tolerances; with weights there is none to end")
    if not how.automatic:
        features = [how.feature_for(len(panel.edges)) for panel in reference.panels]
        return _fit(reference, how, features, began, watch)
    choice = Choice(reference, how)
    result = _fit(reference, how, choice.features(), began, watch)
    # Closing the seams costs deviation: panels that break a limit over it get a feature that follows better, and those
    # that cannot be built any more another one.
    # The last result that can be built stands.
    buildable: FitResult | None = None
    promotions = replacements = 0
    while True:
        lost = np.array([i for i, shape in enumerate(result.shapes) if not can_be_built(shape)], dtype=np.intp)
        if not len(lost):
            buildable = result
            if result.tolerance_met or promotions == _PROMOTIONS or watch.over:
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
        result = _fit(reference, how, choice.features(), began, watch)
    return buildable or result


class _Watch:
    """Tells of every step, and knows whether to go on.

    Attributes:
        over: whether the time is over, or somebody said so.
    """

    def __init__(self, progress: Progress | None, deadline: float | None) -> None:
        self._progress, self._deadline = progress, deadline
        self.over = False

    def tell(self, method: str, step: int, excess: float, rms: float) -> bool:
        """Whether to go on."""
        if self._progress is not None:
            answer = self._progress(method, step, excess, rms)
            self.over |= answer is not None and not answer
        self.over |= self._deadline is not None and time.perf_counter() > self._deadline
        return not self.over


def _fit(
    reference: Reference,
    how: FitSettings,
    features: Sequence[PanelFeature],
    began: float,
    watch: _Watch,
) -> FitResult:
    """Fit panels that have these features."""
    posed, starts = pose(reference, features, how.blend)
    local = fit_local(posed, reference, starts, how)

    def tell(step: int, excess: float, rms: float) -> bool:
        return watch.tell(how.method, step, excess, rms)

    method = method_for(how)
    chosen = local if method == LOCAL else method.fit(posed, [local.unknowns, *starts], how, tell)
    measures = measure(panel_shapes(posed, chosen.unknowns), reference)
    return FitResult(
        reference=reference,
        settings=how,
        shapes=measures.shapes,
        measures=measures,
        baselines=Baselines(
            reference=reference, settings=how, problem=posed, alone=local.unknowns, measured={how.method: measures}
        ),
        tolerance_met=keeps_limits(measures, how),
        starts=chosen.starts,
        agreed=chosen.agreed,
        iterations=chosen.iterations,
        stopped=chosen.stopped,
        gap_price=chosen.gap_price,
        seconds=time.perf_counter() - began,
    )


def _offenders(result: FitResult) -> IntArray:
    """Indices of the panels that break a limit, or meet another one in a seam that stays open."""
    m, how = result.measures, result.settings
    beyond = np.zeros(len(m.lengths), dtype=bool)
    if how.max_deviation is not None:
        beyond |= m.max_deviation > how.max_deviation
    for limit, allowed in limits_of(how):
        beyond |= ~limit.kept(m, allowed)
    for seam, gap in zip(result.reference.seams, np.maximum(m.widest_corners, m.seam_gap), strict=True):
        beyond[list(seam.panels)] |= gap > how.gap_tolerance
    return np.flatnonzero(beyond)
