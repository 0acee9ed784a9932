"""The ways that the interior point takes through a few problems, step by step, as they were kept.

How fast distances narrow, how damping follows gains, when the barrier falls: many such rules lead to the same end, some
of them slower. A change of any is to be seen, and to be meant.

    python -m tests.solver.kept_ways          # how far the ways are from those that were kept
    python -m tests.solver.kept_ways --write  # keep them as they are now
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

import numpy as np

from cadpanel.arrays import Array
from cadpanel.solver.ended import Limits
from cadpanel.solver.hold import Hold
from cadpanel.solver.interior_point import interior_point
from tests.solver.models import HeldBatch, HeldTargets, held_chain, held_points

# Rounding grows along a way; so far it is nothing.
STEPS = 20
KEPT = Path(__file__).with_name("kept_ways.json")


def models() -> dict[str, HeldTargets]:
    """What is solved."""
    random = np.random.default_rng(11)
    chain = held_chain(random.normal(size=(12, 2)), 0.05)
    points = held_points(2.0 * random.normal(size=(5, 3)), random.normal(size=(5, 3)), random.uniform(0.1, 1.0, 5))
    torn = held_chain(np.array([[-3.0, 0.0], [0.0, 1.0], [3.0, 0.0]]), 0.5)
    ends = Hold(np.array([[0.5], [0.5]]), weight=0.1)
    torn.held += (HeldBatch(ends, np.array([[[-3.0, 0.0]], [[3.0, 0.0]]]), (np.array([0, 2]),)),)
    below = Hold(np.full((12, 1), 0.2), weight=1.0, one_sided=True, scale=np.full((12, 1), 2.0))
    level = held_chain(random.normal(size=(12, 1)), 0.3)
    level.held += (HeldBatch(below, np.zeros((12, 1, 1)), (np.arange(12),)),)
    return {"a chain": chain, "points alone": points, "a chain too short": torn, "a chain below a level": level}


def ways() -> dict[str, list[list[float]]]:
    """For each model and each step the largest excess and the cost."""
    found = {}
    for name, model in models().items():
        told: list[list[float]] = []

        def tell(_step: int, excess: float, cost: Array, told: list[list[float]] = told) -> bool:
            told.append([excess, float(cost.sum())])
            return True

        interior_point(model, model.targets.copy(), Limits(steps=STEPS), tell=tell)
        found[name] = told
    return found


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
