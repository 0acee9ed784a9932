"""Whether features will do: all panels together, without the search for what has to give way where they will not."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array
from cadpanel.fitting.methods.concurrent import gather, seams_held
from cadpanel.fitting.methods.holding import MARGIN, seam_excess, tighten
from cadpanel.fitting.methods.method import Fitted, Method, Progress
from cadpanel.fitting.objective import HeldObjective
from cadpanel.fitting.problem import Problem
from cadpanel.fitting.settings import FitSettings
from cadpanel.fitting.shapes import panel_shapes
from cadpanel.geometry.panel import Panel
from cadpanel.solver.ended import Ended, Limits
from cadpanel.solver.interior_point import interior_point
from cadpanel.solver.levenberg_marquardt import Stopping
from cadpanel.solver.stop import Stop
from cadpanel.terms.term import HeldTerm

# Corners are gathered closely: what is held from there within a few steps is not seen to later.
_FIRST = Stopping(cost=1e-3, iterations=40)
# Steps at most, until gaps are first held and after each tightening.
_STEPS = 60
# Steps for which gaps wait for limits: neighbours of different features are driven into a corner otherwise.
_PATIENCE = 20
# How often seams are tightened that part further between the points at which they are held.
_TIGHTENINGS = 5
# A result that exceeds its distances by less holds them.
_HOLDS = 1.0 + 1e-6


@dataclass(frozen=True, slots=True)
class Trial(Method):
    """The concurrent fit, given up where everything cannot be held within a few steps.

    Where seams have to be tightened it begins anew from where it stands, unless panels deviate too far already: then it
    stopped as seams are open between the points at which they are held.

    Attributes:
        too_far: whether panels deviate by more than they may.
        steps: so many at most, after those that gather corners; as many as it takes if not given.
        goes_on: whether it begins where another trial of the same panels ended, not from local fits.
    """

    too_far: Callable[[Sequence[Panel]], bool]
    steps: int | None = None
    goes_on: bool = False

    def fit(
        self, problem: Problem, starts: Sequence[Array], settings: FitSettings, progress: Progress | None = None
    ) -> Fitted:
        """Fit all panels from their local fits; restarts are of no use here."""
        limits = problem.limits(settings, MARGIN)
        gathered, iterations = (starts[0], 0) if self.goes_on else gather(problem, settings, limits, starts[0], _FIRST)
        left = _STEPS * _TIGHTENINGS if self.steps is None else self.steps
        held: list[HeldTerm] = [*seams_held(problem, settings, gathered), *limits]
        model = HeldObjective(problem, [problem.deviation], held)

        def told(step: int, excess: float, cost: Array) -> bool:
            return progress is None or progress(step, excess, problem.rms(cost) * problem.place.length)

        unknowns, stopped = model.starting_from(gathered), Stop.STALLED
        for _ in range(_TIGHTENINGS):
            end = interior_point(model, unknowns, Limits(steps=min(_STEPS, left), patience=_PATIENCE), tell=told)
            unknowns, iterations, left = end.best.unknowns, iterations + end.steps, left - end.steps
            if end.told_to_stop or not _holds(end):
                stopped = Stop.TOLD if end.told_to_stop else Stop.STALLED
                break
            shapes = panel_shapes(problem, unknowns)
            excess = seam_excess(problem, unknowns, settings)
            if max(float(over.max(initial=0.0)) for over in excess.values()) <= 1.0:
                stopped = Stop.HELD
                break
            if self.too_far(shapes):
                stopped = Stop.OPEN_BETWEEN
                break
            tighten(held, problem.state(unknowns), excess)
        return Fitted(unknowns, iterations, stopped)


def _holds(end: Ended) -> bool:
    return bool((np.maximum(end.best.firm, end.best.excess) <= _HOLDS).all())
