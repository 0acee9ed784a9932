"""The paper's own algorithm, "Concurrent Fitting", as it is printed.

    1. x = the local fits               5. if E < E0: done
    2. d = the first step size          6.   else perturb x, and go on at 2
    3. x' = x - d grad E(x)             7. else scale d, and go on at 3
    4. if |x - x'| < tau:

E is the paper's objective (3), the one that weights rule here. What is left open there is decided so: a step that
lowers E is made and d grows by half; another one is not made, and d is halved, so that the steps come down to tau at a
stationary point. Half of the numbers of every panel, drawn at random, are perturbed. The stationary point with the
least E counts. It is here to be measured against: `python -m tests.benchmarks.annealing`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array
from cadpanel.fitting.methods.method import Fitted, Method, Progress
from cadpanel.fitting.methods.weighted import weighted_objective
from cadpanel.fitting.objective import Objective
from cadpanel.fitting.problem import Problem
from cadpanel.fitting.settings import FitSettings, Weights
from cadpanel.solver.stop import Stop

# The first step is so long, in panel lengths and radians; it grows and shrinks by these factors.
_FIRST_STEP, _GROWTH, _SHRINKAGE = 1e-3, 1.5, 0.5
# Steps tried at most from one start; told of every so many.
_MOST_STEPS, _TOLD_EVERY = 20_000, 50
# Numbers are perturbed by this much (lengths in panel lengths, angles in radians), each with this probability.
_PERTURBED, _CHOSEN = 0.02, 0.5


@dataclass(frozen=True, slots=True)
class Descent:
    """Where steepest descent ended.

    Attributes:
        unknowns: (panels, size).
        energy: E there, mm2.
        steps: gradients worked out, and trials.
        stopped: why.
    """

    unknowns: Array
    energy: float
    steps: int
    stopped: Stop


@dataclass(frozen=True, slots=True)
class Annealing(Method):
    """Steepest descent with an adaptive step to a stationary point, then random perturbations, as in the paper."""

    def fit(
        self, problem: Problem, starts: Sequence[Array], settings: FitSettings, progress: Progress | None = None
    ) -> Fitted:
        """Fit all panels from their local fits, and from as many perturbations as restarts are asked for."""
        model = weighted_objective(problem, settings.weights or Weights(), settings)
        random = np.random.default_rng(settings.seed)
        ends = [descend(model, starts[0], settings, progress)]
        while _goes_on(ends, settings):
            chosen = random.random(starts[0].shape) < _CHOSEN
            shaken = ends[-1].unknowns + _PERTURBED * np.where(chosen, random.standard_normal(chosen.shape), 0.0)
            ends.append(descend(model, shaken, settings, progress))
        best = min(ends, key=lambda end: end.energy)
        agreed = sum(end.energy <= 1.01 * best.energy for end in ends)
        return Fitted(best.unknowns, sum(end.steps for end in ends), best.stopped, agreed=agreed, starts=len(ends))


def _goes_on(ends: Sequence[Descent], settings: FitSettings) -> bool:
    """Whether to perturb once more: not where E is good enough, or all restarts are used up, or the time is."""
    enough = settings.energy is not None and ends[-1].energy < settings.energy
    return not enough and len(ends) <= settings.restarts and ends[-1].stopped is not Stop.TOLD


def energy_scale(model: Objective, weights: Weights) -> float:
    """What a cost of the model is times, to be the paper's E in mm2."""
    return 2.0 * weights.deviation * model.problem.place.length**2


def descend(model: Objective, start: Array, settings: FitSettings, progress: Progress | None = None) -> Descent:
    """Steps 2, 3, 4 and 7 of the algorithm.

    Args:
        model: the objective.
        start: (panels, size).
        settings: weights, and tau.
        progress: told now and then; may end it.
    """
    scale = energy_scale(model, settings.weights or Weights())
    tau = settings.tau / model.problem.place.length
    unknowns = start if model.bounds is None else model.bounds.clip(start)
    booked, normal = model.linearize(unknowns)
    energy, gradient = float(booked.sum()), normal.gradient
    size = _FIRST_STEP / max(float(np.linalg.norm(gradient)), 1e-300)
    stopped, steps = Stop.STEP_LIMIT, 0
    while steps < _MOST_STEPS:
        steps += 1
        if progress is not None and steps % _TOLD_EVERY == 0:
            rms = problem_rms(model, unknowns)
            if not progress(steps, float(np.sqrt(energy * scale)), rms):
                stopped = Stop.TOLD
                break
        trial = unknowns - size * gradient
        trial = trial if model.bounds is None else model.bounds.clip(trial)
        moved = float(np.linalg.norm(trial - unknowns))
        if moved < tau:
            stopped = Stop.AT_REST
            break
        with np.errstate(all="ignore"):
            ahead = float(model.cost(trial).sum())
        if not ahead < energy:
            size *= _SHRINKAGE
            continue
        unknowns, size = trial, size * _GROWTH
        booked, normal = model.linearize(unknowns)
        energy, gradient = float(booked.sum()), normal.gradient
    return Descent(unknowns, energy * scale, steps, stopped)


def problem_rms(model: Objective, unknowns: Array) -> float:
    """The RMS deviation of all panels, mm."""
    problem = model.problem
    return problem.rms(problem.deviation.cost(problem.state(unknowns))) * problem.place.length
