"""All panels and the gaps between them in one optimization."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from cadpanel.arrays import Array, BoolArray
from cadpanel.fitting.methods.holding import (
    MARGIN,
    GapTerm,
    excess_along,
    gap_terms,
    held_within,
    prices,
    seam_terms,
    seams_met,
    stopped_as,
    tighten,
)
from cadpanel.fitting.methods.kinks import less_kinked
from cadpanel.fitting.methods.method import Fitted, Method, Progress, SeamsMet
from cadpanel.fitting.methods.restarts import best_of_starts
from cadpanel.fitting.methods.restoring import restored
from cadpanel.fitting.methods.weighted import Weighted
from cadpanel.fitting.objective import HeldObjective, Objective
from cadpanel.fitting.problem import Problem
from cadpanel.fitting.settings import FitSettings
from cadpanel.solver.components import Components
from cadpanel.solver.giving_way import HeldSolution
from cadpanel.solver.levenberg_marquardt import Stopping, levenberg_marquardt
from cadpanel.solver.stop import Stop
from cadpanel.terms.limits.catalogue import LIMITS
from cadpanel.terms.limits.corner_drift import DriftTerm
from cadpanel.terms.limits.kink import KinkTerm
from cadpanel.terms.term import HeldTerm

# Before tolerances count, gaps and drifts weigh this much against the mean squared deviation: local fits of panels with
# several bends scatter their corners by decimetres, and a few steps of a smooth problem gather them. Two cones that are
# nearly one creep on for dozens of steps; what these still gain, the steps that hold tolerances gain as well.
_FIRST_GAP, _FIRST_DRIFT = 0.1, 1e-2
_FIRST = Stopping(cost=1e-2, iterations=40, least=3)
# Where that is all but enough, as far as so little excess tells, corners are gathered once more and more closely.
_CLOSELY, _ALL_BUT = Stopping(cost=1e-3, iterations=40), 1.2
# How often seams are tightened where they part still further, and up to which excess that is worth trying.
_TIGHTENINGS = 8
_NEARLY = 20.0
# What must be kept exceeds its limit beyond rounding.
_FIRM = 1.0 + 1e-5
# What gives way last does so only where that lets the excess, or the deviation, fall to this share.
_HELPS = 0.5
# Limits that give way with gaps where what panels must keep to cannot be kept beside them, the first ones first.
_YIELDING = tuple(
    frozenset(limit.name for limit in LIMITS if limit.yields and limit.yields_last is last) for last in (False, True)
)


@dataclass(frozen=True, slots=True)
class Concurrent(Method):
    """The smallest deviation at which every gap stays within its tolerance and every limit is kept.

    Attributes:
        goes_on: whether the second start is the end of a fit under other tolerances, to go on from.
    """

    goes_on: bool = False

    def fit(
        self, problem: Problem, starts: Sequence[Array], settings: FitSettings, progress: Progress | None = None
    ) -> Fitted:
        """Fit all panels from their local fits and as many restarts as are asked for, or from another fit's end."""
        if self.goes_on:
            return _hold_seams(problem, starts[1], starts, settings, progress, gathered=True)
        return best_of_starts(
            lambda start: _held_from(problem, start, starts, settings, progress),
            lambda unknowns: _score(problem, unknowns, settings),
            starts[0],
            settings,
        )

    def with_weights(self) -> Method:
        """Weights rule the paper's objective."""
        return Weighted()


def _held_from(
    problem: Problem, start: Array, starts: Sequence[Array], settings: FitSettings, progress: Progress | None
) -> Fitted:
    """Hold every seam from a start, gathered more closely where that misses what must hold by a little."""
    found = _hold_seams(problem, start, starts, settings, progress)
    if found.stopped in (Stop.HELD, Stop.TOLD) or not 1.0 < _excess(problem, found.unknowns, settings) <= _ALL_BUT:
        return found
    again = _hold_seams(problem, start, starts, settings, progress, gathering=_CLOSELY)
    steps = found.iterations + again.iterations
    better = _score(problem, again.unknowns, settings) < _score(problem, found.unknowns, settings)
    return replace(again if better else found, iterations=steps)


def _hold_seams(
    problem: Problem,
    start: Array,
    starts: Sequence[Array],
    settings: FitSettings,
    progress: Progress | None,
    *,
    gathered: bool = False,
    gathering: Stopping = _FIRST,
) -> Fitted:
    """Hold every seam from a start, whose corners lie together already or are gathered first."""
    limits = problem.named_limits(settings, MARGIN)
    terms = [term for _, term in limits]
    begin, iterations = (start, 0) if gathered else gather(problem, settings, terms, start, gathering)
    named: list[tuple[str, HeldTerm]] = [*(("gap", term) for term in seams_held(problem, settings, begin)), *limits]
    model = HeldObjective(problem, [problem.deviation], [term for _, term in named])
    everywhere = np.ones(model.pattern.components, dtype=bool)
    asked = [term.hold.radius for term in model.held]

    def elsewhere(panels: BoolArray, now: Array) -> tuple[Array, int]:
        but = [name for name, term in limits if term.hold.gives_way]
        return restored(problem, settings, np.flatnonzero(panels), [now, begin, *starts], but)

    def held(unknowns: Array, where: BoolArray) -> HeldSolution:
        return held_within(problem, model, unknowns, local=starts[0], only=where, elsewhere=elsewhere, tell=progress)

    found, open_ = held(begin, everywhere), everywhere
    blocks = Components.of(model.pattern)
    for names in _YIELDING:
        yielding = [term for name, term in limits if name in names]
        told = np.array([stop is Stop.TOLD for stop in found.stopped])
        lost = open_ & ~told & (found.end.best.firm > _FIRM) & bool(yielding)
        found, met = _tightened(problem, model, found, open_ & ~lost, starts[0], settings, progress)
        open_ = lost
        if not lost.any() or Stop.TOLD in found.stopped:
            break
        # What panels must keep to cannot be kept beside these, as with rulings that are all parallel between edges that
        # are not: they give way with the gaps.
        for term in yielding:
            term.hold.gives_way = True
        again = found.mixed(held(np.where(blocks.each(lost), begin, found.unknowns), lost), lost, blocks)
        found = again if names is _YIELDING[0] else found.mixed(again, _worth_it(found, again), blocks)
    else:
        found, met = _tightened(problem, model, found, open_, starts[0], settings, progress)
    if any(isinstance(term, KinkTerm) for term in model.held) and Stop.TOLD not in found.stopped:
        missed = np.array([stop not in (Stop.HELD, Stop.STEP_LIMIT) for stop in found.stopped])
        if missed.any():
            found = less_kinked(problem, model, found, begin, asked, starts[0], settings, missed)
    # Where gaps had to give way, or it was told to end, nothing holds them at their tolerance.
    if not found.held:
        return Fitted(found.unknowns, iterations + found.iterations, stopped_as(found), met=met)
    costs, of_seams = prices(problem, named, found, settings.gaps | settings.allowed)
    steps = iterations + found.iterations
    each = tuple(of_seams.tolist())
    return Fitted(found.unknowns, steps, stopped_as(found), prices=costs, seam_prices=each, met=met)


def _worth_it(found: HeldSolution, again: HeldSolution) -> BoolArray:
    """(components,) where what gave way last helped what must hold, or the deviation by far: else it stays held."""
    one, other = found.end.best, again.end.best
    return np.asarray((other.firm <= np.maximum(_FIRM, _HELPS * one.firm)) | (other.cost <= _HELPS**2 * one.cost))


def _tightened(
    problem: Problem,
    model: HeldObjective,
    found: HeldSolution,
    where: BoolArray,
    local: Array,
    settings: FitSettings,
    progress: Progress | None,
) -> tuple[HeldSolution, SeamsMet | None]:
    """Measure whole seams, tighten those that are too wide, go on; each of some connected components for itself.

    And what was measured last.
    """
    met: SeamsMet | None = None
    seams = Components.of(model.pattern).seen_by(np.array([seam.panels[0] for seam in problem.met], dtype=np.intp))
    for tightening in range(_TIGHTENINGS + 1):
        held = where & np.array([stop in (Stop.HELD, Stop.STEP_LIMIT) for stop in found.stopped])
        if not held.any():
            break
        met = seams_met(problem, found.unknowns)
        excess = excess_along(problem, met.along, settings)
        widest = np.max([seams.largest(over) for over in excess.values()], axis=0)
        wide = held & ~(widest <= 1.0)
        far = wide & ((tightening == _TIGHTENINGS) | ~(widest < _NEARLY))
        found = found.saying(Stop.OPEN_BETWEEN, far)
        wide &= ~far
        if not wide.any():
            break
        here = wide[seams.label]
        tighten(
            model.held, problem.state(found.unknowns), {of: np.where(here, over, 0.0) for of, over in excess.items()}
        )
        found = held_within(problem, model, found.unknowns, local=local, only=wide, after=found, tell=progress)
    return found, met


def seams_held(problem: Problem, settings: FitSettings, unknowns: Array) -> list[GapTerm]:
    """What holds gaps, a little inside what is allowed, as seams run at unknowns (panels, size)."""
    allowed = {what: most * (1.0 - MARGIN) for what, most in problem.gaps(settings).items()}
    return gap_terms(problem, allowed, problem.state(unknowns))


def gather(
    problem: Problem, settings: FitSettings, limits: Sequence[HeldTerm], start: Array, stopping: Stopping = _FIRST
) -> tuple[Array, int]:
    """A few steps towards closed seams, and how many."""
    gaps = seam_terms(problem, settings.widest_gap)
    for gap in gaps:
        gap.hold.weight[:] = _FIRST_GAP
    weighed = [limit for limit in limits if limit.hold.weight.any()]
    firm = [(limit, limit.hold.weight) for limit in weighed if isinstance(limit, DriftTerm)]
    for limit, _ in firm:
        limit.hold.weight = np.full_like(limit.hold.weight, _FIRST_DRIFT)
    model = Objective(problem, [problem.deviation, *gaps, *weighed], coupled=True)
    solution = levenberg_marquardt(model, start, stopping)
    for limit, weight in firm:
        limit.hold.weight = weight
    return solution.unknowns, solution.iterations


def _score(problem: Problem, unknowns: Array, settings: FitSettings) -> float:
    """RMS deviation, and a large penalty for gaps and limits that do not hold."""
    excess = _excess(problem, unknowns, settings)
    rms = problem.rms(problem.deviation.cost(problem.state(unknowns)))
    return rms * (1.0 if excess <= 1.0 else 1e3 * excess)


def _excess(problem: Problem, unknowns: Array, settings: FitSettings) -> float:
    """The largest ratio of a gap or a limit to what is allowed."""
    state = problem.state(unknowns)
    held: list[HeldTerm] = [*gap_terms(problem, problem.gaps(settings), state), *problem.limits(settings)]
    return max(term.hold.excess(term.vectors(state)) for term in held)
