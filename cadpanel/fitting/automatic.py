"""Features chosen panel by panel: trials of all panels together, and another feature for those that need one.

Closing the seams costs deviation: panels that break a limit over it get a feature that follows better, and those that
cannot be built any more another one. Whether features will do is seen in trials, in which nothing gives way, all from
the local fits: from where neighbours of other features were held together there is often no way.

Where the cheapest features will not do, the common one is fitted to all panels in full. What that takes says how much
may be spent on trials, what it leaves open shows which panels need another feature, and of all that was seen the best
is given.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.errors import PanelError
from cadpanel.fitting.attempt import Attempts
from cadpanel.fitting.feature_choice import COMMON, Choice, can_be_built
from cadpanel.fitting.measures.verdict import limits_of
from cadpanel.fitting.methods.catalogue import LOCAL, method_for
from cadpanel.fitting.methods.concurrent import Concurrent
from cadpanel.fitting.problem import Problem
from cadpanel.fitting.result import FitResult
from cadpanel.solver.stop import Stop

# How often panels of which nothing could be built may be given another feature, each alone.
_REPLACEMENTS = 8
# Before it is known what the common feature takes, a trial of cheaper ones may take so many steps; and where there is a
# panel that it is nothing for, it is taken to take as many.
_FIRST_STEPS = 60
# Fewer steps show nothing.
_LEAST_STEPS = 20
# To so many digits results are worth the same.
_DIGITS = 3


def fit_automatically(attempts: Attempts) -> FitResult:
    """Fit panels with the cheapest features that do.

    Raises:
        PanelError: no feature comes near a panel.
    """
    choice = Choice(attempts.reference, attempts.settings)
    if method_for(attempts.settings) == LOCAL:
        return _buildable_alone(attempts, choice)
    search = _Search(attempts, choice)
    search.run()
    return search.best()


@dataclass(frozen=True, slots=True, eq=False)
class _Seen:
    """What was fitted.

    Attributes:
        problem, alone: the panels and their local fits (panels, size).
        chosen: (panels,) which features they have.
        result: what came out.
        lost: panels of which nothing can be built.
        full: whether it was fitted in full, not tried.
    """

    problem: Problem
    alone: Array
    chosen: IntArray
    result: FitResult
    lost: IntArray
    full: bool

    @property
    def does(self) -> bool:
        """Whether it holds everything that is asked for, and can be built."""
        return self.result.tolerance_met and not len(self.lost)

    @property
    def excesses(self) -> tuple[float, float]:
        """By how much limits, and gaps, exceed what is allowed; 1 where all hold, or would if seams were tightened."""
        m, how = self.result.measures, self.result.settings
        if how.weights is not None:
            return 1.0, 1.0
        limits = [float(limit.excess(m, allowed).max(initial=1.0)) for limit, allowed in limits_of(how)]
        if self.result.stopped is Stop.OPEN_BETWEEN:
            return _told(max(limits)), 1.0
        gaps = [float((m.gaps[what] / allowed).max(initial=1.0)) for what, allowed in how.gaps.items()]
        return _told(max(limits)), _told(max(gaps))

    @property
    def excess(self) -> float:
        """The larger of both."""
        return max(self.excesses)

    @property
    def worth(self) -> tuple[float, ...]:
        """Less is better: what cannot be built, what exceeds limits, gaps, then deviations, and what features cost."""
        far = self.result.measures.max_deviation.max(initial=0.0) / (self.result.settings.max_deviation or np.inf)
        expense = float(self.chosen.sum())
        return float(len(self.lost)), float(not self.does), *self.excesses, _told(max(1.0, float(far))), expense


def _told(value: float) -> float:
    return float(f"{value:.{_DIGITS}g}")


class _Search:
    """Fits one after the other, as long as they may go on."""

    def __init__(self, attempts: Attempts, choice: Choice) -> None:
        self._attempts, self._choice, self._effort = attempts, choice, choice.effort
        self._seen: list[_Seen] = []
        self._replacements = 0

    def run(self) -> None:
        """Fit until features do, or nothing is left to be tried, or to be spent."""
        choice = self._choice
        last = self._tried(_FIRST_STEPS) if self._cheaper() else None
        if self._over() or (last is not None and last.does):
            return
        common = self._commonly_fitted()
        # Where it does, only what is cheaper on the whole is worth a trial.
        most = common.chosen.sum() if common is not None and common.does else np.inf
        changed = not np.array_equal(choice.chosen, choice.common())
        if last is None and not changed:
            last = common
        elif last is not None and common is not None and last.excess > common.excess:
            # Cheaper features leave open at least what the common one does.
            choice.chosen, last = np.maximum(choice.chosen, choice.common()), common
        if last is not None:
            changed = self._changed(last)
        while changed and not self._over() and choice.chosen.sum() < most:
            last = self._tried()
            if last is None or last.does or self._effort.steps(last.problem) < _LEAST_STEPS:
                break
            changed = self._changed(last)

    def best(self) -> FitResult:
        """What is worth most of all that was seen, and of what it becomes where nothing held."""
        attempts, best = self._attempts, self._worthiest()
        if best.excess > 1.0 and not best.full and method_for(attempts.settings) == Concurrent():
            best = self._in_full(best, self._effort.steps(best.problem))  # something gives way then
        while best.result.stopped is Stop.OPEN_BETWEEN and not best.full and not attempts.over:
            steps = max(_LEAST_STEPS, self._effort.steps(best.problem))
            self._seen.remove(best)
            closed = attempts.closed(best.problem, best.alone, best.result, steps)
            self._seen.append(replace(best, result=closed, lost=_lost(closed)))
            best = self._worthiest()
        if attempts.settings.restarts and not best.full:
            best = self._in_full(best, None)
        return best.result

    def _worthiest(self) -> _Seen:
        return min(self._seen, key=lambda seen: seen.worth)

    def _in_full(self, best: _Seen, steps: int | None) -> _Seen:
        """The best after that one was fitted in full, too, if there is time and so many steps are worth it."""
        if not self._attempts.over and (steps is None or steps >= _LEAST_STEPS):
            result = self._attempts.fit_together(best.problem, best.alone, steps)
            self._seen.append(replace(best, result=result, lost=_lost(result), full=True))
        return self._worthiest()

    def _over(self) -> bool:
        return self._attempts.over

    def _cheaper(self) -> bool:
        """Whether some panels have a cheaper feature than the common one, and none a dearer one."""
        chosen = self._choice.chosen
        return bool((chosen <= COMMON).all() and (chosen < COMMON).any())

    def _tried(self, steps: int | None = None) -> _Seen | None:
        """A trial of the features chosen, if anything is left for it."""
        problem, alone = self._posed()
        left = self._effort.steps(problem) if steps is None else steps
        if left < _LEAST_STEPS:
            return None
        seen = self._note(problem, alone, self._attempts.try_together(problem, alone, left))
        self._effort.spend(problem, seen.result.iterations)
        return seen

    def _commonly_fitted(self) -> _Seen | None:
        """The common feature fitted in full, which says how much may be spent; None if it is nothing for a panel."""
        choice, seen, steps = self._choice, None, _FIRST_STEPS
        chosen, choice.chosen = choice.chosen, choice.common()
        problem, alone = self._posed()
        try:
            # From its own local fits: whoever asks for this feature gets the same.
            result = self._attempts.fit(choice.features())
        except PanelError:
            pass  # other features may come near the panel
        else:
            seen, steps = self._note(problem, alone, result, full=True), result.iterations
        self._effort.measured_by(problem, steps)
        choice.chosen = chosen
        return seen

    def _note(self, problem: Problem, alone: Array, result: FitResult, *, full: bool = False) -> _Seen:
        """Remember what came out for the features chosen."""
        seen = _Seen(problem, alone, self._choice.chosen.copy(), result, _lost(result), full)
        self._seen.append(seen)
        return seen

    def _posed(self) -> tuple[Problem, Array]:
        """The panels with the features chosen, and their local fits (panels, size)."""
        problem, _ = self._attempts.posed(self._choice.features())
        return problem, self._choice.alone(problem.layout)

    def _changed(self, last: _Seen) -> bool:
        """Whether panels that broke a limit, or cannot be built, have another feature now."""
        if len(last.lost) and last.result.stopped in (Stop.HELD, Stop.OPEN_BETWEEN):
            self._replacements += 1
            return self._replacements <= _REPLACEMENTS and self._choice.forbid(last.lost)
        return self._choice.promote(np.union1d(last.lost, offenders(last.result)))


def _buildable_alone(attempts: Attempts, choice: Choice) -> FitResult:
    """Every panel alone, with another feature where nothing can be built of it."""
    result = attempts.fit(choice.features())
    for _ in range(_REPLACEMENTS):
        lost = _lost(result)
        if not len(lost) or not choice.forbid(lost):
            break
        result = attempts.fit(choice.features())
    return result


def _lost(result: FitResult) -> IntArray:
    """Indices of the panels of which nothing can be built."""
    return np.array([i for i, shape in enumerate(result.shapes) if not can_be_built(shape)], dtype=np.intp)


def offenders(result: FitResult) -> IntArray:
    """Indices of the panels that break a limit, or meet another one in a seam that stays open."""
    m, how = result.measures, result.settings
    beyond = np.zeros(len(m.lengths), dtype=bool)
    if how.max_deviation is not None:
        beyond |= m.max_deviation > how.max_deviation
    for limit, allowed in limits_of(how):
        beyond |= ~limit.kept(m, allowed)
    if result.stopped is Stop.OPEN_BETWEEN and beyond.any():
        return np.flatnonzero(beyond)  # their seams were held, and not tightened, as these panels deviate too far
    gaps = m.gaps
    for what, most in how.gaps.items():
        beyond[m.seam_panels[gaps[what] > most]] = True
    return np.flatnonzero(beyond)
