"""All panels and the gaps between them in one optimization."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array, BoolArray
from cadpanel.fitting.measures.seams import along_seams
from cadpanel.fitting.methods.holding import MARGIN, gap_price, held_within, seam_terms, stopped_as
from cadpanel.fitting.methods.method import Fitted, Method, Progress
from cadpanel.fitting.methods.restarts import best_of_starts
from cadpanel.fitting.methods.restoring import restored
from cadpanel.fitting.methods.weighted import Weighted
from cadpanel.fitting.objective import HeldObjective, Objective
from cadpanel.fitting.problem import Problem, SeamTerm
from cadpanel.fitting.settings import FitSettings
from cadpanel.fitting.shapes import panel_shapes
from cadpanel.solver.components import Components
from cadpanel.solver.giving_way import HeldSolution
from cadpanel.solver.levenberg_marquardt import Stopping, levenberg_marquardt
from cadpanel.solver.stop import Stop
from cadpanel.terms.arc_gap import ArcGap
from cadpanel.terms.limits.corner_drift import DriftTerm
from cadpanel.terms.term import HeldTerm

# Before tolerances count, gaps and drifts weigh this much against the mean squared deviation: local fits of panels with
# several bends scatter their corners by decimetres, and a few steps of a smooth problem gather them.
_FIRST_GAP, _FIRST_DRIFT = 0.1, 1e-2
_FIRST = Stopping(cost=1e-3, iterations=40)
# Between the points that are held, arcs part a little further: they are held at this share of the tolerance.
_ARC_SHARE = 0.82
# How often seams are tightened where they part still further, up to which excess that is worth trying, and to which
# share of the tolerance.
_TIGHTENINGS = 8
_NEARLY = 20.0
_AIM = 0.99


@dataclass(frozen=True, slots=True)
class Concurrent(Method):
    """The smallest deviation at which every gap stays within its tolerance and every limit is kept."""

    def fit(
        self, problem: Problem, starts: Sequence[Array], settings: FitSettings, progress: Progress | None = None
    ) -> Fitted:
        """Fit all panels from their local fits, and from as many restarts as are asked for."""
        local = starts[0]
        return best_of_starts(
            lambda start: _hold_seams(problem, start, starts, settings, progress),
            lambda unknowns: _score(problem, unknowns, settings),
            local,
            settings,
        )

    def with_weights(self) -> Method:
        """Weights rule the paper's objective."""
        return Weighted()


def _hold_seams(
    problem: Problem, start: Array, starts: Sequence[Array], settings: FitSettings, progress: Progress | None
) -> Fitted:
    gaps: list[SeamTerm] = seam_terms(problem, settings.gap_tolerance * (1.0 - MARGIN))
    limits = problem.limits(settings, MARGIN)
    gathered, iterations = _gather(problem, gaps, limits, start)
    state = problem.state(gathered)
    for gap in gaps:
        gap.hold.weight[:] = 0.0
        if isinstance(gap, ArcGap):
            gap.straighten(state)
            gap.hold.radius = _ARC_SHARE * gap.hold.radius
    model = HeldObjective(problem, [problem.deviation], [*gaps, *limits])

    def elsewhere(panels: BoolArray, now: Array) -> tuple[Array, int]:
        return restored(problem, settings, np.flatnonzero(panels), [now, gathered, *starts])

    found = held_within(problem, model, gathered, local=starts[0], elsewhere=elsewhere, tell=progress)
    found = _tightened(problem, model, found, gaps, starts[0], settings, progress)
    # Where gaps had to give way, or it was told to end, nothing holds them at their tolerance.
    price = gap_price(problem, model, found, settings.gap_tolerance) if found.held else None
    return Fitted(found.unknowns, iterations + found.iterations, stopped_as(found), gap_price=price)


def _tightened(
    problem: Problem,
    model: HeldObjective,
    found: HeldSolution,
    gaps: Sequence[SeamTerm],
    local: Array,
    settings: FitSettings,
    progress: Progress | None,
) -> HeldSolution:
    """Measure whole seams, tighten those that are too wide, go on; each connected component for itself."""
    blocks = Components.of(model.pattern)
    seams = blocks.seen_by(np.array([seam.panels[0] for seam in problem.met], dtype=np.intp))
    for tightening in range(_TIGHTENINGS + 1):
        held = np.array([stop in (Stop.HELD, Stop.STEP_LIMIT) for stop in found.stopped])
        seam_gap, _ = along_seams(panel_shapes(problem, found.unknowns), problem.met)
        excess = seam_gap / settings.gap_tolerance
        widest = seams.largest(excess)
        wide = held & ~(widest <= 1.0)
        if not wide.any():
            break
        far = wide & ((tightening == _TIGHTENINGS) | ~(widest < _NEARLY))
        found = found.saying(Stop.OPEN_BETWEEN, far)
        wide &= ~far
        if not wide.any():
            break
        share = np.where((excess > 1.0) & wide[seams.label], _AIM / np.maximum(excess, 1.0), 1.0)
        for gap in gaps:
            if isinstance(gap, ArcGap):
                gap.straighten(problem.state(found.unknowns))
            gap.hold.tighten(share[gap.seams.index])
        found = held_within(problem, model, found.unknowns, local=local, only=wide, after=found, tell=progress)
    return found


def _gather(problem: Problem, gaps: Sequence[SeamTerm], limits: Sequence[HeldTerm], start: Array) -> tuple[Array, int]:
    """A few steps towards closed seams, and how many."""
    firm = [(limit, limit.hold.weight) for limit in limits if isinstance(limit, DriftTerm)]
    for gap in gaps:
        gap.hold.weight[:] = _FIRST_GAP
    for limit, _ in firm:
        limit.hold.weight = np.full_like(limit.hold.weight, _FIRST_DRIFT)
    model = Objective(problem, [problem.deviation, *gaps, *limits], coupled=True)
    solution = levenberg_marquardt(model, start, _FIRST)
    for limit, weight in firm:
        limit.hold.weight = weight
    return solution.unknowns, solution.iterations


def _score(problem: Problem, unknowns: Array, settings: FitSettings) -> float:
    """RMS deviation, and a large penalty for gaps and limits that do not hold."""
    state = problem.state(unknowns)
    held: list[HeldTerm] = [*seam_terms(problem, settings.gap_tolerance), *problem.limits(settings)]
    excess = max(term.hold.excess(term.vectors(state)) for term in held)
    rms = problem.rms(problem.deviation.cost(state))
    return rms * (1.0 if excess <= 1.0 else 1e3 * excess)
