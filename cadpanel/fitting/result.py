"""The result of a fit, and what it says of itself."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array
from cadpanel.fitting.baselines import Baselines
from cadpanel.fitting.measures.fit import Measures
from cadpanel.fitting.measures.verdict import limits_of, too_oblique
from cadpanel.fitting.settings import FitSettings
from cadpanel.geometry.panel import Panel
from cadpanel.reference.model import Reference
from cadpanel.solver.stop import Stop
from cadpanel.terms.limits.corner_drift import DriftAlong

Progress = Callable[[str, int, float, float], bool | None]
"""Told the method, the step, the largest excess over a tolerance (1 where all hold) and the RMS deviation in mm while a
fit runs; False ends it with the best so far."""


_OF_GAPS = {
    "gap": "the gap tolerance of {allowed} is not met: {seam} stays open by {found}",
    "width": "the joint tolerance of {allowed} is not met: {seam} is too wide or too narrow by {found}",
    "step": "the step of {allowed} is not met: {seam} has one of {found}",
    "shift": "the shift of {allowed} is not met: corners at {seam} lie {found} apart along it",
}
_GIVES_WAY_FIRST = DriftAlong()


@dataclass(frozen=True, slots=True)
class FitResult:
    """Fitted panels and what they are worth.

    Attributes:
        reference: what was approximated.
        settings: how.
        shapes: the panels, in the order of the reference.
        measures: gaps, deviation and drift of this result.
        unknowns: (panels, size) the solver's numbers of the shapes, from which a fit of the same panels with the same
            features may go on.
        baselines: what it is held against, fitted and measured when `local` or `two_stage` is first asked for.
        tolerance_met: whether every gap is within the tolerance, every limit kept and, where features are
            chosen automatically, every deviation within the largest; with weights only the deviation has one to miss.
        starts, agreed: how many starts were made, and how many ended within 1 % of the best.
        iterations: linear systems solved for this result.
        stopped: why no better result was looked for.
        prices: by how much the RMS deviation, mm, would fall for one unit more of each thing that is held, to first
            order: as long as the change is small, and the panels stay near where they are. By name: "gap", "width",
            "step" and "shift" a mm, limits by their settings' names a mm, degree or whole panel's length. Empty where
            not everything is held.
        seconds: time of the fit, without the baselines.
    """

    reference: Reference
    settings: FitSettings
    shapes: tuple[Panel, ...]
    measures: Measures
    unknowns: Array
    baselines: Baselines
    tolerance_met: bool
    starts: int
    agreed: int
    iterations: int
    stopped: Stop
    prices: Mapping[str, float]
    seconds: float

    @property
    def local(self) -> Measures:
        """The same measures of every panel fitted alone."""
        return self.baselines.local

    @property
    def two_stage(self) -> Measures:
        """The same measures of the industry's two stages."""
        return self.baselines.two_stage

    @property
    def gap_price(self) -> float | None:
        """By how much one mm more of gap tolerance would lower the RMS deviation, mm; None where it is not held."""
        return self.prices.get("gap")

    def shape(self, name: str) -> Panel:
        """The panel of that name.

        Raises:
            KeyError: there is none.
        """
        for shape in self.shapes:
            if shape.name == name:
                return shape
        raise KeyError(name)

    def shortfall(self) -> str | None:
        """None if the tolerance and all limits hold, else one sentence on the worst seam or panel, and why it ended."""
        missed = self._missed()
        if missed is None or self.stopped is Stop.HELD:  # what is held is; it is another limit that is missed
            return missed
        return f"{missed}; the search stopped as {self.stopped.value}"

    def _missed(self) -> str | None:
        """What does not hold, and what would help."""
        if self.tolerance_met:
            return None
        m = self.measures
        oblique = np.flatnonzero(too_oblique(m))
        if len(oblique):
            return (
                f"panel '{self.reference.panels[oblique[0]].name}' cannot be built: an end of it is cut too obliquely; "
                "divide it further, or choose another feature"
            )
        allowed = self.settings.max_deviation
        if allowed is not None and m.max_deviation.max() > allowed:
            far = int(m.max_deviation.argmax())
            return (
                f"the largest deviation of {allowed:g} mm is not met: panel '{self.reference.panels[far].name}' is "
                f"{m.max_deviation[far]:.2f} mm away as a {self.shapes[far].feature}, the best that was found; allow "
                "more, allow wider gaps, or divide it further"
            )
        missed = self._missed_gaps()
        limit, most = max(limits_of(self.settings), key=lambda one: float(one[0].excess(m, one[1]).max()))
        panel = int(np.argmax(limit.excess(m, most)))
        if not limit.kept(m, most)[panel]:
            value, length = float(limit.measure(m)[panel]), float(m.lengths[panel])
            missed.append(limit.missed(self.reference.panels[panel].name, value, most, length))
        else:
            limit = _GIVES_WAY_FIRST
        # Where both are missed by far, no wider limit helps: the feature cannot follow.
        advice = ("choose another feature, " if len(missed) > 1 else "") + f"allow a larger gap or {limit.remedy}"
        return f"{', and '.join(missed)}; {advice}"

    def _missed_gaps(self) -> list[str]:
        """What to say of the seam that exceeds most what is allowed of gaps or of one of their parts, if one does."""
        gaps = self.measures.gaps
        over = {what: float((gaps[what] / most).max(initial=0.0)) for what, most in self.settings.gaps.items()}
        what = max(over, key=lambda one: over[one])
        if over[what] <= 1.0:
            return []
        worst = int(gaps[what].argmax())
        a, b = (self.reference.panels[i].name for i in self.reference.seams[worst].panels)
        allowed, of = f"{self.settings.gaps[what]:g} mm", gaps[what][worst]
        return [_OF_GAPS[what].format(allowed=allowed, seam=f"the seam between '{a}' and '{b}'", found=f"{of:.2f} mm")]
