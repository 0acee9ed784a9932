"""Kinks that cannot be held: as small as they become while gaps are held, where that is nearer to what is asked for.

Distances that give way are widened by one factor, and kinks are held at points of a seam alone: what ends at 1.3 times
its gaps and kinks there may have more between them. A kink that costs gaps and comes out larger than without a
limit helps nobody. Where kinks are not held, fits are tried in which they may be larger and gaps not, and whatever
exceeds least what is asked for, measured along whole seams, is kept.
"""

from __future__ import annotations

import numpy as np

from cadpanel.arrays import Array, BoolArray
from cadpanel.fitting.methods.holding import seam_excess
from cadpanel.fitting.objective import HeldObjective
from cadpanel.fitting.problem import Problem
from cadpanel.fitting.settings import FitSettings
from cadpanel.solver.components import Components
from cadpanel.solver.ended import Limits
from cadpanel.solver.giving_way import HeldSolution
from cadpanel.solver.interior_point import interior_point
from cadpanel.solver.stop import Stop
from cadpanel.terms.limits.kink import KinkTerm

# Fits tried, of so many steps each; the first one holds no kinks.
_TRIES, _STEPS = 3, 80
_ANY = 1e4
# Exceeds what must be held beyond rounding.
_FIRM = 1.0 + 1e-5


def less_kinked(
    problem: Problem, model: HeldObjective, found: HeldSolution, settings: FitSettings, where: BoolArray
) -> HeldSolution:
    """The same, or what comes nearer to what is asked for in some connected components, in which kinks are not held.

    Args:
        problem: the panels.
        model: what is held; gaps and kinks at the distances that are asked for.
        found: what the search for what gives way ended with.
        settings: what is asked for.
        where: (components,) which components.
    """
    blocks = Components.of(model.pattern)
    terms = [term for term in model.held if isinstance(term, KinkTerm)]
    asked = [term.hold.radius for term in terms]
    kept, reached = found.unknowns, _largest(problem, found.unknowns, settings, blocks)
    wider, steps = np.full(blocks.count, _ANY), 0
    least = np.ones(blocks.count)
    better = np.zeros(blocks.count, dtype=bool)
    for _ in range(_TRIES):
        for term, radius in zip(terms, asked, strict=True):
            term.hold.radius = radius * wider[blocks.label[term.blocks[0]]][:, None]
        end = interior_point(model, model.starting_from(kept), Limits(steps=_STEPS), only=where)
        steps += end.steps
        now = _largest(problem, end.best.unknowns, settings, blocks)
        nearer = where & (end.best.firm <= _FIRM) & (now < reached)
        better |= nearer
        kept = np.where(blocks.each(nearer), end.best.unknowns, kept)
        reached = np.where(nearer, now, reached)
        least = np.where(nearer, least, np.maximum(least, np.minimum(wider, reached)))
        wider = np.sqrt(least * np.maximum(reached, least))
    for term, radius in zip(terms, asked, strict=True):
        term.hold.radius = radius
    # As it is beside what is asked for.
    end = interior_point(model, kept, Limits(steps=0))
    told = HeldSolution(end, (Stop.STALLED,) * blocks.count, steps)
    return found.mixed(told, better, blocks)


def _largest(problem: Problem, unknowns: Array, settings: FitSettings, blocks: Components) -> Array:
    """(components,) the largest excess along seams."""
    seams = blocks.seen_by(np.array([seam.panels[0] for seam in problem.met], dtype=np.intp))
    largest: Array = np.max([seams.largest(over) for over in seam_excess(problem, unknowns, settings).values()], axis=0)
    return largest
