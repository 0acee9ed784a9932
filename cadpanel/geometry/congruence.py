"""How nearly two flat figures are the same one, moved and turned: never turned over, as sheet has two sides."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array


@dataclass(frozen=True, slots=True, kw_only=True)
class Motion:
    """A turn about the origin and a shift after it: what lays one figure on another.

    Attributes:
        turn: (2, 2) a rotation.
        shift: (2,) mm.
    """

    turn: Array
    shift: Array

    def moved(self, points: Array) -> Array:
        """(..., 2) points, moved."""
        return np.asarray(points @ self.turn.T + self.shift)


def best_motion(points: Array, others: Array) -> Motion:
    """The motion that takes points (n, 2) nearest to others (n, 2), by the sum of squares; in closed form."""
    middle, other_middle = points.mean(axis=0), others.mean(axis=0)
    own, there = points - middle, others - other_middle
    cosine, sine = float((own * there).sum()), float((own[:, 0] * there[:, 1] - own[:, 1] * there[:, 0]).sum())
    size = np.hypot(cosine, sine)
    # A figure without size may be turned anyhow.
    cosine, sine = (cosine / size, sine / size) if size > 0.0 else (1.0, 0.0)
    turn = np.array([[cosine, -sine], [sine, cosine]])
    return Motion(turn=turn, shift=other_middle - turn @ middle)
