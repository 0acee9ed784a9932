"""The three ways to fit: each panel alone, then moved about (the industry's two stages), and all at once."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cadpanel.errors import PanelError
from cadpanel.fitting.measures.fit import seam_gaps
from cadpanel.fitting.objective import Frozen, Objective
from cadpanel.fitting.problem import Problem, SeamTerm
from cadpanel.fitting.settings import FitSettings, Weights
from cadpanel.reference.model import Reference
from cadpanel.solver.constrained import Schedule, hold_tolerances
from cadpanel.solver.levenberg_marquardt import Stopping, levenberg_marquardt
from cadpanel.terms.limits.corner_drift import DriftLimit
from cadpanel.terms.limits.flange_width import WidthLimit
from cadpanel.terms.limits.min_radius import RadiusLimit
from cadpanel.terms.rows import Term
from cadpanel.terms.state import State

Array = NDArray[np.float64]
Progress = Callable[[int, float], None]
Limit = DriftLimit | RadiusLimit | WidthLimit

# Steps at most of a local fit: two cones that are nearly one follow a long flat valley.
_LOCAL_ITERATIONS = 400
# Steps after which those panels that have not settled go on by themselves.
_MOST_SETTLE_BY = 40
# Gaps and drifts are held a little inside what the user allows, so that rounding in a file cannot break the promise.
_MARGIN = 1e-3
# A local fit further off than this share of the panel's length is no fit, and normals further off are no skin.
_HOPELESS_DEVIATION = 0.05
_HOPELESS_TILT = np.radians(35.0)
# No gap is closed at an RMS deviation beyond this multiple of the local fits', or this share of a panel's length where
# the local fits are nearly exact: what comes then is no approximation of the reference any more.
_MOST_MULTIPLE = 5.0
_MOST_SHARE = 0.01
# How often seams are tightened, and up to which excess that is worth trying. Arcs are held by their distances from the
# other arc's cone and cut plane; on gently curved panels these meet at a small angle once the cut leans far, and what
# is within the tolerance of both may be ten times as far from where they meet.
_TIGHTENINGS = 8
_NEARLY = 20.0
# Weights steer a little inside the tolerance, which costs next to no deviation and saves the long last approach.
_AIM = 0.95
_WHOLE = Schedule(aim=_AIM)
_FINISH = Schedule(aim=_AIM, balance=10)
# Restarts shake the unknowns by this much (lengths in panel lengths, angles in radians); two ends agree within a share.
_SHAKE = 0.02
_AGREE = 0.01


@dataclass(frozen=True, slots=True)
class Fitted:
    """Unknowns of all panels and how they were reached.

    Attributes:
        unknowns: (panels, free).
        iterations: linear systems solved.
        agreed: how many of the starts, the first included, ended within 1 % of the best deviation and held.
        starts: how many starts were made.
    """

    unknowns: Array
    iterations: int
    agreed: int = 1
    starts: int = 1


def fit_local(
    problem: Problem, reference: Reference, starts: Sequence[Array], settings: FitSettings | None = None
) -> Fitted:
    """Fit every panel alone: deviation and a weak pull of the corners to the reference's, as the shop can make it.

    Raises:
        PanelError: a panel stays so far from its reference that the feature is no approximation of it.
    """
    best = fit_alone(problem, starts, settings or FitSettings())
    refuse_hopeless(problem, reference, best.unknowns)
    return best


def fit_alone(problem: Problem, starts: Sequence[Array], settings: FitSettings) -> Fitted:
    """Fit every panel alone from each of the starts, and keep for every panel what came nearest."""
    model = Objective(problem, problem.free_terms(settings), coupled=False)
    ends = [_settle(problem, model, start, settings) for start in starts]
    costs = np.array([model.cost(end.unknowns) for end in ends])
    unknowns = np.array([end.unknowns for end in ends])[costs.argmin(axis=0), np.arange(problem.panels)]
    return Fitted(unknowns, sum(end.iterations for end in ends))


def _settle(problem: Problem, model: Objective, start: Array, settings: FitSettings) -> Fitted:
    """Go on with those few panels alone that take their time."""
    solution = levenberg_marquardt(model, start, Stopping(iterations=_MOST_SETTLE_BY))
    unknowns, iterations = solution.unknowns, solution.iterations
    late = np.flatnonzero(~solution.converged)
    if len(late):
        part = problem.take(late)
        rest = levenberg_marquardt(
            Objective(part, part.free_terms(settings), coupled=False),
            unknowns[late, : part.layout.size],
            Stopping(iterations=_LOCAL_ITERATIONS),
        )
        unknowns[late, : part.layout.size] = rest.unknowns
        iterations += rest.iterations
    return Fitted(unknowns, iterations)


def refuse_hopeless(problem: Problem, reference: Reference, unknowns: Array) -> None:
    """Refuse panels that stay so far from their references that their features are no approximation.

    Raises:
        PanelError: naming the panel.
    """
    rms, _ = problem.deviations(unknowns)
    lengths = np.array([panel.length for panel in reference.panels])
    tilt = problem.normal_tilt(unknowns, reference)
    for i in np.flatnonzero((rms > _HOPELESS_DEVIATION * lengths) | (tilt > _HOPELESS_TILT) | ~np.isfinite(rms)):
        raise PanelError(
            reference.panels[i].name,
            f"no {problem.layout.feature_of[i].name} comes near it (RMS deviation {rms[i]:.0f} mm, normals off by "
            f"{np.degrees(tilt[i]):.0f} degrees); check its faces, or choose another feature",
        )


def fit_two_stage(problem: Problem, local: Array, settings: FitSettings) -> Fitted:
    """Move the locally fitted panels about and place their corners anew, their shapes frozen, to close the gaps.

    The industry's way, given its best chance: all panels move at once, cuts may tilt as the feature allows, and a
    corner gap of 1 mm counts as much as 1 mm of deviation all over a panel. Corners keep within the drift limits.
    """
    weights = settings.weights or Weights()
    gaps = problem.corner_gaps(settings.gap_tolerance)
    for gap in gaps:
        gap.hold.weight[:] = weights.gap / weights.deviation
    limits = _limits(problem, settings)
    everything = Objective(problem, [problem.deviation, *gaps, *limits], coupled=True)
    return _balance(problem, Frozen(everything, problem.placement_unknowns()), limits, local, local=local)


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
    gaps: list[SeamTerm] = _seam_terms(problem, settings.gap_tolerance * (1.0 - _MARGIN))
    held: list[SeamTerm | Limit] = [*gaps, *_limits(problem, settings)]
    model = Objective(problem, [problem.deviation, *held], coupled=True)
    found = _balance(problem, model, held, start, local=local, progress=progress)
    iterations = found.iterations
    # Between the points that are held the curves may still part a little further: measure, tighten there, go on.
    for _ in range(_TIGHTENINGS):
        excess = seam_gaps(problem, problem.state(found.unknowns)) / settings.gap_tolerance
        if not 1.0 < excess.max(initial=0.0) < _NEARLY:
            break
        share = np.where(excess > 1.0, _AIM / excess, 1.0)
        for gap in gaps:
            gap.hold.tighten(share[gap.seams.index])
        found = _balance(problem, model, held, found.unknowns, local=local, progress=progress, schedule=_FINISH)
        iterations += found.iterations
    return Fitted(found.unknowns, iterations)


def weighted_objective(problem: Problem, weights: Weights) -> Objective:
    """The paper's objective (3) with a weak pull on the corners, relative to the deviation's weight."""
    terms: list[Term] = [problem.deviation]
    for gap in problem.corner_gaps(1.0):
        gap.hold.weight[:] = weights.gap / weights.deviation
        terms.append(gap)
    for limit in problem.drift_limits(FitSettings(), 0.0):
        limit.hold.weight[:] = weights.drift / weights.deviation
        terms.append(limit)
    terms += problem.shop_limits(FitSettings())
    return Objective(problem, terms, coupled=True)


def _limits(problem: Problem, settings: FitSettings) -> list[Limit]:
    """What panels may not do however wide the gaps are, a little inside what the user allows."""
    return [*problem.drift_limits(settings, _MARGIN), *problem.shop_limits(settings)]


def _seam_terms(problem: Problem, tolerance: float) -> list[SeamTerm]:
    """Everything that holds seams within `tolerance` mm."""
    return [*problem.corner_gaps(tolerance), *problem.curve_gaps(tolerance)]


class _Walker:
    """Walks the panels once for all that ask at the same unknowns, one after the other."""

    def __init__(self, problem: Problem) -> None:
        self._problem = problem
        self._last: tuple[Array, State] | None = None

    def state(self, unknowns: Array) -> State:
        if self._last is None or self._last[0] is not unknowns:
            self._last = (unknowns, self._problem.state(unknowns))
        return self._last[1]


class _HeldTerm:
    """A held term as the solver sees it: by the model's unknowns."""

    def __init__(self, walker: _Walker, term: SeamTerm | Limit) -> None:
        self.hold = term.hold
        self._walker, self._term = walker, term

    def vectors_at(self, unknowns: Array) -> Array:
        return self._term.vectors(self._walker.state(unknowns))


def _balance(
    problem: Problem,
    model: Objective | Frozen,
    held: Sequence[SeamTerm | Limit],
    start: Array,
    *,
    local: Array,
    progress: Progress | None = None,
    schedule: Schedule = _WHOLE,
) -> Fitted:
    walker = _Walker(problem)
    terms = [_HeldTerm(walker, term) for term in held]

    def deviation(unknowns: Array) -> float:
        return float(problem.deviation.cost(walker.state(unknowns)).sum())

    best_alone = float(problem.deviation.cost(problem.state(local)).sum())
    most = max(_MOST_MULTIPLE**2 * best_alone, 0.5 * problem.panels * _MOST_SHARE**2)
    solution = hold_tolerances(model, terms, deviation, start, schedule, most_cost=most, progress=progress)
    return Fitted(solution.unknowns, solution.iterations)


def _score(problem: Problem, unknowns: Array, settings: FitSettings) -> float:
    """RMS deviation, and a large penalty for gaps and drifts that do not hold; the objective where weights rule."""
    if settings.weights is not None:
        return float(weighted_objective(problem, settings.weights).cost(unknowns).sum())
    state = problem.state(unknowns)
    held = [*_seam_terms(problem, settings.gap_tolerance), *problem.drift_limits(settings, 0.0)]
    excess = max(term.hold.excess(term.vectors(state)) for term in held)
    rms = float(np.sqrt(2.0 * problem.deviation.cost(state).sum() / problem.panels))
    return rms * (1.0 if excess <= 1.0 else 1e3 * excess)
