"""All panels and the gaps between them in one optimization."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array
from cadpanel.fitting.measures.edges import PanelEdges
from cadpanel.fitting.measures.seams import along_seams
from cadpanel.fitting.methods.holding import MARGIN, GapTerm, gap_terms, held_within, prices, seam_terms, tighten
from cadpanel.fitting.methods.method import Fitted, Method, Progress
from cadpanel.fitting.methods.restarts import best_of_starts
from cadpanel.fitting.methods.weighted import Weighted
from cadpanel.fitting.objective import HeldObjective, Objective
from cadpanel.fitting.problem import Problem
from cadpanel.fitting.settings import FitSettings
from cadpanel.fitting.shapes import panel_shapes
from cadpanel.solver.levenberg_marquardt import Stopping, levenberg_marquardt
from cadpanel.solver.stop import Stop
from cadpanel.terms.limits.catalogue import LIMITS
from cadpanel.terms.limits.corner_drift import DriftTerm
from cadpanel.terms.limits.kink import Kink
from cadpanel.terms.term import HeldTerm

# Before tolerances count, gaps and drifts weigh this much against the mean squared deviation: local fits of panels with
# several bends scatter their corners by decimetres, and a few steps of a smooth problem gather them.
_FIRST_GAP, _FIRST_DRIFT = 0.1, 1e-2
_FIRST = Stopping(cost=1e-3, iterations=40)
# How often seams are tightened where they part still further, and up to which excess that is worth trying.
_TIGHTENINGS = 8
_NEARLY = 20.0
# What must be kept exceeds its limit beyond rounding.
_FIRM = 1.0 + 1e-5
_YIELDING = frozenset(limit.name for limit in LIMITS if limit.yields)


@dataclass(frozen=True, slots=True)
class Concurrent(Method):
    """The smallest deviation at which every gap stays within its tolerance and every limit is kept."""

    def fit(
        self, problem: Problem, starts: Sequence[Array], settings: FitSettings, progress: Progress | None = None
    ) -> Fitted:
        """Fit all panels from their local fits, and from as many restarts as are asked for.

        With a second start, the end of a fit under other tolerances, it goes on from there instead.
        """
        local = starts[0]
        if len(starts) > 1:
            return _hold_seams(problem, starts[1], local, settings, progress, gathered=True)
        return best_of_starts(
            lambda start: _hold_seams(problem, start, local, settings, progress),
            lambda unknowns: _score(problem, unknowns, settings),
            starts[-1],
            settings,
        )

    def with_weights(self) -> Method:
        """Weights rule the paper's objective."""
        return Weighted()


def _hold_seams(
    problem: Problem,
    start: Array,
    local: Array,
    settings: FitSettings,
    progress: Progress | None,
    *,
    gathered: bool = False,
) -> Fitted:
    """Hold every seam from a start, whose corners lie together already or are gathered first."""
    limits = problem.named_limits(settings, MARGIN)
    begin, iterations = (start, 0) if gathered else gather(problem, settings, [term for _, term in limits], start)
    named: list[tuple[str, HeldTerm]] = [*(("gap", term) for term in seams_held(problem, settings, begin)), *limits]
    model = HeldObjective(problem, [problem.deviation], [term for _, term in named])
    found = held_within(problem, model, begin, local=local, tell=progress)
    iterations += found.iterations
    yielding = [term for name, term in limits if name in _YIELDING]
    if found.excess > _FIRM and found.end.best.firm > _FIRM and yielding and found.stopped is not Stop.TOLD:
        # What panels must keep to cannot be kept beside these, as with rulings that are all parallel between edges that
        # are not: they give way with the gaps.
        for term in yielding:
            term.hold.gives_way = True
        model = HeldObjective(problem, [problem.deviation], [term for _, term in named])
        found = held_within(problem, model, begin, local=local, tell=progress)
        iterations += found.iterations
    stopped = found.stopped
    # Measure whole seams, tighten those that are too wide, go on.
    for tightening in range(_TIGHTENINGS + 1):
        if stopped not in (Stop.HELD, Stop.STEP_LIMIT):
            break
        excess = seam_excess(problem, found.unknowns, settings)
        largest = max((float(over.max(initial=0.0)) for over in excess.values()), default=0.0)
        if largest <= 1.0:
            break
        if tightening == _TIGHTENINGS or not largest < _NEARLY:
            stopped = Stop.OPEN_BETWEEN
            break
        tighten([term for _, term in named], problem.state(found.unknowns), excess)
        found = held_within(problem, model, found.unknowns, local=local, after=found.end, tell=progress)
        iterations += found.iterations
        stopped = found.stopped
    # Where gaps had to give way, or it was told to end, nothing holds them at their tolerance.
    costs = prices(problem, named, found, settings.gaps | settings.allowed) if stopped is Stop.HELD else {}
    return Fitted(found.unknowns, iterations, stopped, prices=costs)


def seams_held(problem: Problem, settings: FitSettings, unknowns: Array) -> list[GapTerm]:
    """What holds gaps, a little inside what is allowed, as seams run at unknowns (panels, size)."""
    allowed = {what: most * (1.0 - MARGIN) for what, most in settings.gaps.items()}
    return gap_terms(problem, allowed, problem.state(unknowns))


def seam_excess(problem: Problem, unknowns: Array, settings: FitSettings) -> dict[str, Array]:
    """(seams,) what is measured along seams, of gaps, their parts and kinks, over what is allowed."""
    met = along_seams(PanelEdges.of(panel_shapes(problem, unknowns)), problem.met)
    measured = {"gap": met.gap, "width": met.width, "step": met.step, "shift": met.shift}
    excess = {what: measured[what] / most for what, most in settings.gaps.items()}
    return excess | {Kink.name: np.degrees(met.kink) / settings.max_kink}


def gather(problem: Problem, settings: FitSettings, limits: Sequence[HeldTerm], start: Array) -> tuple[Array, int]:
    """A few steps towards closed seams, and how many."""
    gaps = seam_terms(problem, settings.widest_gap)
    for gap in gaps:
        gap.hold.weight[:] = _FIRST_GAP
    weighed = [limit for limit in limits if limit.hold.weight.any()]
    firm = [(limit, limit.hold.weight) for limit in weighed if isinstance(limit, DriftTerm)]
    for limit, _ in firm:
        limit.hold.weight = np.full_like(limit.hold.weight, _FIRST_DRIFT)
    model = Objective(problem, [problem.deviation, *gaps, *weighed], coupled=True)
    solution = levenberg_marquardt(model, start, _FIRST)
    for limit, weight in firm:
        limit.hold.weight = weight
    return solution.unknowns, solution.iterations


def _score(problem: Problem, unknowns: Array, settings: FitSettings) -> float:
    """RMS deviation, and a large penalty for gaps and limits that do not hold."""
    state = problem.state(unknowns)
    held: list[HeldTerm] = [*gap_terms(problem, settings.gaps, state), *problem.limits(settings)]
    excess = max(term.hold.excess(term.vectors(state)) for term in held)
    rms = problem.rms(float(problem.deviation.cost(state).sum()))
    return rms * (1.0 if excess <= 1.0 else 1e3 * excess)
