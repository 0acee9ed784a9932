"""Features chosen panel by panel: fits of all panels together, and another feature for those that need one.

Closing the seams costs deviation: panels that break a limit over it get a feature that follows better, and those that
cannot be built any more another one. Whether features will do is seen in trials, in which nothing gives way, all from
the local fits: from where neighbours of other features were held together there is often no way. Only the last
candidate is fitted in full, where its trial did not hold.
"""

from __future__ import annotations

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.fitting.attempt import Attempts
from cadpanel.fitting.feature_choice import Choice, can_be_built
from cadpanel.fitting.measures.verdict import limits_of
from cadpanel.fitting.methods.catalogue import LOCAL, method_for
from cadpanel.fitting.problem import Problem
from cadpanel.fitting.result import FitResult
from cadpanel.solver.stop import Stop

# How often panels may be given a closer feature because closing the seams took them too far.
_PROMOTIONS = 5
# How often they may be given another one because nothing could be built of them.
_REPLACEMENTS = 8


def fit_automatically(attempts: Attempts) -> FitResult:
    """Fit panels with the cheapest features that do.

    Raises:
        PanelError: no feature comes near a panel.
    """
    choice = Choice(attempts.reference, attempts.settings)
    if method_for(attempts.settings) == LOCAL:
        return _buildable_alone(attempts, choice)
    last, stands = _trials(attempts, choice)
    if last.stopped is Stop.OPEN_BETWEEN:
        last = attempts.try_together(*_posed(attempts, choice), closing=True)
    if last.stopped in (Stop.HELD, Stop.TOLD) and attempts.settings.restarts == 0 and not len(_lost(last)):
        return last
    for _ in range(_REPLACEMENTS + 1):
        last = attempts.fit_together(*_posed(attempts, choice))
        lost = _lost(last)
        if not len(lost) or not choice.forbid(lost):
            break
    if stands is not None and (last.stopped not in (Stop.HELD, Stop.TOLD) or len(_lost(last))):
        return stands
    return last


def _trials(attempts: Attempts, choice: Choice) -> tuple[FitResult, FitResult | None]:
    """Trials until one meets everything, or no panel that breaks a limit has another feature left.

    Returns:
        The last one, with which `choice` ends; and the last that holds everything but that panels may deviate too far.
    """
    promotions = replacements = 0
    stands: FitResult | None = None
    while True:
        last = attempts.try_together(*_posed(attempts, choice))
        lost = _lost(last)
        held = last.stopped in (Stop.HELD, Stop.OPEN_BETWEEN)
        if last.stopped is Stop.HELD and not len(lost):
            stands = last
        if attempts.over or (last.tolerance_met and not len(lost)):
            return last, stands
        if held and len(lost):
            replacements += 1
            changed = replacements <= _REPLACEMENTS and choice.forbid(lost)
        else:
            promotions += 1
            changed = promotions <= _PROMOTIONS and choice.promote(np.union1d(lost, offenders(last)))
        if not changed:
            return last, stands


def _posed(attempts: Attempts, choice: Choice) -> tuple[Problem, Array]:
    """The panels with the features chosen, and their local fits (panels, size)."""
    problem, _ = attempts.posed(choice.features())
    return problem, choice.alone(problem.layout)


def _buildable_alone(attempts: Attempts, choice: Choice) -> FitResult:
    """Every panel alone, with another feature where nothing can be built of it."""
    result = attempts.fit(choice.features())
    for _ in range(_REPLACEMENTS):
        lost = _lost(result)
        if not len(lost) or not choice.forbid(lost):
            break
        result = attempts.fit(choice.features())
    return result


def _lost(result: FitResult) -> IntArray:
    """Indices of the panels of which nothing can be built."""
    return np.array([i for i, shape in enumerate(result.shapes) if not can_be_built(shape)], dtype=np.intp)


def offenders(result: FitResult) -> IntArray:
    """Indices of the panels that break a limit, or meet another one in a seam that stays open."""
    m, how = result.measures, result.settings
    beyond = np.zeros(len(m.lengths), dtype=bool)
    if how.max_deviation is not None:
        beyond |= m.max_deviation > how.max_deviation
    for limit, allowed in limits_of(how):
        beyond |= ~limit.kept(m, allowed)
    if result.stopped is Stop.OPEN_BETWEEN and beyond.any():
        return np.flatnonzero(beyond)  # their seams were held, and not tightened, as these panels deviate too far
    gaps = m.gaps
    for what, most in how.gaps.items():
        beyond[m.seam_panels[gaps[what] > most]] = True
    return np.flatnonzero(beyond)
