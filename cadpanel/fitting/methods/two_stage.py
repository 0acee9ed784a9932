"""The industry's two stages: panels fitted alone are moved about, their shapes frozen."""

from __future__ import annotations

from cadpanel.arrays import Array
from cadpanel.fitting.methods.balance import MARGIN, balanced
from cadpanel.fitting.methods.method import Fitted
from cadpanel.fitting.objective import Frozen, Objective
from cadpanel.fitting.problem import Problem
from cadpanel.fitting.settings import FitSettings, Weights


def fit_two_stage(problem: Problem, local: Array, settings: FitSettings) -> Fitted:
    """Move the locally fitted panels about and place their corners anew, their shapes frozen, to close the gaps.

    The industry's way, given its best chance: all panels move at once, cuts may tilt as the feature allows, and a
    corner gap of 1 mm counts as much as 1 mm of deviation all over a panel. Corners keep within the drift limits.
    """
    weights = settings.weights or Weights()
    gaps = problem.corner_gaps(settings.gap_tolerance)
    for gap in gaps:
        gap.hold.weight[:] = weights.gap / weights.deviation
    limits = problem.limits(settings, MARGIN)
    everything = Objective(problem, [problem.deviation, *gaps, *limits], coupled=True)
    return balanced(problem, Frozen(everything, problem.placement_unknowns()), limits, local, local=local)
