"""Kinks that cannot be held: as small as they become while gaps are held, where that is nearer to what is asked for.

Distances that give way are widened by one factor, and kinks are held at points of a seam alone: what ends at 1.3 times
its gaps and kinks there may have more between them. A kink that costs gaps and comes out larger than without a
limit helps nobody. Where kinks are not held, fits are tried in which they may be larger and gaps not; where these do
not hold either, the least that gaps leave is looked for, from the same start and by the same steps whatever was asked
for: so who asks for less than that gets it, and who asks for more does not get more than he asked. Whatever exceeds
least what is asked for, measured along whole seams, is kept.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager

import numpy as np

from cadpanel.arrays import Array, BoolArray
from cadpanel.fitting.methods.holding import EXACT, look_again, most_cost, seam_excess
from cadpanel.fitting.objective import HeldObjective
from cadpanel.fitting.problem import Problem
from cadpanel.fitting.settings import FitSettings
from cadpanel.solver.components import Components
from cadpanel.solver.ended import Limits
from cadpanel.solver.giving_way import HeldSolution, hold_or_give_way
from cadpanel.solver.interior_point import interior_point
from cadpanel.solver.stop import Stop
from cadpanel.terms.limits.kink import KinkTerm

# Fits tried, of so many steps each; the first one holds no kinks.
_TRIES, _STEPS = 3, 80
_ANY = 1e4
# Exceeds what must be held beyond rounding.
_FIRM = 1.0 + 1e-5
# Nobody asks for less than this share of a kink that somebody asks for: the least there is is looked for.
_LEAST = 1e-3


def less_kinked(
    problem: Problem,
    model: HeldObjective,
    found: HeldSolution,
    start: Array,
    asked: Sequence[Array],
    local: Array,
    settings: FitSettings,
    where: BoolArray,
) -> HeldSolution:
    """The same, or what comes nearer to what is asked for in some connected components, in which kinks are not held.

    Args:
        problem: the panels.
        model: what is held, as tightly as `found` left it.
        found: what the search for what gives way ended with.
        start: (panels, size) unknowns to begin with; they do not hang on the kink that is asked for.
        asked: the distances of what is held as they were before anything was tightened.
        local: (panels, size) the local fits; no kink is worth a deviation beyond a multiple of theirs.
        settings: what is asked for.
        where: (components,) which components.
    """
    blocks, most = Components.of(model.pattern), most_cost(problem, model, local)
    kept, reached, steps = _tried_wider(problem, model, found, most, settings, where)
    searched = where & (reached > 1.0)
    if searched.any():
        none = Limits(steps=0, least_cost=0.5 * blocks.total(model.lengths**2) * EXACT**2)
        with _kinks_alone_give_way(problem, model, asked, start, found.unknowns):
            search = hold_or_give_way(model, model.starting_from(start), none, most_cost=most, only=searched)
        now, steps = _largest(problem, search.unknowns, settings, blocks), steps + search.iterations
        nearer = searched & (search.end.best.firm <= _FIRM) & (search.end.best.cost <= most) & (now < reached)
        kept, reached = np.where(blocks.each(nearer), search.unknowns, kept), np.where(nearer, now, reached)
    better = where & (reached < _largest(problem, found.unknowns, settings, blocks))
    # As it is beside what is held.
    end = interior_point(model, kept, Limits(steps=0))
    told = HeldSolution(end, (Stop.STALLED,) * blocks.count, steps)
    return found.mixed(told, better, blocks)


def _tried_wider(
    problem: Problem,
    model: HeldObjective,
    found: HeldSolution,
    most: Array,
    settings: FitSettings,
    where: BoolArray,
) -> tuple[Array, Array, int]:
    """Go on from what was found with kinks that may be larger: unknowns, (components,) their excess, and steps."""
    blocks = Components.of(model.pattern)
    terms = [term for term in model.held if isinstance(term, KinkTerm)]
    radii = [term.hold.radius for term in terms]
    kept, reached = found.unknowns, _largest(problem, found.unknowns, settings, blocks)
    wider, least, steps = np.full(blocks.count, _ANY), np.ones(blocks.count), 0
    for _ in range(_TRIES):
        for term, radius in zip(terms, radii, strict=True):
            term.hold.radius = radius * wider[blocks.label[term.blocks[0]]][:, None]
        end = interior_point(model, model.starting_from(kept), Limits(steps=_STEPS), only=where)
        steps += end.steps
        now = _largest(problem, end.best.unknowns, settings, blocks)
        nearer = where & (end.best.firm <= _FIRM) & (end.best.cost <= most) & (now < reached)
        kept = np.where(blocks.each(nearer), end.best.unknowns, kept)
        reached = np.where(nearer, now, reached)
        least = np.where(nearer, least, np.maximum(least, np.minimum(wider, reached)))
        wider = np.sqrt(least * np.maximum(reached, least))
    for term, radius in zip(terms, radii, strict=True):
        term.hold.radius = radius
    return kept, reached, steps


@contextmanager
def _kinks_alone_give_way(
    problem: Problem, model: HeldObjective, asked: Sequence[Array], start: Array, now: Array
) -> Iterator[None]:
    """Gaps, and whatever else may give way, must hold as it was asked for at the start, and kinks be none."""
    before = [(term.hold, term.hold.radius, term.hold.gives_way) for term in model.held]
    for term, radius in zip(model.held, asked, strict=True):
        kink = isinstance(term, KinkTerm)
        term.hold.radius, term.hold.gives_way = _LEAST * radius if kink else radius, kink
    look_again(model.held, problem.state(start))
    try:
        yield
    finally:
        for hold, radius, gives_way in before:
            hold.radius, hold.gives_way = radius, gives_way
        look_again(model.held, problem.state(now))


def _largest(problem: Problem, unknowns: Array, settings: FitSettings, blocks: Components) -> Array:
    """(components,) the largest excess along seams."""
    seams = blocks.seen_by(np.array([seam.panels[0] for seam in problem.met], dtype=np.intp))
    largest: Array = np.max([seams.largest(over) for over in seam_excess(problem, unknowns, settings).values()], axis=0)
    return largest
