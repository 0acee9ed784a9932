"""Whether features will do: all panels together, without the search for what has to give way where they will not."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array
from cadpanel.fitting.measures.seams import along_seams
from cadpanel.fitting.methods.concurrent import ARC_SHARE, gather
from cadpanel.fitting.methods.holding import MARGIN, seam_terms
from cadpanel.fitting.methods.method import Fitted, Method, Progress
from cadpanel.fitting.objective import HeldObjective
from cadpanel.fitting.problem import Problem
from cadpanel.fitting.settings import FitSettings
from cadpanel.fitting.shapes import panel_shapes
from cadpanel.geometry.panel import Panel
from cadpanel.solver.interior_point import Ended, Limits, interior_point
from cadpanel.solver.stop import Stop
from cadpanel.terms.arc_gap import ArcGap

# Steps at most, until gaps are first held and after each tightening.
_STEPS = 60
# Steps for which gaps wait for limits: neighbours of different features are driven into a corner otherwise.
_PATIENCE = 20
# How often seams are tightened that part further between the points at which they are held, and how far.
_TIGHTENINGS, _AIM = 5, 0.99
# A result that exceeds its distances by less holds them.
_HOLDS = 1.0 + 1e-6


@dataclass(frozen=True, slots=True)
class Trial(Method):
    """The concurrent fit, given up where everything cannot be held within a few steps.

    Where seams have to be tightened it begins anew from where it stands, unless panels deviate too far already: then it
    stopped as seams are open between the points at which they are held.

    Attributes:
        too_far: whether panels deviate by more than they may.
    """

    too_far: Callable[[Sequence[Panel]], bool]

    def fit(
        self, problem: Problem, starts: Sequence[Array], settings: FitSettings, progress: Progress | None = None
    ) -> Fitted:
        """Fit all panels from where they are known to be; restarts are of no use here."""
        gaps = seam_terms(problem, settings.gap_tolerance * (1.0 - MARGIN))
        limits = problem.limits(settings, MARGIN)
        gathered, iterations = gather(problem, gaps, limits, starts[-1])
        state = problem.state(gathered)
        for gap in gaps:
            gap.hold.weight[:] = 0.0
            if isinstance(gap, ArcGap):
                gap.straighten(state)
                gap.hold.radius = ARC_SHARE * gap.hold.radius
        model = HeldObjective(problem, [problem.deviation], [*gaps, *limits])

        def told(step: int, excess: float, cost: float) -> bool:
            return progress is None or progress(step, excess, problem.rms(cost) * problem.place.length)

        unknowns, stopped = model.starting_from(gathered), Stop.STALLED
        for _ in range(_TIGHTENINGS):
            end = interior_point(model, unknowns, Limits(steps=_STEPS, patience=_PATIENCE), tell=told)
            unknowns, iterations = end.best.unknowns, iterations + end.steps
            if end.told_to_stop or not _holds(end):
                stopped = Stop.TOLD if end.told_to_stop else Stop.STALLED
                break
            shapes = panel_shapes(problem, unknowns)
            seam_gap, _ = along_seams(shapes, problem.met)
            excess = seam_gap / settings.gap_tolerance
            if excess.max(initial=0.0) <= 1.0:
                stopped = Stop.HELD
                break
            if self.too_far(shapes):
                stopped = Stop.OPEN_BETWEEN
                break
            share = np.where(excess > 1.0, _AIM / excess, 1.0)
            for gap in gaps:
                if isinstance(gap, ArcGap):
                    gap.straighten(problem.state(unknowns))
                gap.hold.tighten(share[gap.seams.index])
        return Fitted(unknowns, iterations, stopped)


def _holds(end: Ended) -> bool:
    return max(end.best.firm, end.best.excess) <= _HOLDS
