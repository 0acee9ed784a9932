"""What a choice of features may cost: steps of solvers, by how much work each is, against a fit of one feature.

No clock is asked: who chooses does the same on every machine. A step is a few hundred calls for every feature and every
kind of seam among the panels, and some arithmetic for every panel.
"""

from __future__ import annotations

from dataclasses import dataclass

from cadpanel.fitting.problem import Problem

# The calls of a step for one feature, or for one kind of seam, take as long as the arithmetic of so many panels.
_CALLS = 23.0
# Trials may cost so many times what the one fit does; what is left to ten goes into that
# fit, posing, measuring and the last trial's gathering of corners.
_TIMES = 6.5


def work_of(problem: Problem) -> float:
    """How much work a step on these panels is, in that for the arithmetic of a single one."""
    return _CALLS * (len(problem.layout.groups) + len(problem.seams)) + problem.panels


@dataclass
class Effort:
    """What was spent, and may be.

    Attributes:
        spent: work so far.
        allowed: how much it may become.
    """

    spent: float = 0.0
    allowed: float = 0.0

    def measured_by(self, problem: Problem, steps: int) -> None:
        """Allow some times what a fit of these panels took, besides that fit."""
        self.allowed = _TIMES * steps * work_of(problem)

    def steps(self, problem: Problem) -> int:
        """How many steps on these panels are left."""
        return max(0, int((self.allowed - self.spent) / work_of(problem)))

    def spend(self, problem: Problem, steps: int) -> None:
        """Note steps on some panels."""
        self.spent += steps * work_of(problem)
