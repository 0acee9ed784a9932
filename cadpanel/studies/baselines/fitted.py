"""Panels of planes, cylinders and cones by one of the methods that a fit can be asked for."""

from __future__ import annotations

from dataclasses import dataclass, field

from cadpanel.fitting.run import fit
from cadpanel.fitting.settings import LIKE_THE_PAPER, FitSettings
from cadpanel.reference.model import Reference
from cadpanel.studies.baselines.baseline import Baseline, Outcome


@dataclass(frozen=True, slots=True)
class Fitted(Baseline):
    """A fit.

    Attributes:
        settings: with its method.
    """

    settings: FitSettings = field(default=LIKE_THE_PAPER)

    def run(self, reference: Reference) -> Outcome:
        """See `Baseline`."""
        return Outcome.of(fit(reference, self.settings).measures)
