"""The three ways to fit: each panel alone, then moved about (the industry's two stages), and all at once."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cadpanel.errors import PanelError
from cadpanel.fitting.measures import seam_gaps
from cadpanel.fitting.problem import Objective, Problem, Subset
from cadpanel.fitting.settings import FitSettings, Weights
from cadpanel.reference.model import Reference
from cadpanel.solver.levenberg_marquardt import Stopping, levenberg_marquardt
from cadpanel.solver.tolerances import Schedule, hold_tolerances
from cadpanel.terms.arc import ArcGap
from cadpanel.terms.drift import DriftLimit
from cadpanel.terms.gap import CornerGap
from cadpanel.terms.rows import Term
from cadpanel.terms.state import State

Array = NDArray[np.float64]
Progress = Callable[[int, float], None]

# Gaps and drifts are held a little inside what the user allows, so that rounding in a file cannot break the promise.
_MARGIN = 1e-3
# A local fit further off than this share of the panel's length is no fit, and normals further off are no skin.
_HOPELESS_DEVIATION = 0.05
_HOPELESS_TILT = np.radians(35.0)
# No gap is closed at an RMS deviation beyond this multiple of the local fits', or this share of a panel's length where
# the local fits are nearly exact: what comes then is no approximation of the reference any more.
_MOST_MULTIPLE = 5.0
_MOST_SHARE = 0.01
# How often seams are tightened, and up to which excess that is worth trying.
_TIGHTENINGS = 8
_NEARLY = 2.0
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


def fit_local(problem: Problem, reference: Reference, start: Array) -> Fitted:
    """Fit every panel alone: deviation and a weak pull of the corners to the reference's.

    Raises:
        PanelError: a panel stays so far from its reference that the feature is no approximation of it.
    """
    solution = levenberg_marquardt(Objective(problem, problem.free_terms(), coupled=False), start, Stopping())
    rms, _ = problem.deviations(solution.unknowns)
    lengths = np.array([panel.length for panel in reference.panels])
    tilt = problem.normal_tilt(solution.unknowns, reference)
    for i in np.flatnonzero((rms > _HOPELESS_DEVIATION * lengths) | (tilt > _HOPELESS_TILT) | ~np.isfinite(rms)):
        raise PanelError(
            reference.panels[i].name,
            f"no {problem.feature.name} comes near it (RMS deviation {rms[i]:.0f} mm, normals off by "
            f"{np.degrees(tilt[i]):.0f} degrees); check that its faces are one fold between two flanges",
        )
    return Fitted(solution.unknowns, solution.iterations)


def fit_two_stage(problem: Problem, local: Array, settings: FitSettings) -> Fitted:
    """Move the locally fitted panels about and place their corners anew, their shapes frozen, to close the gaps.

    The industry's way, given its best chance: all panels move at once, cuts may tilt as the feature allows, and a
    corner gap of 1 mm counts as much as 1 mm of deviation all over a panel. Corners keep within the drift limits.
    """
    weights = settings.weights or Weights()
    gap = problem.corner_gap(settings.gap_tolerance)
    gap.hold.weight[:] = weights.gap / weights.deviation
    limits = problem.drift_limits(settings, _MARGIN)
    everything = Objective(problem, [problem.deviation, gap, *limits], coupled=True)
    model = Subset(everything, local, problem.placement_unknowns())
    return _balance(problem, model, limits, local[:, model.active], model.fill, local=local)


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
    corners = problem.corner_gap(settings.gap_tolerance * (1.0 - _MARGIN))
    arcs = problem.arc_gap(settings.gap_tolerance * (1.0 - _MARGIN))
    limits = problem.drift_limits(settings, _MARGIN)
    held: list[CornerGap | ArcGap | DriftLimit] = [corners, arcs, *limits]
    model = Objective(problem, [problem.deviation, *held], coupled=True)
    found = _balance(problem, model, held, start, _as_it_is, local=local, progress=progress)
    iterations = found.iterations
    # Between the points that are held the curves may still part a little further: measure, tighten there, go on.
    for _ in range(_TIGHTENINGS):
        excess = seam_gaps(problem, problem.state(found.unknowns)) / settings.gap_tolerance
        if not 1.0 < excess.max(initial=0.0) < _NEARLY:
            break
        share = np.where(excess > 1.0, _AIM / excess, 1.0)
        for gap in (corners, arcs):
            gap.hold.tighten(share)
        found = _balance(
            problem, model, held, found.unknowns, _as_it_is, local=local, progress=progress, schedule=_FINISH
        )
        iterations += found.iterations
    return Fitted(found.unknowns, iterations)


def weighted_objective(problem: Problem, weights: Weights) -> Objective:
    """The paper's objective (3) with a weak pull on the corners, relative to the deviation's weight."""
    gap = problem.corner_gap(1.0)
    gap.hold.weight[:] = weights.gap / weights.deviation
    terms: list[Term] = [problem.deviation, gap]
    for limit in problem.drift_limits(FitSettings(), 0.0):
        limit.hold.weight[:] = weights.drift / weights.deviation
        terms.append(limit)
    return Objective(problem, terms, coupled=True)


def _as_it_is(unknowns: Array) -> Array:
    return unknowns


class _Walker:
    """Walks the panels once for all that ask at the same unknowns, one after the other."""

    def __init__(self, problem: Problem, fill: Callable[[Array], Array]) -> None:
        self._problem, self._fill = problem, fill
        self._last: tuple[Array, State] | None = None

    def state(self, unknowns: Array) -> State:
        if self._last is None or self._last[0] is not unknowns:
            self._last = (unknowns, self._problem.state(self._fill(unknowns)))
        return self._last[1]


class _HeldTerm:
    """A held term as the solver sees it: by the model's unknowns."""

    def __init__(self, walker: _Walker, term: CornerGap | ArcGap | DriftLimit) -> None:
        self.hold = term.hold
        self._walker, self._term = walker, term

    def vectors_at(self, unknowns: Array) -> Array:
        return self._term.vectors(self._walker.state(unknowns))


def _balance(
    problem: Problem,
    model: Objective | Subset,
    held: Sequence[CornerGap | ArcGap | DriftLimit],
    start: Array,
    fill: Callable[[Array], Array],
    *,
    local: Array,
    progress: Progress | None = None,
    schedule: Schedule = _WHOLE,
) -> Fitted:
    walker = _Walker(problem, fill)
    terms = [_HeldTerm(walker, term) for term in held]

    def deviation(unknowns: Array) -> float:
        return float(problem.deviation.cost(walker.state(unknowns)).sum())

    best_alone = float(problem.deviation.cost(problem.state(local)).sum())
    most = max(_MOST_MULTIPLE**2 * best_alone, 0.5 * problem.panels * _MOST_SHARE**2)
    solution = hold_tolerances(model, terms, deviation, start, schedule, most_cost=most, progress=progress)
    return Fitted(fill(solution.unknowns), solution.iterations)


def _score(problem: Problem, unknowns: Array, settings: FitSettings) -> float:
    """RMS deviation, and a large penalty for gaps and drifts that do not hold; the objective where weights rule."""
    if settings.weights is not None:
        return float(weighted_objective(problem, settings.weights).cost(unknowns).sum())
    state = problem.state(unknowns)
    held: list[CornerGap | ArcGap | DriftLimit] = [
        problem.corner_gap(settings.gap_tolerance),
        problem.arc_gap(settings.gap_tolerance),
        *problem.drift_limits(settings, 0.0),
    ]
    excess = max(term.hold.excess(term.vectors(state)) for term in held)
    rms = float(np.sqrt(2.0 * problem.deviation.cost(state).sum() / problem.panels))
    return rms * (1.0 if excess <= 1.0 else 1e3 * excess)
