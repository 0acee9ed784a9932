"""The result of a fit, and what it says of itself."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from cadpanel.arrays import Array
from cadpanel.fitting.measures.fit import Measures
from cadpanel.fitting.measures.leans import leans
from cadpanel.fitting.measures.verdict import keeps_limits, limits_of, too_oblique
from cadpanel.fitting.rules.rule import Outcome
from cadpanel.fitting.settings import FitSettings
from cadpanel.geometry.panel import Panel
from cadpanel.near import holds, panel_named
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
_OPTIONS = {"gap": "--gap-tolerance", "width": "--joint-tolerance", "step": "--step", "shift": "--shift"}
# By how much more than it came out a gap is to be allowed, that a run which ends a little elsewhere holds it, too.
# Another width beside the same step or shift is another question, to which the answer may lie farther off: of 9 lips
# that twist too hard all runs held what came out by a sixth more, and one of them not what did by a twentieth.
_ROOM, _ROOM_OF_PARTS = 1.05, 1.25
_GIVES_WAY_FIRST = DriftAlong()


def _above(gap: float, room: float) -> str:
    """Some more than a gap, mm, rounded up to two digits."""
    digit = 10.0 ** (np.floor(np.log10(room * gap)) - 1)
    return f"{np.ceil(room * gap / digit) * digit:g}"


def _broken(outcome: Outcome) -> str:
    """What to say of a rule that does not hold."""
    unit = f" {outcome.unit}" if outcome.unit else ""
    return (
        f"the rule '{outcome.rule}' does not hold: {outcome.measure} {outcome.found:.4g}{unit}, where "
        f"{outcome.allowed:.4g}{unit} are allowed; allow wider gaps, or leave the rule out"
    )


class HeldAgainst(Protocol):
    """What a result is held against; `baselines.Baselines` is such a thing."""

    @property
    def reference(self) -> Reference:
        """What is approximated."""
        ...

    def told_of(self, reference: Reference) -> HeldAgainst:
        """The same of a reference with other notes."""
        ...

    def judged_by(self, settings: FitSettings, measures: Measures) -> HeldAgainst:
        """The same for a result of these measures as the answer to other settings."""
        ...

    @property
    def local(self) -> Measures:
        """Of every panel alone."""
        ...

    @property
    def two_stage(self) -> Measures:
        """Of the same panels moved about with their shapes frozen."""
        ...


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
        tolerance_met: whether every gap is within the tolerance, every limit and every rule kept and, where features
            are chosen automatically, every deviation within the largest; with weights only the deviation has one to
            miss.
        starts, agreed: how many starts were made, and how many ended within 1 % of the best.
        iterations: linear systems solved for this result.
        stopped: why no better result was looked for.
        outcomes: what was measured of each rule for single panels and seams.
        prices: by how much the RMS deviation, mm, would fall for one unit more of each thing that is held, to first
            order: as long as the change is small, and the panels stay near where they are. By name: "gap", "width",
            "step" and "shift" a mm, limits by their settings' names a mm, degree or whole panel's length. Empty where
            not everything is held.
        seam_prices: the same for one mm more of the gap, or of all its parts, at each seam alone; empty likewise.
        seconds: time of the fit, without the baselines.
        parts: the results of components that no seam connects, each fitted by itself; none where there is only one.
    """

    reference: Reference
    settings: FitSettings
    shapes: tuple[Panel, ...]
    measures: Measures
    unknowns: Array
    baselines: HeldAgainst
    tolerance_met: bool
    starts: int
    agreed: int
    iterations: int
    stopped: Stop
    outcomes: tuple[Outcome, ...]
    prices: Mapping[str, float]
    seam_prices: tuple[float, ...]
    seconds: float
    parts: tuple[FitResult, ...] = ()

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
        return panel_named(name, self.shapes)

    def __getitem__(self, name: str) -> Panel:
        return self.shape(name)

    def __contains__(self, panel: object) -> bool:
        return holds(panel, self.shapes)

    def __len__(self) -> int:
        return len(self.shapes)

    def __iter__(self) -> Iterator[Panel]:
        return iter(self.shapes)

    def __repr__(self) -> str:
        held = "everything held" if self.tolerance_met else "a tolerance missed"
        return (
            f"<FitResult of '{self.reference.source}': {len(self)} panels, {held}, "
            f"gaps up to {self.measures.max_seam_gap:.2f} mm, RMS deviation {self.measures.overall_rms:.2f} mm>"
        )

    def own_joints(self) -> dict[int, float]:
        """Clear widths of the joints of single seams that rules ask for, by their places, mm."""
        if self.settings.rules is None:
            return {}
        return self.settings.rules.joints([shape.name for shape in self.shapes], self.measures.seam_panels)

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
        broken = [outcome for outcome in self.outcomes if not outcome.kept]
        if broken and keeps_limits(m, self.settings):
            return "; ".join(map(_broken, broken))
        holds = self._would_hold() if missed else ""
        limit, most = max(limits_of(self.settings), key=lambda one: float(one[0].excess(m, one[1]).max()))
        panel = int(np.argmax(limit.excess(m, most)))
        if not limit.kept(m, most)[panel]:
            value, length = float(limit.measure(m)[panel]), float(m.lengths[panel])
            missed.append(limit.missed(self.reference.panels[panel].name, value, most, length))
        else:
            limit = _GIVES_WAY_FIRST
        # Where both are missed by far, no wider limit helps: the feature cannot follow.
        larger = f"allow a larger gap{holds if len(missed) == 1 else ''} or {limit.remedy}"
        advice = ("choose another feature, " if len(missed) > 1 else "") + larger
        return "; ".join([", and ".join(missed), advice, *map(_broken, broken)])

    def _would_hold(self) -> str:
        """What of gaps, a little wider than they came out, another run holds: this result does."""
        found = {what: float(self.measures.gaps[what].max()) for what in self.settings.gaps}
        room = _ROOM if len(found) == 1 else _ROOM_OF_PARTS
        wider = [
            f"{_OPTIONS[what]} {_above(found[what], room)}"
            for what, most in self.settings.gaps.items()
            if found[what] > most
        ]
        return f" ({' '.join(wider)} would hold)" if wider else ""

    def _leaning(self, seam: int) -> str:
        """What to say of a seam whose flanges, fitted alone, meet in lines that lean too far from it."""
        met = self.reference.seams[seam]
        first, second = (self.local.shapes[i] for i in met.panels)
        most = float(np.degrees(leans(first, second, met)).max(initial=0.0))
        if most <= self.settings.seam_turn:
            return ""
        return (
            f" (flanges fitted alone meet there in a line that leans by {most:.0f} degrees from the seam, where "
            f"{self.settings.seam_turn:g} are allowed)"
        )

    def _missed_gaps(self) -> list[str]:
        """What to say of the seam that exceeds most what is allowed of gaps or of one of their parts, if one does."""
        gaps, names = self.measures.gaps, [panel.name for panel in self.reference.panels]
        asked = self.settings.gaps_of(names, self.measures.seam_panels)
        over = {what: gaps[what] / most for what, most in asked.items()}
        what = max(over, key=lambda one: float(over[one].max(initial=0.0)))
        if over[what].max(initial=0.0) <= 1.0:
            return []
        worst = int(over[what].argmax())
        a, b = (names[i] for i in self.reference.seams[worst].panels)
        of = gaps[what][worst]
        allowed = f"{of / over[what][worst]:.6g} mm"
        said = _OF_GAPS[what].format(allowed=allowed, seam=f"the seam between '{a}' and '{b}'", found=f"{of:.2f} mm")
        return [said + self._leaning(worst)]
