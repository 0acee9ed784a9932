"""What a result is held against: the same panels fitted alone and in two stages, measured when somebody asks."""

from __future__ import annotations

from dataclasses import dataclass, replace

from cadpanel.arrays import Array
from cadpanel.fitting.measures.fit import Measures, measure
from cadpanel.fitting.methods.catalogue import METHODS
from cadpanel.fitting.problem import Problem
from cadpanel.fitting.settings import FitSettings, Method
from cadpanel.fitting.shapes import panel_shapes
from cadpanel.reference.model import Reference


@dataclass(frozen=True, slots=True, kw_only=True)
class Baselines:
    """All that is needed to fit and measure by the methods that every result is held against.

    Most fits are never held against anything: candidates of an automatic choice, columns of a study.

    Attributes:
        reference: what is approximated.
        settings: how.
        problem: the panels as they were posed.
        alone: (panels, size) unknowns of the local fits.
        measured: by method, what is known already; it grows as more is asked for.
    """

    reference: Reference
    settings: FitSettings
    problem: Problem
    alone: Array
    measured: dict[Method, Measures]

    def told_of(self, reference: Reference) -> Baselines:
        """See `HeldAgainst.told_of`."""
        return replace(self, reference=reference)

    def judged_by(self, settings: FitSettings, measures: Measures) -> Baselines:
        """See `HeldAgainst.judged_by`."""
        return replace(self, settings=settings, measured={settings.method: measures})

    @property
    def local(self) -> Measures:
        """Of every panel alone."""
        return self._by("local")

    @property
    def two_stage(self) -> Measures:
        """Of the same panels moved about with their shapes frozen."""
        return self._by("two_stage")

    def _by(self, method: Method) -> Measures:
        if method not in self.measured:
            unknowns = self.alone
            if method != "local":
                unknowns = METHODS[method].fit(self.problem, [self.alone], self.settings).unknowns
            self.measured[method] = measure(panel_shapes(self.problem, unknowns), self.reference)
        return self.measured[method]
