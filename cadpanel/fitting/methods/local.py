"""Every panel alone: what the others begin from, and the first of the industry's two stages."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cadpanel.arrays import Array
from cadpanel.errors import PanelError
from cadpanel.fitting.methods.method import Fitted
from cadpanel.fitting.objective import Objective
from cadpanel.fitting.problem import Problem
from cadpanel.fitting.settings import FitSettings
from cadpanel.reference.model import Reference
from cadpanel.solver.levenberg_marquardt import Stopping, levenberg_marquardt

# Steps at most of a local fit: two cones that are nearly one follow a long flat valley.
_LOCAL_ITERATIONS = 400


# Steps after which those panels that have not settled go on by themselves.
_MOST_SETTLE_BY = 40


# A local fit further off than this share of the panel's length is no fit, and normals further off are no skin.
_HOPELESS_DEVIATION = 0.05


_HOPELESS_TILT = np.radians(35.0)


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
