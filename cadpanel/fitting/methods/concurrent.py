"""All panels and the gaps between them in one optimization."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from cadpanel.arrays import Array
from cadpanel.fitting.measures.seams import along_seams
from cadpanel.fitting.methods.balance import AIM, FINISH, MARGIN, balanced, seam_terms
from cadpanel.fitting.methods.method import Fitted, Method, Progress
from cadpanel.fitting.methods.restarts import best_of_starts
from cadpanel.fitting.methods.weighted import Weighted
from cadpanel.fitting.objective import Objective
from cadpanel.fitting.problem import Problem, SeamTerm
from cadpanel.fitting.settings import FitSettings
from cadpanel.fitting.shapes import panel_shapes
from cadpanel.solver.stop import Stop
from cadpanel.terms.term import HeldTerm

# How often seams are tightened, and up to which excess that is worth trying. Arcs are held by their distances from the
# other arc's cone and cut plane; on gently curved panels these meet at a small angle once the cut leans far, and what
# is within the tolerance of both may be ten times as far from where they meet.
_TIGHTENINGS = 8
_NEARLY = 20.0


@dataclass(frozen=True, slots=True)
class Concurrent(Method):
    """The smallest deviation at which every gap stays within its tolerance and every limit is kept."""

    def fit(
        self, problem: Problem, starts: Sequence[Array], settings: FitSettings, progress: Progress | None = None
    ) -> Fitted:
        """Fit all panels from their local fits, and from as many restarts as are asked for."""
        local = starts[0]
        return best_of_starts(
            lambda start: _hold_seams(problem, start, local, settings, progress),
            lambda unknowns: _score(problem, unknowns, settings),
            local,
            settings,
        )

    def with_weights(self) -> Method:
        """Weights rule the paper's objective."""
        return Weighted()


def _hold_seams(
    problem: Problem, start: Array, local: Array, settings: FitSettings, progress: Progress | None
) -> Fitted:
    gaps: list[SeamTerm] = seam_terms(problem, settings.gap_tolerance * (1.0 - MARGIN))
    held: list[HeldTerm] = [*gaps, *problem.limits(settings, MARGIN)]
    model = Objective(problem, [problem.deviation, *held], coupled=True)
    found = balanced(problem, model, held, start, local=local, progress=progress)
    iterations = found.iterations
    # Between the points that are held the curves may still part a little further: measure, tighten there, go on.
    for tightening in range(_TIGHTENINGS + 1):
        seam_gap, _ = along_seams(panel_shapes(problem, found.unknowns), problem.met)
        excess = seam_gap / settings.gap_tolerance
        if excess.max(initial=0.0) <= 1.0:
            break
        if tightening == _TIGHTENINGS or not excess.max() < _NEARLY:
            if found.stopped is Stop.HELD:
                found = replace(found, stopped=Stop.OPEN_BETWEEN)
            break
        share = np.where(excess > 1.0, AIM / excess, 1.0)
        for gap in gaps:
            gap.hold.tighten(share[gap.seams.index])
        found = balanced(problem, model, held, found.unknowns, local=local, progress=progress, schedule=FINISH)
        iterations += found.iterations
    return replace(found, iterations=iterations)


def _score(problem: Problem, unknowns: Array, settings: FitSettings) -> float:
    """RMS deviation, and a large penalty for gaps and limits that do not hold."""
    state = problem.state(unknowns)
    held: list[HeldTerm] = [*seam_terms(problem, settings.gap_tolerance), *problem.limits(settings)]
    excess = max(term.hold.excess(term.vectors(state)) for term in held)
    rms = float(np.sqrt(2.0 * problem.deviation.cost(state).sum() / problem.panels))
    return rms * (1.0 if excess <= 1.0 else 1e3 * excess)
