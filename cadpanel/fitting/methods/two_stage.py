"""The industry's two stages: panels fitted alone are moved about, their shapes frozen."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from cadpanel.arrays import Array
from cadpanel.fitting.methods.holding import MARGIN, held_within, stopped_as
from cadpanel.fitting.methods.method import Fitted, Method, Progress
from cadpanel.fitting.objective import HeldObjective
from cadpanel.fitting.problem import Problem
from cadpanel.fitting.settings import FitSettings, Weights
from cadpanel.solver.stop import Stop


@dataclass(frozen=True, slots=True)
class TwoStage(Method):
    """Local fits moved about, and their corners placed anew, to close the gaps while their shapes are frozen.

    The industry's way, given its best chance: all panels move at once, cuts may tilt as the feature allows, and a
    corner gap of 1 mm counts as much as 1 mm of deviation all over a panel, or what the user's weights say. All
    limits are kept.
    """

    def fit(
        self, problem: Problem, starts: Sequence[Array], settings: FitSettings, progress: Progress | None = None
    ) -> Fitted:
        """Fit the panels' places, from local fits."""
        local = starts[0]
        weights = settings.weights or Weights()
        gaps = problem.corner_gaps(settings.widest_gap)
        for gap in gaps:
            gap.hold.weight[:] = weights.gap / weights.deviation
        moving = problem.placement_unknowns()
        model = HeldObjective(problem, [problem.deviation, *gaps], problem.limits(settings, MARGIN), moving=moving)
        found = held_within(problem, model, local, local=local, costly=False, tell=progress)
        # Gaps are weighed, not held: that the limits hold says nothing of them.
        stopped = Stop.AT_REST if found.held else stopped_as(found)
        return Fitted(found.unknowns, found.iterations, stopped)
