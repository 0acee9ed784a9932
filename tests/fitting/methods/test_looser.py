"""Who asks for less gets no worse: a limit made looser breaks nothing that held, and costs no deviation.

Each limit of the catalogue, and the gap and each of its parts, goes through a ladder of values, the tightest first.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from itertools import combinations
from typing import Any

import numpy as np
import pytest

import cadpanel as cp
from cadpanel.fitting.settings import FitSettings
from cadpanel.terms.limits.catalogue import LIMITS
from fixtures.arrays import reference
from tests.benchmarks.holding import random_lip
from tests.columns import column
from tests.thorough import THOROUGH, cases, thorough

# A fit ends where less than a thousandth of the cost is left to gain; millimetres or degrees count by the same share.
NO_WORSE = 1.01

# Of each setting what is tried as a rule, and in a thorough run.
LADDERS: dict[str, tuple[Sequence[float], Sequence[float]]] = {
    "gap_tolerance": ([0.5, 4.0], [0.3, 0.5, 1.0, 2.0, 4.0, 8.0, 20.0]),
    "joint_tolerance": ([0.3, 3.0], [0.3, 1.0, 3.0, 8.0]),
    "step": ([1.0, 3.0], [0.5, 1.0, 2.0, 3.0, 6.0, 12.0]),
    "shift": ([0.3, 3.0], [0.3, 1.0, 3.0, 8.0]),
    "seam_turn": ([1.5, 3.0], [0.3, 0.7, 1.5, 3.0, 6.0, 20.0]),
    "evenness": ([0.001, 0.0025], [0.0005, 0.001, 0.0025, 0.006, 0.02, 0.1]),
    "seam_level": ([0.1, 1.0], [0.05, 0.1, 0.3, 1.0, 3.0, 1000.0]),
    "max_kink": ([2.0, 5.0], [0.2, 0.5, 1.0, 2.0, 4.0, 8.0]),
    "drift_along": ([0.003, 0.02], [0.001, 0.003, 0.01, 0.02, 0.05]),
    "drift_across": ([0.003, 0.02], [0.001, 0.003, 0.01, 0.02, 0.05]),
    "drift_outline": ([0.05, 0.3], [0.0005, 0.001, 0.003, 0.01, 0.05]),
    "min_radius": ([200.0, 10.0], [400.0, 300.0, 200.0, 150.0, 100.0, 10.0]),
}
# Each limit on one of two lips: a limit takes several seconds on either.
TRIED = [(f"lip {(0, 5)[place % 2]}", limit) for place, limit in enumerate(LADDERS)]


@cache
def strip(name: str) -> cp.Reference:
    """A random lip by its seed, or the flaring column."""
    kind, _, seed = name.partition(" ")
    if kind == "lip":
        return reference(random_lip(int(seed), 6 if THOROUGH else 3))
    return column()


def test_every_limit_that_can_be_asked_for_has_a_ladder():
    gaps = {"gap_tolerance", "joint_tolerance", "step", "shift"}
    assert set(LADDERS) == gaps | {limit.name for limit in LIMITS if limit.asked}
    for name, ladders in LADDERS.items():
        at_least = any(limit.name == name and limit.at_least for limit in LIMITS)
        assert all(list(ladder) == sorted(ladder, reverse=at_least) for ladder in ladders)


@thorough
@pytest.mark.parametrize(("of", "limit"), TRIED)
def test_a_looser_limit_breaks_nothing_that_held_and_costs_no_deviation(of, limit):
    no_worse_by_and_by(of, limit, {})


@pytest.mark.parametrize("limit", cases(["seam_level"], ["seam_level", "step", "shift", "seam_turn"]))
def test_the_same_of_rings_that_are_to_be_level(limit):
    no_worse_by_and_by("column", limit, {"feature": "cone"})


def no_worse_by_and_by(of: str, limit: str, how: dict[str, str]) -> None:
    asked: list[tuple[float, dict[str, Any]]] = [(value, {**how, limit: value}) for value in cases(*LADDERS[limit])]
    fits = [(value, cp.fit(strip(of), FitSettings(**settings))) for value, settings in asked]
    for (tight, one), (loose, other) in combinations(fits, 2):
        told = f"{limit} {tight:g} against {loose:g}"
        assert other.tolerance_met or not one.tolerance_met, told
        if one.tolerance_met:
            assert other.measures.overall_rms <= NO_WORSE * one.measures.overall_rms, told


@pytest.mark.parametrize("of", cases([], ["lip 5"]))
def test_a_kink_that_cannot_be_held_beside_gaps_is_no_larger_where_a_larger_one_was_asked_for(of):
    fits = [cp.fit(strip(of), max_kink=asked) for asked in cases([0.5, 1.0], [0.1, 0.2, 0.5, 1.0, 2.0, 4.0])]
    assert not fits[0].tolerance_met
    for tight, loose in combinations(fits, 2):
        if all((tight.measures.gaps[what] <= most).all() for what, most in tight.settings.gaps.items()):
            kinks = [float(np.degrees(fit.measures.kink.max())) for fit in (tight, loose)]
            assert kinks[1] <= max(NO_WORSE * kinks[0], loose.settings.max_kink)
