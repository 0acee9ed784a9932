"""Panels brought back to what they may do: drifts and what the shop can make, whatever their gaps.

These limits are each panel's own, so each is brought back by itself. Where it begins decides whether it gets there, and
how far it then deviates: from several beginnings, and from the place nearest to the outline that each leads to, the
least deviation is looked for that keeps every limit.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence

import numpy as np

from cadpanel.arrays import Array, BoolArray, IntArray
from cadpanel.fitting.methods.holding import EXACT, MARGIN
from cadpanel.fitting.objective import HeldObjective, Objective
from cadpanel.fitting.problem import Problem
from cadpanel.fitting.settings import FitSettings
from cadpanel.solver.components import Components
from cadpanel.solver.ended import Best, Limits
from cadpanel.solver.interior_point import interior_point
from cadpanel.solver.levenberg_marquardt import Stopping, levenberg_marquardt
from cadpanel.terms.term import HeldTerm

# What exceeds a limit by less keeps it.
_KEPT = 1.0 + 1e-6
_NEAREST = Stopping(cost=1e-6, iterations=60)


def restored(
    problem: Problem,
    settings: FitSettings,
    panels: IntArray,
    starts: Sequence[Array],
    but: Collection[str] = (),
) -> tuple[Array, int]:
    """The least deviation of some panels that keeps every limit, or whatever comes nearest to keeping them.

    Args:
        problem: all panels.
        settings: their limits.
        panels: (n,) those that are brought back.
        starts: unknowns (panels, size) of all panels to begin from.
        but: names of limits that do not count.

    Returns:
        unknowns (panels, size) of all panels, those of all others from the first start; and linear systems solved.
    """
    part = problem.take(panels)
    begun = [start[panels, : part.layout.size] for start in starts]
    held, weighed = (
        [term for name, term in part.named_limits(settings, MARGIN) if name not in but] for _ in ("held", "weighed")
    )
    nearest = [_nearest(part, weighed, start) for start in begun]
    model = HeldObjective(part, [part.deviation], held)
    limits = Limits(least_cost=0.5 * part.lengths**2 * EXACT**2)
    blocks, steps = Components.of(model.pattern), sum(count for _, count in nearest)
    kept: Best | None = None
    for start in (*begun, *(unknowns for unknowns, _ in nearest)):
        end = interior_point(model, start, limits)
        steps += end.steps
        kept = end.best if kept is None else kept.mixed(end.best, _cheaper(kept, end.best), blocks)
    unknowns = starts[0].copy()
    if kept is not None:
        unknowns[panels, : part.layout.size] = kept.unknowns
    return unknowns, steps


def _cheaper(one: Best, other: Best) -> BoolArray:
    """(panels,) where the other is nearer to keeping every limit, or keeps them at less deviation."""
    mine, its = (np.maximum(best.firm, _KEPT) for best in (one, other))
    return np.asarray((its < mine) | ((its == mine) & (other.cost < one.cost)))


def _nearest(part: Problem, limits: Sequence[HeldTerm], start: Array) -> tuple[Array, int]:
    """Unknowns near which as little as can be is used up of every limit, whatever the deviation; and steps."""
    for limit in limits:
        limit.hold.weight = (part.lengths[limit.blocks[0]][:, None] / limit.hold.radius) ** 2
    solution = levenberg_marquardt(Objective(part, [part.deviation, *limits], coupled=False), start, _NEAREST)
    return solution.unknowns, solution.iterations
