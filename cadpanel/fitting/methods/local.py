"""Every panel alone: what the others begin from, and the first of the industry's two stages."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array, BoolArray
from cadpanel.errors import PanelError
from cadpanel.fitting.methods.method import Fitted, Method, Progress
from cadpanel.fitting.objective import Objective
from cadpanel.fitting.problem import Problem
from cadpanel.fitting.settings import FitSettings
from cadpanel.reference.model import Reference
from cadpanel.solver.levenberg_marquardt import Stopping, levenberg_marquardt
from cadpanel.solver.stop import Stop

# Steps at most of a local fit: two cones that are nearly one follow a long flat valley.
_LOCAL_ITERATIONS = 400
# Steps after which those panels that have not settled go on by themselves.
_MOST_SETTLE_BY = 40
# A panel has settled where this share of its cost is left to gain: two cones that are nearly one creep on for hundreds
# of steps to gain a ten-thousandth of their deviation. Samples of what a feature can be exactly are still met exactly.
_SETTLED = 1e-6
# A local fit further off than this share of the panel's length is no fit, and normals further off are no skin.
_HOPELESS_DEVIATION = 0.05
_HOPELESS_TILT = np.radians(35.0)


@dataclass(frozen=True, slots=True)
class Local(Method):
    """Every panel alone from each of the starts, and for every panel what came nearest."""

    def fit(
        self, problem: Problem, starts: Sequence[Array], settings: FitSettings, progress: Progress | None = None
    ) -> Fitted:
        """Fit deviation and a weak pull of the corners to the reference's, as the shop can make it."""
        del progress
        model = Objective(problem, problem.free_terms(settings), coupled=False)
        ends = [_settle(problem, model, start, settings) for start in starts]
        costs = np.array([model.cost(end.unknowns) for end in ends])
        kept = costs.argmin(axis=0), np.arange(problem.panels)
        unknowns, settled = (np.array([getattr(end, what) for end in ends])[kept] for what in ("unknowns", "settled"))
        stopped = Stop.AT_REST if settled.all() else Stop.STEP_LIMIT
        return Fitted(unknowns, sum(end.iterations for end in ends), stopped)


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


@dataclass(frozen=True, slots=True)
class _Settled:
    """Unknowns (panels, size), which panels (panels,) came to rest, and linear systems solved."""

    unknowns: Array
    settled: BoolArray
    iterations: int


def _settle(problem: Problem, model: Objective, start: Array, settings: FitSettings) -> _Settled:
    """Go on with those few panels alone that take their time."""
    solution = levenberg_marquardt(model, start, Stopping(cost=_SETTLED, iterations=_MOST_SETTLE_BY))
    unknowns, settled, iterations = solution.unknowns, solution.converged, solution.iterations
    late = np.flatnonzero(~settled)
    if len(late):
        part = problem.take(late)
        rest = levenberg_marquardt(
            Objective(part, part.free_terms(settings), coupled=False),
            unknowns[late, : part.layout.size],
            Stopping(cost=_SETTLED, iterations=_LOCAL_ITERATIONS),
        )
        unknowns[late, : part.layout.size] = rest.unknowns
        settled[late] = rest.converged
        iterations += rest.iterations
    return _Settled(unknowns, settled, iterations)


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
