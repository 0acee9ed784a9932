"""What a point is worth under barriers, by component, and how far a step is taken: wherever it does no harm."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from cadpanel.arrays import Array, BoolArray
from cadpanel.solver.barrier import Barriers
from cadpanel.solver.components import Components
from cadpanel.solver.ended import Best
from cadpanel.solver.held_model import HeldModel, Point
from cadpanel.solver.held_rows import HeldRows, Rowed

# Steps that keep less than this share of their promise have failed; promises below the second share of the cost are
# rounding.
_HARMFUL, _ROUNDING = 1e-3, 1e-9


class Place(NamedTuple):
    """A problem at some unknowns, and its held vectors in a row."""

    point: Point
    at: Rowed


class Taken(NamedTuple):
    """Where a step led.

    Attributes:
        place: there.
        blocks: (count,) which blocks moved.
        gain: (components,) the share of its promise that the step kept.
        failed: (components,) where it did not fall.
    """

    place: Place
    blocks: BoolArray
    gain: Array
    failed: BoolArray


class Merit:
    """The cost with all penalties of what is held, and what else a point is judged by."""

    def __init__(self, model: HeldModel, blocks: Components, held: HeldRows) -> None:
        """`held` has the model's held vectors."""
        self._model, self._blocks, self._held = model, blocks, held
        self._of, self._weights = blocks.seen_by(held.first), held.weights()
        self._firm, self._giving = np.flatnonzero(~held.gives_way), np.flatnonzero(held.gives_way)
        self._of_firm, self._of_giving = (self._of.seen_by(which) for which in (self._firm, self._giving))

    def at(self, unknowns: Array) -> Place:
        """The problem at unknowns (count, size)."""
        point = self._model.at(unknowns)
        return Place(point, self._held.measured(point.vectors))

    def penalized(self, place: Place, barriers: Barriers, mu: Array) -> Array:
        """(count,) the cost with all penalties; `mu` (components,) is the barrier's parameter."""
        return self._penalized(place.point.cost, place.at, barriers, mu)

    def _penalized(self, cost: Array, at: Rowed, barriers: Barriers, mu: Array) -> Array:
        half = 0.5 * barriers.cost(at, mu[self._of.label])
        merit = cost.copy()
        for blocks in (self._held.first, self._held.second):
            merit += np.bincount(blocks, half, minlength=len(merit))
        return merit

    def free_cost(self, place: Place) -> Array:
        """(components,) the cost without penalties."""
        cost = self._blocks.total(place.point.cost)
        return np.asarray(cost + 0.5 * self._of.total(self._weights * place.at.squares))

    def worth(self, place: Place, barriers: Barriers) -> Best:
        """What the point is worth beside others."""
        beyond = barriers.violation(place.at)
        firm, excess = self._of_firm.largest(beyond[self._firm]), self._of_giving.largest(beyond[self._giving])
        return Best(place.point.unknowns, firm, excess, self._blocks.total(place.point.cost))

    def take(
        self,
        place: Place,
        step: Array,
        promised: Array,
        *,
        barriers: Barriers,
        mu: Array,
        goes_on: BoolArray,
        least: Array,
    ) -> Taken:
        """Go where a step leads, wherever it does no harm.

        Args:
            place: from where.
            step: (count, size); blocks that do not move at all stay where they are to the last digit.
            promised: (count,) by how much the step was to lower the penalized cost.
            barriers: of the held vectors.
            mu: (components,) their parameter.
            goes_on: (components,) which ones move.
            least: (components,) costs below which nothing is left to gain.
        """
        pattern, total = self._model.pattern, self._blocks.total
        point, before = place.point, self.penalized(place, barriers, mu)

        with np.errstate(all="ignore"):
            moved = self._model.bounds.clip(point.unknowns + step)
            ahead = self.at(np.where(step == 0.0, point.unknowns, moved))
            after = _finite(self.penalized(ahead, barriers, mu))
        hoped, was = total(promised), total(before)
        gain = (was - total(after)) / np.maximum(np.abs(hoped), 1e-300)
        gain = np.where(np.abs(hoped) <= _ROUNDING * total(point.cost) + least, 1.0, gain)
        failed = ~(gain > _HARMFUL) & goes_on
        taken = np.ones(pattern.count, dtype=bool)
        if failed.any():
            harm = ~(pattern.around(before) - pattern.around(after) > 0.0)
            taken = ~(failed[pattern.component] & harm)
            partly = np.where(taken[:, None], ahead.point.unknowns, point.unknowns)
            if taken.any():
                # Mostly this does no good either, and how things change there is of no use.
                with np.errstate(all="ignore"):
                    cost, vectors = self._model.cost(partly)
                    after = _finite(self._penalized(cost, self._held.measured(vectors), barriers, mu))
                stuck = failed & ~(total(after) < was)
                taken &= ~stuck[pattern.component]
                partly = np.where(taken[:, None], partly, point.unknowns)
            with np.errstate(all="ignore"):
                ahead = self.at(partly) if taken.any() else place
        return Taken(ahead, taken, gain, failed)


def _finite(merit: Array) -> Array:
    """The same, infinite where it is no number."""
    return np.where(np.isfinite(merit), merit, np.inf)
