"""The smallest deviation at which seams, drifts and what the shop can make keep to their limits."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from cadpanel.arrays import Array, BoolArray
from cadpanel.fitting.measures.edges import PanelEdges
from cadpanel.fitting.measures.seams import AlongSeams, along_seams
from cadpanel.fitting.methods.method import Progress, SeamsMet
from cadpanel.fitting.objective import HeldObjective
from cadpanel.fitting.problem import Problem, SeamTerm
from cadpanel.fitting.settings import FitSettings
from cadpanel.fitting.shapes import panel_shapes
from cadpanel.solver.components import Components
from cadpanel.solver.ended import Limits
from cadpanel.solver.giving_way import IDLE, Elsewhere, HeldSolution, hold_or_give_way
from cadpanel.solver.stop import Stop
from cadpanel.terms.arc_gap import ArcGap
from cadpanel.terms.corner_gap import CornerGap
from cadpanel.terms.edge_gap import MixedGap
from cadpanel.terms.limits.kink import Kink, KinkTerm
from cadpanel.terms.outermost_gap import OutermostGap
from cadpanel.terms.parted_gap import PartedGap
from cadpanel.terms.parts import PARTS
from cadpanel.terms.seams import SeamBatch, ends_of
from cadpanel.terms.state import State
from cadpanel.terms.term import HeldTerm

GapTerm = SeamTerm | PartedGap

# Gaps and drifts are held a little inside what the user allows, so that rounding in a file cannot break the promise.
MARGIN = 1e-3
# No gap is closed at an RMS deviation beyond this multiple of the local fits', or this share of a panel's length where
# the local fits are nearly exact: what comes then is no approximation of the reference any more.
_MOST_MULTIPLE = 5.0
_MOST_SHARE = 0.05
# Between the points that are held, arcs part a little further: they are held at this share of the tolerance.
_ARC_SHARE = 0.82
# Where seams part still further they are held at a smaller one, such that they come to this share of it.
_AIM = 0.99
# Where only what panels must keep to is held, hardly anything binds: the share that damps steps at least.
_LEAST_DAMPING = 1e-3
# A panel that deviates by no more than this share of its length, RMS, is exact.
EXACT = 1e-8


def seam_terms(problem: Problem, tolerance: float) -> list[SeamTerm]:
    """Everything that holds seams within `tolerance` mm."""
    return [*problem.corner_gaps(tolerance), *problem.curve_gaps(tolerance)]


def gap_terms(problem: Problem, gaps: Mapping[str, float | Array], state: State) -> list[GapTerm]:
    """Everything that holds gaps, and their parts, within what is allowed (mm, see `FitSettings.gaps`).

    Args:
        problem: the panels.
        gaps: what is allowed, of every seam (seams,) or one for all.
        state: in whose seams' directions parts are looked at.
    """
    asked = gaps.get("gap", 0.0)
    whole = float(np.max(asked))
    terms: list[GapTerm] = [*seam_terms(problem, whole)] if whole else []
    for term in terms:
        term.hold.weight[:] = 0.0
        if isinstance(asked, np.ndarray):
            term.hold.tighten(asked[term.seams.index] / whole)
        if isinstance(term, ArcGap):
            term.straighten(state)
            term.hold.radius = _ARC_SHARE * term.hold.radius
    parts = {part: gaps[part] / problem.place.length for part in PARTS if part in gaps}

    def own(batch: SeamBatch) -> dict[str, float | Array]:
        return {part: most[batch.index] if isinstance(most, np.ndarray) else most for part, most in parts.items()}

    for batch in ends_of(problem.seams) if parts else ():
        ends = OutermostGap(batch, problem.place, problem.layout, tolerance=1.0)
        terms.append(PartedGap(ends, state, own(batch)))
    for batch in problem.seams if set(parts) & set(PARTS[: MixedGap.parts]) else ():
        if not (batch.straight(0) and batch.straight(1)):
            between = MixedGap(batch, problem.place, problem.layout, tolerance=1.0)
            terms.append(PartedGap(between, state, own(batch), share=_ARC_SHARE))
    return terms


def seams_met(problem: Problem, unknowns: Array) -> SeamsMet:
    """Measure along whole seams."""
    shapes = panel_shapes(problem, unknowns)
    edges = PanelEdges.of(shapes)
    return SeamsMet(unknowns, shapes, edges, along_seams(edges, problem.met))


def seam_excess(problem: Problem, unknowns: Array, settings: FitSettings) -> dict[str, Array]:
    """(seams,) what is measured along seams, of gaps, their parts and kinks, over what is allowed."""
    return excess_along(problem, seams_met(problem, unknowns).along, settings)


def excess_along(problem: Problem, met: AlongSeams, settings: FitSettings) -> dict[str, Array]:
    """The same of what was measured already."""
    measured = {"gap": met.gap, "width": met.width, "step": met.step, "shift": met.shift}
    excess = {what: measured[what] / most for what, most in problem.gaps(settings).items()}
    return excess | {Kink.name: np.degrees(met.kink) / settings.max_kink}


def tighten(terms: Sequence[HeldTerm], state: State, excess: Mapping[str, Array]) -> None:
    """Hold the seams that are measured to exceed what is allowed more tightly, looking at them where they are now.

    Args:
        terms: those of `gap_terms` and of limits; what is measured at corners alone stays as it is held.
        state: where.
        excess: (seams,) what was measured along seams over what is allowed, of the gap, its parts and kinks.
    """
    shares = {what: np.where(over > 1.0, _AIM / np.maximum(over, 1.0), 1.0) for what, over in excess.items()}
    look_again(terms, state)
    for term in terms:
        if isinstance(term, PartedGap):
            term.hold.tighten(np.min([shares[part] for part in term.parts], axis=0)[term.seams.index])
        elif isinstance(term, KinkTerm):
            term.hold.tighten(shares[Kink.name][term.seams.index])
        elif isinstance(term, CornerGap | ArcGap | MixedGap):
            term.hold.tighten(shares["gap"][term.seams.index])


def look_again(terms: Sequence[HeldTerm], state: State) -> None:
    """Look at seams as they run in a state from now on."""
    for term in terms:
        if isinstance(term, PartedGap | ArcGap):
            term.straighten(state)


def prices(
    problem: Problem, named: Sequence[tuple[str, HeldTerm]], found: HeldSolution, allowed: Mapping[str, float]
) -> tuple[dict[str, float], Array]:
    """By how much the RMS deviation, mm, would fall for one unit more of each thing that is held, to first order.

    A multiplier w is the weight of |v|^2 / 2 that holds the vector v at its distance r: where all distances grow by a
    share, the cost falls by the sum of all w r^2 times that share (the envelope theorem).

    Args:
        problem: the panels.
        named: what was held, in the order of the solution's multipliers, each with the name of what it holds.
        found: where it ended.
        allowed: of each name, in the units in which it is asked for.

    Returns:
        the falls by their names, and (seams,) those for one mm more of the gap, or of all its parts, at one seam alone.
    """
    state = problem.state(found.unknowns)
    rms = problem.rms(problem.deviation.cost(state))
    pulls: dict[str, float] = defaultdict(float)
    seams = np.zeros(len(problem.met))
    for (name, term), weight in zip(named, found.end.multipliers, strict=True):
        weight = problem.areas[term.blocks[0]][:, None] * weight
        if isinstance(term, PartedGap):  # each part by its share of |v|^2
            for part, lengths in zip(term.parts, np.moveaxis(term.vectors(state), 2, 0), strict=True):
                pull = weight * lengths**2
                pulls[part] += float(np.sum(pull))
                seams[term.seams.index] += pull.sum(axis=1) / allowed.get(part, np.inf)
        elif not term.hold.one_sided:
            pull = weight * term.hold.radius**2
            pulls[name] += float(np.sum(pull))
            if name == "gap" and isinstance(term, CornerGap | ArcGap | MixedGap):
                seams[term.seams.index] += pull.sum(axis=1) / allowed["gap"]
    if rms <= EXACT:
        return dict.fromkeys(allowed, 0.0), np.zeros(len(seams))
    scale = problem.place.length / (problem.panels * rms)
    return {name: scale * pulls[name] / most for name, most in allowed.items()}, scale * seams


def held_within(
    problem: Problem,
    model: HeldObjective,
    start: Array,
    *,
    local: Array,
    only: BoolArray | None = None,
    after: HeldSolution | None = None,
    tell: Progress | None = None,
    elsewhere: Elsewhere | None = None,
    costly: bool = True,
) -> HeldSolution:
    """Hold every held term within its tolerance, at the smallest deviation.

    Args:
        problem: the panels.
        model: what is to be small, and what is held.
        start: (panels, size) unknowns to begin from.
        local: (panels, size) the local fits; no result may deviate beyond a multiple of theirs.
        only: (components,) which connected components are to be gone on with; all where it is None.
        after: a solution with slightly other tolerances to go on from.
        elsewhere: see `solver.giving_way`.
        costly: whether a deviation may be too large for any tolerance; not where only what panels must keep to is held.
        tell: told the step, the largest excess over a tolerance, and the RMS deviation in mm; whether to go on.
    """
    lengths = _lengths(model)
    most = most_cost(problem, model, local) if costly else np.inf

    def told(step: int, excess: float, cost: Array) -> bool:
        return tell is None or tell(step, excess, problem.rms(cost) * problem.place.length)

    begin = model.starting_from(start)
    limits = Limits(least_cost=lengths * EXACT**2)
    if not costly:
        limits = replace(limits, idle=IDLE, least_damping=_LEAST_DAMPING)
    return hold_or_give_way(
        model, begin, limits, most_cost=most, only=only, after=after, elsewhere=elsewhere, tell=told
    )


def most_cost(problem: Problem, model: HeldObjective, local: Array) -> Array:
    """(components,) the cost of a deviation beyond which nothing is an approximation, of local fits (panels, size)."""
    alone = Components.of(model.pattern).total(problem.deviation.cost(problem.state(local)))
    return np.maximum(_MOST_MULTIPLE**2 * alone, _lengths(model) * _MOST_SHARE**2)


def _lengths(model: HeldObjective) -> Array:
    """(components,) half the squares of all panels' lengths: shares of a length count against them."""
    return 0.5 * Components.of(model.pattern).total(model.lengths**2)


def stopped_as(found: HeldSolution) -> Stop:
    """Why all of it stopped: as what exceeds its tolerance most, or else as whatever did not come to rest."""
    if (found.excess > 1.0).any():
        return found.stopped[int(found.excess.argmax())]
    return next((stop for stop in found.stopped if stop is not Stop.HELD), Stop.HELD)
