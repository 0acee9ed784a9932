"""What every method gives: the unknowns of all panels and how they were reached."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from cadpanel.arrays import Array

Progress = Callable[[int, float], None]


@dataclass(frozen=True, slots=True)
class Fitted:
    """Unknowns of all panels and how they were reached.

    Attributes:
        unknowns: (panels, free).
        iterations: linear systems solved.
        agreed: how many of the starts, the first included, ended within 1 % of the best deviation and held.
        starts: how many starts were made.
    """

    unknowns: Array
    iterations: int
    agreed: int = 1
    starts: int = 1
