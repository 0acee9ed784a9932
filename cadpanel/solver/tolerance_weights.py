"""Vectors that are to stay within a distance: a tolerance in millimetres instead of a weight.

At the smallest cost under |v_k| <= tau_k the pull on each vector points along the vector itself, so the solution is
that of a plain weighted least squares problem, cost + sum of w_k |v_k|^2 / 2, for the right weights w_k >= 0, where
w_k = 0 unless |v_k| = tau_k (the Karush-Kuhn-Tucker conditions). The weights are found by multiplication: a vector that
is too long gets a larger weight, one that is short a smaller one. Every inner problem is smooth, and no weight ever
becomes larger than the tolerance asks for.
"""

from __future__ import annotations

import numpy as np

from cadpanel.arrays import Array

# What cannot be held is given up here, before the weights drown the rest of the objective.
PENALTY_MAX = 1e5
# No weight grows or shrinks by more than this in one round: the factor by which penalty methods raise their parameter
# (Nocedal and Wright, Numerical Optimization, 2nd ed. 2006, section 17.1).
PENALTY_FACTOR = 2.0
# Rprop's eta+ and eta- and the bounds of its steps (Riedmiller and Braun, A direct adaptive method for faster
# backpropagation learning: the RPROP algorithm, IEEE Int. Conf. on Neural Networks 1993). A step is here the exponent
# of |v| / tau by which a weight is multiplied.
ETA_PLUS, ETA_MINUS = 1.2, 0.5
STEP_MIN, STEP_MAX = 0.1, 2.0
# A vector of length 0 has a logarithm, too.
_LEAST_RATIO = 1e-6


class Hold:
    """Distances and weights of a batch of held vectors.

    Attributes:
        radius: (groups, vectors) the distances tau.
        weight: (groups, vectors) the weights w.
    """

    def __init__(self, radius: Array, *, weight: float, least: float) -> None:
        """Start with one weight for all vectors.

        Args:
            radius: (groups, vectors) the distances tau, above 0.
            weight: the first weight.
            least: no weight sinks below it.
        """
        self.radius = radius
        self.weight = np.full(radius.shape, weight)
        self._least = least
        self._step = np.ones(radius.shape)
        self._side = np.zeros(radius.shape)

    def roots(self) -> Array:
        """(groups, vectors) square roots of the weights: the residual of a vector is its root times the vector."""
        roots: Array = np.sqrt(self.weight)
        return roots

    def excess(self, vectors: Array) -> float:
        """The largest |v| / tau."""
        return float(self._ratio(vectors).max(initial=0.0))

    def violation(self, vectors: Array) -> float:
        """Sum of what exceeds 1 of all |v| / tau."""
        return float(np.maximum(self._ratio(vectors) - 1.0, 0.0).sum())

    def adapt(self, vectors: Array, *, only_grow: bool, aim: float = 1.0) -> None:
        """Multiply the weights by (|v| / (aim tau))^step for the next inner solve.

        The step of a vector that stays on one side of its distance grows, that of one that jumps from side to side
        shrinks (the rule of Rprop on the logarithms of the weights).

        Args:
            vectors: (groups, vectors, d) at the last solution.
            aim: share of the distances to settle at; a little below 1, all vectors hold before the last has settled.
            only_grow: leave the weights of short vectors alone, to close in on a solution that holds.
        """
        ratio = np.maximum(self._ratio(vectors) / aim, _LEAST_RATIO)
        side = np.sign(np.log(ratio))
        self._step = np.clip(self._step * np.where(side == self._side, ETA_PLUS, ETA_MINUS), STEP_MIN, STEP_MAX)
        self._side = side
        factor = np.clip(ratio**self._step, 1.0 if only_grow else 1.0 / PENALTY_FACTOR, PENALTY_FACTOR)
        self.weight = np.clip(self.weight * factor, self._least, PENALTY_MAX)

    def tighten(self, share: Array) -> None:
        """Shrink the distances of every group to a share (groups,) of themselves; the weights stay as a start."""
        self.radius = self.radius * share[:, None]

    def _ratio(self, vectors: Array) -> Array:
        ratio: Array = np.linalg.norm(vectors, axis=-1) / self.radius
        return ratio
