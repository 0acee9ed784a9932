"""Orthogonal least squares from given starts: Levenberg-Marquardt on a handful of unknowns, all sets at once.

It minimises the weighted sum of squared distances by the increments of a ruling (see `ruling.moved`) with exact
derivatives; each set has its own damping and leaves the work when it has arrived. How far a step moves the surface
under the samples (root mean square) is what tells arrival, because it means the same for all unknowns, also for those
that the samples do not determine. Source of the method: Marquardt 1963; the damping is that of the scaled normal
matrix, whose diagonal is 1.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array, BoolArray, IntArray
from cadpanel.atomic.ruling import CONE, TURN_N, Rulings, distance_rows, moved, passed_apex_rows

# A step that moves the surface by less than this share of the samples' extent is rounding.
_ARRIVED = 2e-15
# Rounding may be larger where the normal is steep against it; a step this small that no longer shrinks is rounding too.
_NEARLY = 1e-11
_SHRINKING = 0.9
# What is left when the steps are used up counts as arrived if it is this share of the scatter about the surface.
_WITHIN_SCATTER = 1e-5
_FIRST_DAMPING, _LEAST_DAMPING, _MOST_DAMPING = 1e-3, 1e-14, 1e8
# The damping's factor after a step that lowered the cost by a good share of what was foretold, by a poor one, or not.
_GOOD_SHARE, _POOR_SHARE = 0.75, 0.25
_GOOD, _POOR, _WORSE = 0.05, 3.0, 8.0
# A cost that grows by less than this share has not grown.
_COST_ROUNDING = 1e-13
# Radians that a step may turn a ruling by.
_LARGEST_TURN = 0.5
_TINY = 1e-150


@dataclass(slots=True)
class Descent:
    """Where the sets stand; worked on in place.

    Attributes:
        rulings: the fitted surfaces.
        cost: (n,) weighted mean of the squared distances.
        converged: (n,) whether no step leads further.
        damping: (n,) the damping of the next step.
        movement: (n,) how far the last tried step would have moved the surface, had it not been damped, in units of the
            samples' extent.
    """

    rulings: Rulings
    cost: Array
    converged: BoolArray
    damping: Array
    movement: Array

    @staticmethod
    def begin(rulings: Rulings) -> Descent:
        """Nothing is known but where to begin."""
        count = len(rulings.points)
        return Descent(
            rulings,
            np.full(count, np.inf),
            np.zeros(count, dtype=bool),
            np.full(count, _FIRST_DAMPING),
            np.full(count, np.inf),
        )

    def at(self, which: IntArray) -> Descent:
        """Some of the sets."""
        return Descent(
            self.rulings.at(which),
            self.cost[which],
            self.converged[which],
            self.damping[which],
            self.movement[which],
        )

    def put(self, which: IntArray, part: Descent) -> None:
        """Take over what `at` gave away."""
        mine, other = self.rulings, part.rulings
        mine.points[which], mine.frames[which] = other.points, other.frames
        mine.curvature[which], mine.taper[which] = other.curvature, other.taper
        self.cost[which], self.converged[which] = part.cost, part.converged
        self.damping[which], self.movement[which] = part.damping, part.movement


def descend(points: Array, roots: Array, start: Rulings, unknowns: tuple[int, ...], *, steps: int) -> Descent:
    """Walk down from the start by at most so many steps.

    Args:
        points: (n, m, 3) of extent 1 around 0.
        roots: (n, m) square roots of weights whose sum is 1.
        start: n rulings; bending numbers that are not among the unknowns stay as they are.
        unknowns: PLANE, CYLINDER or CONE of `ruling`.
        steps: how many evaluations at most.
    """
    descent = Descent.begin(start.at(slice(None)))
    descent.rulings = start.at(np.arange(len(points)))
    descent.cost, gradient, matrix = _normal_equations(points, roots, start, unknowns)
    for _ in range(steps):
        active = np.flatnonzero(~descent.converged)
        if len(active) == 0:
            break
        part = descent.at(active)
        part_gradient, part_matrix = gradient[active], matrix[active]
        _step(points[active], roots[active], part, part_gradient, part_matrix, unknowns)
        descent.put(active, part)
        gradient[active], matrix[active] = part_gradient, part_matrix
    descent.converged |= descent.movement < _WITHIN_SCATTER * np.sqrt(descent.cost)
    return descent


def _step(
    points: Array, roots: Array, descent: Descent, gradient: Array, matrix: Array, unknowns: tuple[int, ...]
) -> None:
    """Try one step of every set and keep what does not make it worse; everything is changed in place."""
    increments = _damped(gradient, matrix, descent.damping)
    increments *= np.minimum(1.0, _LARGEST_TURN / _turn(increments, unknowns))[:, None]
    movement = np.sqrt(np.maximum(np.einsum("ni,nij,nj->n", increments, matrix, increments), 0.0))
    # A damped step is short because it is damped, too.
    undamped = movement * (1.0 + descent.damping)
    stalled = (undamped < _NEARLY) & (undamped > _SHRINKING * descent.movement)
    descent.converged = (undamped < _ARRIVED) | stalled
    descent.movement = undamped
    trial = moved(descent.rulings, increments, unknowns)
    cost, trial_gradient, trial_matrix = _normal_equations(points, roots, trial, unknowns)
    rounding = _COST_ROUNDING * descent.cost + _ARRIVED * np.sqrt(descent.cost) + _ARRIVED**2
    better = cost <= descent.cost + rounding
    # The model's cost after the step, from its gradient and matrix; what is below rounding is as foretold.
    foretold = -2.0 * np.einsum("ni,ni->n", increments, gradient) - movement**2
    share = (descent.cost - cost + rounding) / np.maximum(foretold, rounding)
    factor = np.where(share > _GOOD_SHARE, _GOOD, np.where(share < _POOR_SHARE, _POOR, 1.0))
    descent.rulings = descent.rulings.replaced(better, trial)
    descent.cost = np.where(better, cost, descent.cost)
    gradient[better], matrix[better] = trial_gradient[better], trial_matrix[better]
    damping = descent.damping * np.where(better, factor, _WORSE)
    # A set that no damping helps stands where rounding hides every way down.
    descent.converged |= damping > _MOST_DAMPING
    descent.damping = np.clip(damping, _LEAST_DAMPING, _MOST_DAMPING)


def _normal_equations(
    points: Array, roots: Array, rulings: Rulings, unknowns: tuple[int, ...]
) -> tuple[Array, Array, Array]:
    """Cost (n,), gradient (n, k) of half the cost and normal matrix (n, k, k)."""
    q = rulings.local(points)
    distance, rows = distance_rows(rulings, q, unknowns)
    cost, gradient, matrix = _summed(distance, rows, roots)
    if unknowns != CONE:
        return cost, gradient, matrix
    # Few sets ever have samples beyond the apex; none whose local coordinates along the ruling all fall short of it.
    some = np.flatnonzero(np.any((1.0 + rulings.taper[:, None] * q[1] < 0.0) & (roots > 0.0), axis=1))
    if len(some):
        passed, rows = passed_apex_rows(rulings.at(some), q[:, some])
        for total, more in zip((cost, gradient, matrix), _summed(passed, rows, roots[some]), strict=True):
            total[some] += more
    return cost, gradient, matrix


def _summed(residuals: Array, rows: Array, roots: Array) -> tuple[Array, Array, Array]:
    residuals = residuals * roots
    rows = rows * roots[:, None, :]
    cost: Array = np.einsum("nm,nm->n", residuals, residuals)
    gradient: Array = (rows @ residuals[:, :, None])[:, :, 0]
    return cost, gradient, rows @ np.swapaxes(rows, 1, 2)


def _damped(gradient: Array, matrix: Array, damping: Array) -> Array:
    """The step: the solution of the damped normal equations, scaled so that their diagonal is 1."""
    scale = 1.0 / np.sqrt(np.maximum(np.einsum("nii->ni", matrix), _TINY))
    scaled = matrix * scale[:, :, None] * scale[:, None, :]
    scaled += damping[:, None, None] * np.eye(matrix.shape[1])
    # An unknown without any influence has an empty row; it stays where it is.
    np.einsum("nii->ni", scaled)[np.einsum("nii->ni", matrix) < _TINY] = 1.0
    step: Array = -scale * np.linalg.solve(scaled, (scale * gradient)[:, :, None])[:, :, 0]
    return step


def _turn(increments: Array, unknowns: tuple[int, ...]) -> Array:
    turns = increments[:, [i for i, unknown in enumerate(unknowns) if unknown <= TURN_N]]
    length: Array = np.sqrt(np.einsum("ni,ni->n", turns, turns))
    return np.maximum(length, _TINY)
