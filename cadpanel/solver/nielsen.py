"""How much a step is damped after another one, by what that one kept of its promise.

H. B. Nielsen, Damping parameter in Marquardt's method, IMM-REP-1999-05: damping falls smoothly with the gain, stays as
it is where a step kept half of its promise, and rises ever faster while steps are refused.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array, BoolArray

FIRST_GROWTH = 2.0
_MOST_GROWTH = 64.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Nielsen:
    """The rule.

    Attributes:
        least, most: between which damping stays.
        drop: to which share of it the damping falls at the most.
        rise: by this factor it rises on a refusal beside what it grows.
    """

    least: float
    most: float
    drop: float
    rise: float = 1.0

    def after(self, damping: Array, growth: Array, gain: Array, failed: BoolArray) -> tuple[Array, Array]:
        """Damping (k,) and its growth (k,) after steps.

        Args:
            damping: (k,) of the steps that were taken.
            growth: (k,) by which it rises on a refusal; twice as fast on the next one.
            gain: (k,) which share of its promise each step kept.
            failed: (k,) whether it was refused.
        """
        fallen = damping * np.maximum(self.drop, 1.0 - (2.0 * np.clip(gain, 0.0, 1.0) - 1.0) ** 3)
        wanted = np.where(failed, damping * growth * self.rise, fallen)
        faster = np.where(failed, np.minimum(growth * 2.0, _MOST_GROWTH), FIRST_GROWTH)
        return np.clip(wanted, self.least, self.most), faster
