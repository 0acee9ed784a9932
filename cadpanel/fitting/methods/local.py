"""Every panel alone: what the others begin from, and the first of the industry's two stages."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array
from cadpanel.errors import PanelError
from cadpanel.fitting.methods.method import Fitted, Method, Progress
from cadpanel.fitting.objective import Objective
from cadpanel.fitting.problem import Problem
from cadpanel.fitting.settings import FitSettings
from cadpanel.reference.model import Reference
from cadpanel.solver.levenberg_marquardt import Stopping, levenberg_marquardt
from cadpanel.solver.stop import Stop

# The starts of a panel race: after so many steps each, those drop out whose cost is beyond this multiple of the least
# of their panel, and those that have settled stand aside. Two cones that are nearly one follow a long flat valley.
_RACE = ((10, 4.0), (10, 1.2), (20, 1.0), (360, 1.0))
# A panel has settled where this share of its cost is left to gain: two cones that are nearly one creep on for hundreds
# of steps to gain a ten-thousandth of their deviation. Samples of what a feature can be exactly are still met exactly.
_SETTLED = 1e-4
# The first damping, relative.
_DAMPING = 1e-3
# A local fit further off than this share of the panel's length is no fit, and normals further off are no skin.
_HOPELESS_DEVIATION = 0.05
_HOPELESS_TILT = np.radians(35.0)


@dataclass(frozen=True, slots=True)
class Local(Method):
    """Every panel alone from each of the starts, and for every panel what came nearest.

    Attributes:
        settled: a panel has settled where this share of its cost is left to gain.
    """

    settled: float = _SETTLED

    def fit(
        self, problem: Problem, starts: Sequence[Array], settings: FitSettings, progress: Progress | None = None
    ) -> Fitted:
        """Fit deviation and a weak pull of the corners to the reference's, as the shop can make it."""
        del progress
        race = _Race(problem, starts, settings, self.settled)
        for steps, behind in _RACE:
            race.go_on(steps)
            race.drop(behind)
        stopped = Stop.AT_REST if race.settled.all() else Stop.STEP_LIMIT
        return Fitted(race.best, race.steps, stopped)


class _Race:
    """Every panel from each of its starts.

    Attributes:
        best: (panels, size) for every panel the unknowns with the least cost so far.
        settled: (panels,) whether those have come to rest.
        steps: linear systems solved.
    """

    def __init__(self, problem: Problem, starts: Sequence[Array], settings: FitSettings, settled: float) -> None:
        self._problem, self._settings, self._settled = problem, settings, settled
        first, everyone = starts[0], np.arange(problem.panels)
        others = [np.flatnonzero((start != first).any(axis=1)) for start in starts[1:]]
        self._panel = np.concatenate([everyone, *others])
        self._at = np.concatenate([first, *(start[own] for start, own in zip(starts[1:], others, strict=True))])
        self._damping = np.full(len(self._panel), _DAMPING)
        self.best, self.settled, self.steps = first.copy(), np.zeros(problem.panels, dtype=bool), 0
        self._least = np.full(problem.panels, np.inf)

    def go_on(self, steps: int) -> None:
        """So many steps for all that run."""
        if not len(self._panel):
            return
        part = self._problem.take(self._panel)
        size = part.layout.size
        model = Objective(part, part.free_terms(self._settings), coupled=False)
        stopping = Stopping(cost=self._settled, iterations=steps)
        solution = levenberg_marquardt(model, self._at[:, :size], stopping, self._damping)
        self._at[:, :size], self._damping, self._cost = solution.unknowns, solution.damping, solution.cost
        self._rests = solution.converged
        self.steps += solution.iterations
        # The last of those that come first wins, so that the best of a panel does.
        for i in np.argsort(-self._cost, kind="stable").tolist():
            panel = self._panel[i]
            if self._cost[i] <= self._least[panel]:
                self._least[panel], self.settled[panel] = self._cost[i], self._rests[i]
                self.best[panel] = self._at[i]

    def drop(self, behind: float) -> None:
        """Let those go on that have not settled and are not that far behind."""
        if len(self._panel):
            runs = ~self._rests & (self._cost <= behind * self._least[self._panel])
            self._panel, self._at, self._damping = self._panel[runs], self._at[runs], self._damping[runs]


def fit_local(
    problem: Problem, reference: Reference, starts: Sequence[Array], settings: FitSettings | None = None
) -> Fitted:
    """Fit every panel alone, as all other methods begin, and look at what came out.

    Raises:
        PanelError: a panel stays so far from its reference that the feature is no approximation of it.
    """
    best = Local().fit(problem, starts, settings or FitSettings())
    refuse_hopeless(problem, reference, best.unknowns)
    return best


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
