"""The best minimum of several starts: all run a few steps, those that keep up go on, the winners run to the end.

Where samples follow one surface, one start soon leaves all others behind; where they scatter about a nearly flat one,
many minima are about as good, and then many starts stay in the race.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array, BoolArray, IntArray
from cadpanel.atomic.clouds import Clouds
from cadpanel.atomic.orthogonal import Descent, descend
from cadpanel.atomic.ruling import Rulings, anchored


@dataclass(frozen=True, slots=True)
class _Round:
    """How many steps are taken, and who goes on.

    Attributes:
        steps: at most.
        always: so many of the best of each set.
        ratio: and all whose cost is below so many times the best one's.
        twins: whether of two starts that cost the same only one goes on.
    """

    steps: int
    always: int
    ratio: float
    twins: bool


_ROUNDS = (
    _Round(4, 6, 25.0, twins=True),
    _Round(3, 4, 9.0, twins=False),
    _Round(7, 2, 4.0, twins=False),
    _Round(16, 1, 1.2, twins=False),
)
_LAST_STEPS = 100
# Costs that differ by less than this share are those of one minimum.
_SAME = 1e-7
# Samples worked on together: they and their derivatives stay in the processor's cache.
_SAMPLES = 2_500


def race(
    clouds: Clouds, starts: Callable[[Clouds], list[Rulings]], unknowns: tuple[int, ...]
) -> tuple[Rulings, BoolArray]:
    """The best rulings (n) of all starts and whether they have converged, in the units and axes of the clouds.

    Args:
        clouds: n sets of samples.
        starts: gives several lists of rulings, each the same number for each set, set by set.
        unknowns: what is free (see `ruling`).
    """
    count, samples = clouds.roots.shape
    step = max(1, _SAMPLES // samples)
    parts = []
    for first in range(0, count, step):
        some = clouds.at(slice(first, first + step))
        parts.append(_race(some, joined(starts(some), len(some.points)), unknowns))
    rulings = Rulings(
        points=np.concatenate([part.points for part, _ in parts]),
        frames=np.concatenate([part.frames for part, _ in parts]),
        curvature=np.concatenate([part.curvature for part, _ in parts]),
        taper=np.concatenate([part.taper for part, _ in parts]),
    )
    return rulings, np.concatenate([converged for _, converged in parts])


def joined(lists: list[Rulings], count: int) -> Rulings:
    """Several lists of starts of the same sets as one list, set by set."""

    def together(arrays: list[Array]) -> Array:
        shaped = [array.reshape(count, -1, *array.shape[1:]) for array in arrays]
        return np.concatenate(shaped, axis=1).reshape(-1, *arrays[0].shape[1:])

    return Rulings(
        points=together([part.points for part in lists]),
        frames=together([part.frames for part in lists]),
        curvature=together([part.curvature for part in lists]),
        taper=together([part.taper for part in lists]),
    )


def _race(clouds: Clouds, runners: Rulings, unknowns: tuple[int, ...]) -> tuple[Rulings, BoolArray]:
    count = len(clouds.points)
    owners = np.repeat(np.arange(count), len(runners.points) // count)
    for round_ in _ROUNDS:
        descent = _run(clouds, owners, runners, unknowns, round_.steps)
        chosen = _keep(owners, descent.cost, round_)
        owners = owners[chosen]
        # The ruling is brought under the middle of the samples, where its numbers are best told apart.
        runners = anchored(descent.rulings.at(chosen), np.zeros((len(chosen), 3)))
    descent = _run(clouds, owners, runners, unknowns, _LAST_STEPS)
    order = np.lexsort((descent.cost, owners))
    best = order[np.searchsorted(owners[order], np.arange(count))]
    return anchored(descent.rulings.at(best), np.zeros((count, 3))), descent.converged[best]


def _keep(owners: IntArray, cost: Array, round_: _Round) -> IntArray:
    """Who goes on, set by set and best first."""
    order = np.lexsort((cost, owners))
    owner, sorted_cost = owners[order], cost[order]
    first = np.searchsorted(owner, owner)
    place = np.arange(len(order)) - first
    on = (place < round_.always) | (sorted_cost <= round_.ratio * sorted_cost[first])
    if not round_.twins:
        before = np.concatenate([[-np.inf], sorted_cost[:-1]])
        on &= (place == 0) | (sorted_cost - before > _SAME * sorted_cost)
    return order[on]


def _run(clouds: Clouds, owners: IntArray, runners: Rulings, unknowns: tuple[int, ...], steps: int) -> Descent:
    return descend(clouds.points[owners], clouds.roots[owners], runners, unknowns, steps=steps)
