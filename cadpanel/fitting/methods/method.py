"""What every method takes and gives: unknowns of all panels to begin with, and those that were reached."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from cadpanel.arrays import Array
from cadpanel.fitting.measures.edges import PanelEdges
from cadpanel.fitting.measures.seams import AlongSeams
from cadpanel.fitting.problem import Problem
from cadpanel.fitting.settings import FitSettings
from cadpanel.geometry.panel import Panel
from cadpanel.solver.stop import Stop

# Told the step, the largest excess over a tolerance and the RMS deviation in mm; whether to go on.
Progress = Callable[[int, float, float], bool]


@dataclass(frozen=True, slots=True)
class SeamsMet:
    """How panels meet at some unknowns: what holds seams measures it, and the result need not measure it again.

    Attributes:
        unknowns: (panels, size).
        shapes: the panels there.
        edges: their edges.
        along: what was measured along whole seams.
    """

    unknowns: Array
    shapes: tuple[Panel, ...]
    edges: PanelEdges
    along: AlongSeams


@dataclass(frozen=True, slots=True)
class Fitted:
    """Unknowns of all panels and how they were reached.

    Attributes:
        unknowns: (panels, free).
        iterations: linear systems solved.
        stopped: why no better ones were looked for.
        agreed: how many of the starts, the first included, ended within 1 % of the best deviation and held.
        starts: how many starts were made.
        prices: by how much the RMS deviation, mm, would fall for one unit more of what is held, by its name; empty
            where nothing is held at its tolerance.
        seam_prices: the same for one mm more of the gap, or of all its parts, at each seam alone; empty likewise.
        met: how the panels meet at the last unknowns that were measured on the way, if any were.
    """

    unknowns: Array
    iterations: int
    stopped: Stop
    agreed: int = 1
    starts: int = 1
    prices: Mapping[str, float] = field(default_factory=dict)
    seam_prices: tuple[float, ...] = ()
    met: SeamsMet | None = None

    def measured(self) -> SeamsMet | None:
        """How the panels meet at these very unknowns, where that was measured."""
        met = self.met
        return met if met is not None and np.array_equal(met.unknowns, self.unknowns) else None


class Method(ABC):
    """A way to fit all panels of a problem.

    A method of one's own is a class with `fit`, in a file of its own, and a line in the catalogue.
    """

    @abstractmethod
    def fit(
        self, problem: Problem, starts: Sequence[Array], settings: FitSettings, progress: Progress | None = None
    ) -> Fitted:
        """Fit the panels.

        Args:
            problem: what is to be fitted.
            starts: arrays (panels, size) of unknowns to begin with, the likeliest first: for the local fits what the
                reference tells of the panels, for all other methods the local fits and then what these began with, or
                where another fit ended that is to be gone on from.
            settings: what the user asks.
            progress: told of every round, where a method goes in rounds.
        """

    def with_weights(self) -> Method:
        """The method that takes this one's place where the user gives weights instead of a tolerance."""
        return self
