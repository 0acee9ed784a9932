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
    after: FitResult | None = None,
) -> FitResult:
    """Fit all panels of a reference.

    Args:
        reference: what is to be approximated.
        settings: how; by default concurrent plane-cone-plane, steps of at most 3 mm, seams within 3 degrees of the
            drawn ones.
        progress: told of every step of the concurrent fit; False ends it.
        time_limit: seconds after which the concurrent fit ends with the best so far. What comes before it, the fits of
            every panel alone, is always finished.
        after: a concurrent fit of the same reference with the same features under other tolerances, to go on from.

    Raises:
        PanelError: a panel's faces are nothing that the feature could approximate.
        SettingsError: no starting values are known for the feature, a time limit is given beside weights, or there is
            no going on from the fit that is given.
    """
    began = time.perf_counter()
    watch = _Watch(progress, None if time_limit is None else began + time_limit)
    how = settings or FitSettings()
    if time_limit is not None and how.weights is not None:
        raise SettingsError("a time limit ends the search for what holds tolerances; with weights there is none to end")
    if after is not None:
        _require_alike(reference, how, after)
    if not how.automatic:
        features = [how.feature_for(len(panel.edges)) for panel in reference.panels]
        return _fit(reference, how, features, began, watch, after)
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
    after: FitResult | None = None,
) -> FitResult:
    """Fit panels that have these features."""
    posed, starts = pose(reference, features, how.blend)
    local = fit_local(posed, reference, starts, how)

    def tell(step: int, excess: float, rms: float) -> bool:
        return watch.tell(how.method, step, excess, rms)

    method = method_for(how)
    begin = [local.unknowns] if after is None else [local.unknowns, after.unknowns]
    chosen = local if method == LOCAL else method.fit(posed, begin, how, tell)
    measures = measure(panel_shapes(posed, chosen.unknowns), reference)
    return FitResult(
        reference=reference,
        settings=how,
        shapes=measures.shapes,
        measures=measures,
        unknowns=chosen.unknowns,
        baselines=Baselines(
            reference=reference, settings=how, problem=posed, alone=local.unknowns, measured={how.method: measures}
        ),
        tolerance_met=keeps_limits(measures, how),
        starts=chosen.starts,
        agreed=chosen.agreed,
        iterations=chosen.iterations,
        stopped=chosen.stopped,
        prices=chosen.prices,
        seconds=time.perf_counter() - began,
    )


def _require_alike(reference: Reference, how: FitSettings, after: FitResult) -> None:
    """Refuse to go on from a fit of other panels or features, or where a method does not go on."""
    if how.automatic or how.method != "concurrent" or how.weights is not None:
        raise SettingsError("only a concurrent fit of one feature that holds tolerances goes on from another one")
    if after.reference is not reference or (after.settings.feature, after.settings.tilt) != (how.feature, how.tilt):
        raise SettingsError("a fit goes on from one of the same reference with the same feature and tilt")


def _offenders(result: FitResult) -> IntArray:
    """Indices of the panels that break a limit, or meet another one in a seam that stays open."""
    m, how = result.measures, result.settings
    beyond = np.zeros(len(m.lengths), dtype=bool)
    if how.max_deviation is not None:
        beyond |= m.max_deviation > how.max_deviation
    for limit, allowed in limits_of(how):
        beyond |= ~limit.kept(m, allowed)
    for what, most in how.gaps.items():
        beyond[m.seam_panels[m.gaps[what] > most]] = True
    return np.flatnonzero(beyond)
