"""All panels and the gaps between them in one optimization."""

from __future__ import annotations

import numpy as np

from cadpanel.arrays import Array
from cadpanel.fitting.measures.seams import along_seams
from cadpanel.fitting.methods.balance import AIM, FINISH, MARGIN, Limit, balanced, drift_and_shop_limits, seam_terms
from cadpanel.fitting.methods.method import Fitted, Progress
from cadpanel.fitting.methods.weighted import weighted_objective
from cadpanel.fitting.objective import Objective
from cadpanel.fitting.problem import Problem, SeamTerm
from cadpanel.fitting.settings import FitSettings
from cadpanel.fitting.shapes import panel_shapes
from cadpanel.solver.levenberg_marquardt import Stopping, levenberg_marquardt

# How often seams are tightened, and up to which excess that is worth trying. Arcs are held by their distances from the
# other arc's cone and cut plane; on gently curved panels these meet at a small angle once the cut leans far, and what
# is within the tolerance of both may be ten times as far from where they meet.
_TIGHTENINGS = 8
_NEARLY = 20.0
# Restarts shake the unknowns by this much (lengths in panel lengths, angles in radians); two ends agree within a share.
_SHAKE = 0.02
_AGREE = 0.01


def fit_concurrent(problem: Problem, local: Array, settings: FitSettings, progress: Progress | None = None) -> Fitted:
    """Fit all panels and the gaps between them in one optimization.

    With a tolerance: the smallest deviation at which every gap and drift stays within it. With weights: the paper's
    objective (3). Further starts, if asked for, begin from shaken local fits; the best end counts.
    """
    ends = []
    random = np.random.default_rng(settings.seed)
    for attempt in range(settings.restarts + 1):
        start = local if attempt == 0 else local + _SHAKE * random.standard_normal(local.shape)
        ends.append(_concurrent(problem, start, local, settings, progress))
    scores = [_score(problem, end.unknowns, settings) for end in ends]
    best = int(np.argmin(scores))
    agreed = int(np.sum(np.array(scores) <= scores[best] * (1.0 + _AGREE)))
    return Fitted(ends[best].unknowns, sum(end.iterations for end in ends), agreed, len(ends))


def _concurrent(
    problem: Problem, start: Array, local: Array, settings: FitSettings, progress: Progress | None
) -> Fitted:
    if settings.weights is not None:
        model = weighted_objective(problem, settings.weights)
        solution = levenberg_marquardt(model, start, Stopping(iterations=300))
        return Fitted(solution.unknowns, solution.iterations)
    gaps: list[SeamTerm] = seam_terms(problem, settings.gap_tolerance * (1.0 - MARGIN))
    held: list[SeamTerm | Limit] = [*gaps, *drift_and_shop_limits(problem, settings)]
    model = Objective(problem, [problem.deviation, *held], coupled=True)
    found = balanced(problem, model, held, start, local=local, progress=progress)
    iterations = found.iterations
    # Between the points that are held the curves may still part a little further: measure, tighten there, go on.
    for _ in range(_TIGHTENINGS):
        seam_gap, _ = along_seams(panel_shapes(problem, found.unknowns), problem.met)
        excess = seam_gap / settings.gap_tolerance
        if not 1.0 < excess.max(initial=0.0) < _NEARLY:
            break
        share = np.where(excess > 1.0, AIM / excess, 1.0)
        for gap in gaps:
            gap.hold.tighten(share[gap.seams.index])
        found = balanced(problem, model, held, found.unknowns, local=local, progress=progress, schedule=FINISH)
        iterations += found.iterations
    return Fitted(found.unknowns, iterations)


def _score(problem: Problem, unknowns: Array, settings: FitSettings) -> float:
    """RMS deviation, and a large penalty for gaps and drifts that do not hold; the objective where weights rule."""
    if settings.weights is not None:
        return float(weighted_objective(problem, settings.weights).cost(unknowns).sum())
    state = problem.state(unknowns)
    held = [*seam_terms(problem, settings.gap_tolerance), *problem.drift_limits(settings, 0.0)]
    excess = max(term.hold.excess(term.vectors(state)) for term in held)
    rms = float(np.sqrt(2.0 * problem.deviation.cost(state).sum() / problem.panels))
    return rms * (1.0 if excess <= 1.0 else 1e3 * excess)
