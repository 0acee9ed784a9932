"""Unknowns between bounds, and steps that keep to them.

One that stands on its bound and would be pushed beyond it is held there for the step, and steps are cut at the bounds
(Bertsekas, Projected Newton methods, SIAM J. Control and Optimization 20, 1982).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array, BoolArray
from cadpanel.solver.blocks import BlockPattern, Factors, Normal

# A step that a bound shortens by less than this share is not cut.
_ROUNDING = 1e-11


@dataclass(frozen=True, slots=True)
class Bounds:
    """Least and greatest values of the unknowns, (count, size) each; infinite where there is none, alike if fixed."""

    lower: Array
    upper: Array

    def clip(self, unknowns: Array) -> Array:
        """The nearest unknowns within the bounds."""
        clipped: Array = np.clip(unknowns, self.lower, self.upper)
        return clipped

    def hold(self, unknowns: Array) -> bool:
        """Whether all unknowns are within the bounds."""
        return bool(np.all((unknowns >= self.lower) & (unknowns <= self.upper)))

    def blocked(self, unknowns: Array, gradient: Array) -> BoolArray:
        """(count, size) which unknowns stand on a bound beyond which the cost would fall."""
        at_lower, at_upper = unknowns <= self.lower, unknowns >= self.upper
        blocked: BoolArray = (at_lower & (gradient > 0.0)) | (at_upper & (gradient < 0.0)) | (at_lower & at_upper)
        return blocked

    def beyond(self, unknowns: Array, step: Array) -> BoolArray:
        """(count, size) which unknowns stand on a bound beyond which a step leads."""
        beyond: BoolArray = ((unknowns <= self.lower) & (step < 0.0)) | ((unknowns >= self.upper) & (step > 0.0))
        return beyond


# How often unknowns are held because a step would push them beyond the bounds on which they stand.
_TRIES = 4


@dataclass(frozen=True, slots=True)
class BoundedStep:
    """A step within the bounds.

    Attributes:
        step: (count, size).
        promised: (count,) the decrease that the model promises.
        cut: (count,) 1 where the step was cut at a bound, else 0.
        factors: of the matrix that it was found with.
        blocked: (count, size) which unknowns were held at their bounds.
    """

    step: Array
    promised: Array
    cut: Array
    factors: Factors
    blocked: BoolArray


def bounded_step(
    pattern: BlockPattern, normal: Normal, damping: Array, unknowns: Array, bounds: Bounds | None
) -> BoundedStep | None:
    """The step of (J^T J + diag(damping)) s = -gradient within the bounds; None if that is not positive definite."""
    blocked = np.zeros(unknowns.shape, dtype=bool) if bounds is None else bounds.blocked(unknowns, normal.gradient)
    factors, wanted = None, unknowns
    for _ in range(_TRIES):
        free = normal.without(blocked, pattern.pairs) if blocked.any() else normal
        factors = pattern.factorize(free, np.where(blocked, 0.0, damping))
        if factors is None:
            return None
        wanted = factors.solve(-free.gradient)
        # Cut off at once, a step that leads beyond a bound on which it stands is no step of the model any more, however
        # much it is damped: what it would push is held, too.
        beyond = np.zeros_like(blocked) if bounds is None else bounds.beyond(unknowns, wanted)
        if not beyond.any():
            break
        blocked = blocked | beyond
    if factors is None:
        return None
    if bounds is None or (not blocked.any() and bounds.hold(unknowns + wanted)):
        # Of an unhindered step the damped model promises s . (damping s - gradient) / 2.
        promised = 0.5 * np.sum(wanted * (damping * wanted - normal.gradient), axis=1)
        return BoundedStep(wanted, promised, np.zeros(pattern.count), factors, blocked)
    step = bounds.clip(unknowns + wanted) - unknowns
    bent = np.sum(step * pattern.multiply(normal, step), axis=1)
    cut = np.any(np.abs(step - wanted) > _ROUNDING * np.abs(wanted), axis=1).astype(np.float64)
    return BoundedStep(step, -np.sum(step * normal.gradient, axis=1) - 0.5 * bent, cut, factors, blocked)
