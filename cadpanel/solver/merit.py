"""What a point is worth under barriers, by component, and how far a step is taken: wherever it does no harm."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from cadpanel.arrays import Array, BoolArray
from cadpanel.solver.barrier import Barrier
from cadpanel.solver.components import Components
from cadpanel.solver.ended import Best
from cadpanel.solver.held_model import HeldModel, Point

# Steps that keep less than this share of their promise have failed; promises below the second share of the cost are
# rounding.
_HARMFUL, _ROUNDING = 1e-3, 1e-9


class Taken(NamedTuple):
    """Where a step led.

    Attributes:
        point: there.
        blocks: (count,) which blocks moved.
        gain: (components,) the share of its promise that the step kept.
        failed: (components,) where it did not fall.
    """

    point: Point
    blocks: BoolArray
    gain: Array
    failed: BoolArray


class Merit:
    """The cost with all penalties of what is held, and what else a point is judged by."""

    def __init__(self, model: HeldModel, blocks: Components, of: Sequence[Components]) -> None:
        """`of` has for each batch of held vectors the components that its groups belong to."""
        self._model, self._blocks, self._of = model, blocks, tuple(of)

    def penalized(self, point: Point, barriers: Sequence[Barrier], mu: Array) -> Array:
        """(count,) the cost with all penalties; `mu` (components,) is the barrier's parameter."""
        merit = point.cost.copy()
        for barrier, of, vectors in zip(barriers, self._of, point.vectors, strict=True):
            share = barrier.cost(vectors, of.each(mu)) / len(barrier.held.blocks)
            for blocks in barrier.held.blocks:
                merit += np.bincount(blocks, share, minlength=len(merit))
        return merit

    def free_cost(self, point: Point) -> Array:
        """(components,) the cost without penalties."""
        cost = self._blocks.total(point.cost)
        for one, of, vectors in zip(self._model.held, self._of, point.vectors, strict=True):
            cost += 0.5 * of.total((one.hold.weight * one.hold.squares(vectors)).sum(axis=1))
        return cost

    def worth(self, point: Point, barriers: Sequence[Barrier]) -> Best:
        """What the point is worth beside others."""
        worst = {False: np.zeros(self._blocks.count), True: np.zeros(self._blocks.count)}
        for barrier, of, vectors in zip(barriers, self._of, point.vectors, strict=True):
            gives = barrier.held.hold.gives_way
            worst[gives] = np.maximum(worst[gives], of.largest(barrier.violation(vectors)))
        return Best(point.unknowns, worst[False], worst[True], self._blocks.total(point.cost))

    def take(
        self,
        point: Point,
        step: Array,
        promised: Array,
        *,
        barriers: Sequence[Barrier],
        mu: Array,
        goes_on: BoolArray,
        least: Array,
    ) -> Taken:
        """Go where a step leads, wherever it does no harm.

        Args:
            point: from where.
            step: (count, size); blocks that do not move at all stay where they are to the last digit.
            promised: (count,) by how much the step was to lower the penalized cost.
            barriers: of the held vectors.
            mu: (components,) their parameter.
            goes_on: (components,) which ones move.
            least: (components,) costs below which nothing is left to gain.
        """
        pattern, total = self._model.pattern, self._blocks.total
        before = self.penalized(point, barriers, mu)

        def tried(unknowns: Array) -> tuple[Point, Array]:
            with np.errstate(all="ignore"):
                ahead = self._model.at(unknowns)
                merit = self.penalized(ahead, barriers, mu)
            return ahead, np.where(np.isfinite(merit), merit, np.inf)

        def part(unknowns: Array, taken: BoolArray) -> tuple[Point, Array]:
            """Where only some blocks moved."""
            if not taken.any():
                return point, before
            return tried(np.where(taken[:, None], unknowns, point.unknowns))

        moved = self._model.bounds.clip(point.unknowns + step)
        ahead, after = tried(np.where(step == 0.0, point.unknowns, moved))
        hoped, was = total(promised), total(before)
        gain = (was - total(after)) / np.maximum(np.abs(hoped), 1e-300)
        gain = np.where(np.abs(hoped) <= _ROUNDING * total(point.cost) + least, 1.0, gain)
        failed = ~(gain > _HARMFUL) & goes_on
        taken = np.ones(pattern.count, dtype=bool)
        if failed.any():
            harm = ~(pattern.around(before) - pattern.around(after) > 0.0)
            taken = ~(failed[pattern.component] & harm)
            ahead, after = part(ahead.unknowns, taken)
            stuck = failed & ~(total(after) < was)
            if (stuck[pattern.component] & taken).any():
                taken &= ~stuck[pattern.component]
                ahead, _ = part(ahead.unknowns, taken)
        return Taken(ahead, taken, gain, failed)
