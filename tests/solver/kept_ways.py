"""The ways that the interior point takes through a few problems, step by step, as they were kept.

How fast distances narrow, how damping follows gains, when the barrier falls: many such rules lead to the same end, some
of them slower. A change of any is to be seen, and to be meant.

    python -m tests.solver.kept_ways          # how far the ways are from those that were kept
    python -m tests.solver.kept_ways --write  # keep them as they are now
"""

from __future__ import annotations

import json
import sys
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from cadpanel.arrays import Array
from cadpanel.solver.ended import Limits
from cadpanel.solver.giving_way import hold_or_give_way
from cadpanel.solver.held_model import Point
from cadpanel.solver.hold import Hold
from cadpanel.solver.interior_point import interior_point
from cadpanel.solver.stop import Stop
from tests.solver.models import HeldBatch, HeldTargets, held_chain, held_points

# Rounding grows along a way; so far it is nothing.
STEPS = 20
KEPT = Path(__file__).with_name("kept_ways.json")


class Curved(HeldBatch):
    """Points (x, y - x^2) of single ones, less an offset: steps that keep to them bend."""

    def vectors(self, unknowns: Array) -> Array:
        """(points, 1, 2)."""
        x, y = unknowns[self.blocks[0]].T
        return np.stack([x, y - x**2], axis=1)[:, None] - self.offset

    def slopes(self, unknowns: Array) -> tuple[Array, ...]:
        """(points, 1, 2, 2)."""
        slopes = np.tile(np.eye(2), (len(self.blocks[0]), 1, 1))
        slopes[:, 1, 0] = -2.0 * unknowns[self.blocks[0], 0]
        return (slopes[:, None],)


class CurvedTargets(HeldTargets):
    """Points that want to be somewhere and are held along a parabola; the second number of each counts as an angle."""

    def __init__(self, targets: Array, held: Sequence[HeldBatch], length: float) -> None:
        super().__init__(targets, held)
        self.lengths, self.powers = np.full(len(targets), length), np.tile([1.0, 0.0], (len(targets), 1))

    def at(self, unknowns: Array) -> Point:
        """See `solver.HeldModel.at`."""
        point = super().at(unknowns)
        slopes = tuple(one.slopes(unknowns) if isinstance(one, Curved) else one.jacobians() for one in self.held)
        return replace(point, jacobians=slopes)


@dataclass(frozen=True)
class Way:
    """A model, and how it is solved: see `interior_point`; `again` from its end, with distances a little narrower.

    With a `search` it is what gives way that is looked for, for so much of cost and in so many steps at most.
    """

    model: HeldTargets
    limits: Limits = field(default_factory=lambda: Limits(steps=STEPS))
    ease: float = 1.0
    asked: float = 1.0
    again: bool = False
    search: tuple[float, int] | None = None


def models() -> dict[str, Way]:
    """What is solved."""
    random = np.random.default_rng(11)
    chain = held_chain(random.normal(size=(12, 2)), 0.05)
    points = held_points(2.0 * random.normal(size=(5, 3)), random.normal(size=(5, 3)), random.uniform(0.1, 1.0, 5))
    level = held_chain(random.normal(size=(12, 1)), 0.3)
    below = Hold(np.full((12, 1), 0.2), weight=1.0, one_sided=True, scale=np.full((12, 1), 2.0))
    level.held += (HeldBatch(below, np.zeros((12, 1, 1)), (np.arange(12),)),)
    ways = {
        "a chain": Way(chain),
        "points alone": Way(points),
        "a chain too short": Way(_torn()),
        "a chain below a level": Way(level),
    }
    firm = held_chain(random.normal(size=(5, 2)), 0.2, gives_way=False)
    patient = Limits(steps=STEPS, patience=3)
    one = held_chain(np.array([[-1.0, 0.3], [1.0, 0.0]]), 0.1)
    near = Hold(np.full((2, 1), 0.2), weight=0.0)
    one.held += (HeldBatch(near, one.targets[:, None], (np.arange(2),)),)
    on = Curved(Hold(np.full((3, 1), 0.02), weight=0.0, gives_way=True), np.zeros((3, 1, 2)), (np.arange(3),))
    on.offset[:, 0, 0] = [1.0, 2.0, -1.5]
    along = Curved(Hold(np.full((3, 1), 0.3), weight=0.0), on.offset, (np.arange(3),))
    targets = np.array([[-1.0, 2.0], [0.5, -1.0], [2.0, 3.0]])
    valley = CurvedTargets(1.5 * targets, [on], 2.0)
    both = CurvedTargets(2.0 * targets, [on, along], 0.5)
    return ways | {
        "a chain that must hold": Way(firm, patient),
        "two points of which one must hold": Way(one, Limits(steps=STEPS, patience=100)),
        "a chain too short, patiently": Way(_torn(), patient),
        "a chain too short, widened": Way(_torn(), ease=4.0, asked=0.5),
        "a chain once more": Way(chain, Limits(steps=STEPS, feasibility=0.02, least_cost=0.1), again=True),
        "a point costs too much": Way(_far_off(), search=(0.5, 999)),
        "a point costs too much until told": Way(_far_off(), search=(0.5, 60)),
        "a point between two until told": Way(_between(gives_way=True), search=(np.inf, 120)),
        "a point beside one that must hold until told": Way(_between(gives_way=False), search=(np.inf, 70)),
        "a chain too short is told early": Way(_torn(), search=(np.inf, 4)),
        "a curved valley": Way(valley),
        "a curved valley from far away": Way(both, Limits(steps=2 * STEPS, patience=2)),
    }


def _torn() -> HeldTargets:
    """Three points held to each other, of which two must be where they cannot be held."""
    torn = held_chain(np.array([[-3.0, 0.0], [0.0, 1.0], [3.0, 0.0]]), 0.5)
    ends = Hold(np.array([[0.5], [0.5]]), weight=0.1)
    torn.held += (HeldBatch(ends, np.array([[[-3.0, 0.0]], [[3.0, 0.0]]]), (np.array([0, 2]),)),)
    return torn


def _far_off() -> HeldTargets:
    """A point held within 1 of where it does not want to be, and one by itself that holds."""
    return held_points(np.array([[3.0, 0.0], [0.0, 0.5]]), np.zeros((2, 2)), np.array([1.0, 2.0]))


def _between(*, gives_way: bool) -> HeldTargets:
    """A point that is to be near two others at once, which are further apart; the second may have to hold."""
    one, other = (np.array([[[side, 0.0]]]) for side in (-1.0, 1.2))
    holds = [Hold(np.array([[0.5]]), weight=0.0, gives_way=how) for how in (True, gives_way)]
    model = HeldTargets(
        np.array([[0.1, 0.3]]),
        [HeldBatch(hold, at, (np.arange(1),)) for hold, at in zip(holds, (one, other), strict=True)],
    )
    model.lengths = np.full(1, 2.0)
    return model


def ways() -> dict[str, list[list[float]]]:
    """For each model and each step the largest excess and the cost."""
    found = {}
    for name, way in models().items():
        told: list[list[float]] = []

        def tell(_step: int, excess: float, cost: Array, told: list[list[float]] = told) -> bool:
            told.append([excess, float(cost.sum())])
            return True

        model, start, after = way.model, way.model.targets.copy(), None
        if way.again:
            after = replace(interior_point(model, start, Limits()), damping=np.full(1, 8.0))
            start = after.best.unknowns
            model.held[0].hold.tighten(np.full(len(start) - 1, 0.9))
        if way.search is not None:
            found[name] = _searched(model, way.limits, *way.search)
            continue
        interior_point(model, start, way.limits, ease=way.ease, asked=way.asked, after=after, tell=tell)
        found[name] = told
    return found


def _searched(model: HeldTargets, limits: Limits, most_cost: float, steps: int) -> list[list[float]]:
    """The largest excess and the cost after every tenth step, and in the end, after so many steps."""
    told: list[list[float]] = []

    def tell(_step: int, excess: float, cost: Array) -> bool:
        told.append([excess, float(cost.sum())])
        return len(told) < steps

    end = hold_or_give_way(model, model.targets.copy(), limits, most_cost=most_cost, tell=tell)
    excess = [[float(one), float(end.stopped[0] is Stop.HELD)] for one in end.excess]
    return [*told[9::10], *excess, [float(end.iterations), model.free_cost(end.unknowns)]]


def farthest(now: dict[str, list[list[float]]], kept: dict[str, list[list[float]]]) -> float:
    """The largest difference, relative to the largest number of its way; infinite where steps came or went."""
    if {name: len(way) for name, way in now.items()} != {name: len(way) for name, way in kept.items()}:
        return float("inf")
    return max(
        float((np.abs(np.array(now[name]) - np.array(way)) / (1.0 + np.abs(way).max(axis=0))).max())
        for name, way in kept.items()
    )


def main() -> int:
    """Tell, or keep."""
    if "--write" in sys.argv:
        KEPT.write_text(json.dumps(ways()) + "\n", encoding="utf-8")
        return 0
    kept = json.loads(KEPT.read_text(encoding="utf-8"))
    sys.stdout.write(f"{farthest(ways(), kept)}\n")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
