"""How walks are cut into patches: exact data is found exactly, and no other way to cut fits better."""

from itertools import combinations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cadpanel.fitting.start.segmentation import SHORTEST, curved_runs, cut_profile, without_blemishes

few = settings(max_examples=15)
seeds = st.integers(0, 10_000)
PLACES = 12
CHAINS = [
    (True,),
    (False,),
    (False, True),
    (False, True, False),
    (True, True),
    (True, False, True),
    (False, True, True, False),
]

every_chain = pytest.mark.parametrize("curved", CHAINS, ids=lambda curved: "".join("pc"[kind] for kind in curved))


def misfit(turned, knots, curved):
    """Sum of squares about the mean of every plane and about the best line of every curved patch: the definition."""
    total = 0.0
    for start, stop, kind in zip(knots[:-1], knots[1:], curved, strict=True):
        place, own = np.arange(start, stop + 1), turned[start : stop + 1]
        total += float(np.sum((own - np.polyval(np.polyfit(place, own, int(kind)), place)) ** 2))
    return total


def ways(places, patches, least):
    """All knots that leave every patch `least` steps or more."""
    for inner in combinations(range(1, places - 1), patches - 1):
        knots = (0, *inner, places - 1)
        if min(np.diff(knots)) >= least:
            yield knots


def made(knots, curved, rates):
    """A walk that stands still on planes and turns evenly on curved patches."""
    slopes = np.repeat(np.where(curved, rates, 0.0), np.diff(knots))
    return np.concatenate([[0.0], np.cumsum(slopes)])


@few
@given(seeds)
@every_chain
def test_no_other_way_to_cut_a_walk_fits_better(curved, seed):
    turned = np.cumsum(np.random.default_rng(seed).normal(size=(3, PLACES)), axis=1)
    profile = cut_profile(turned, curved)
    for walk, knots in zip(turned, profile.knots, strict=True):
        best = min(misfit(walk, other, curved) for other in ways(PLACES, len(curved), SHORTEST))
        assert misfit(walk, knots, curved) == pytest.approx(best, abs=1e-9)
        assert (knots[0], knots[-1]) == (0, PLACES - 1)
        assert np.diff(knots).min() >= SHORTEST


@few
@given(seeds)
@every_chain
def test_exact_walks_are_cut_where_they_were_made(curved, seed):
    random = np.random.default_rng(seed)
    places = 65
    # Patches of five steps or more, and rates that tell neighbours apart.
    inner = 5 * (1 + np.sort(random.choice(11, len(curved) - 1, replace=False)))
    knots = np.concatenate([[0], inner, [places - 1]]).astype(int)
    rates = np.where(np.arange(len(curved)) % 2, 0.03, 0.07) * random.choice([-1.0, 1.0])
    turned = made(knots, curved, rates)
    profile = cut_profile(turned[None], curved)
    assert profile.knots[0].tolist() == knots.tolist()
    assert profile.angles[0] == pytest.approx(turned[knots], abs=1e-9)


def test_a_walk_with_a_knot_between_two_places_is_cut_at_the_nearer_one():
    """The smallest case in which the law above cannot hold."""
    place = np.arange(33.0)
    turned = 0.05 * np.maximum(place - 16.3, 0.0)
    profile = cut_profile(turned[None], (False, True))
    assert profile.knots[0].tolist() == [0, 16, 32]
    # Within what the walk turns between the knot and that place.
    assert profile.angles[0, 0] == pytest.approx(0.0, abs=0.05 * 0.3)
    assert profile.angles[0, -1] == pytest.approx(turned[-1], abs=0.05 * 0.3)


@every_chain
def test_walks_are_cut_one_by_one(curved):
    turned = np.cumsum(np.random.default_rng(7).normal(size=(5, 20)), axis=1)
    together = cut_profile(turned, curved)
    for i in range(len(turned)):
        alone = cut_profile(turned[i : i + 1], curved)
        assert np.array_equal(alone.knots[0], together.knots[i])
        assert alone.angles[0] == pytest.approx(together.angles[i], abs=1e-12)


@every_chain
@pytest.mark.parametrize("by", [0.0, 3.0, -100.0])
def test_turning_the_panel_turns_the_angles_and_leaves_the_knots(curved, by):
    turned = np.cumsum(np.random.default_rng(3).normal(size=(4, 20)), axis=1)
    before, after = cut_profile(turned, curved), cut_profile(turned + by, curved)
    assert np.array_equal(before.knots, after.knots)
    assert after.angles - by == pytest.approx(before.angles, abs=1e-9)


@few
@given(seeds)
@every_chain
def test_the_angles_are_those_of_the_definition(curved, seed):
    """On a plane, and at its ends, the mean; between two curved patches the mean of both lines' ends."""
    (turned,) = np.cumsum(np.random.default_rng(seed).normal(size=(1, PLACES)), axis=1)
    profile = cut_profile(turned[None], curved)
    knots = profile.knots[0]
    ends = []
    for start, stop, kind in zip(knots[:-1], knots[1:], curved, strict=True):
        place = np.arange(start, stop + 1)
        ends.append(np.polyval(np.polyfit(place, turned[start : stop + 1], int(kind)), [start, stop]))
    for knot in range(len(curved) + 1):
        sides = [(curved[i], ends[i][end]) for i, end in ((knot - 1, 1), (knot, 0)) if 0 <= i < len(curved)]
        flat = [angle for kind, angle in sides if not kind]
        expected = np.mean(flat or [angle for _, angle in sides])
        assert profile.angles[0, knot] == pytest.approx(expected, abs=1e-9)


def test_even_gives_neighbouring_curved_patches_equal_parts_of_the_same_stretch():
    curved = (False, True, True, True, False)
    turned = made([0, 10, 14, 40, 46, 64], curved, np.array([0.0, 0.1, 0.02, 0.07, 0.0]))
    best, even = (cut_profile(turned[None], curved, even=even) for even in (False, True))
    assert best.knots[0].tolist() == [0, 10, 14, 40, 46, 64]
    assert even.knots[0].tolist() == [0, 10, 22, 34, 46, 64]


@pytest.mark.parametrize("curved", [(False, True, False), (True, False, True), (True,)])
def test_even_changes_nothing_where_no_curved_patches_are_neighbours(curved):
    turned = np.cumsum(np.random.default_rng(5).normal(size=(6, 30)), axis=1)
    best, even = (cut_profile(turned, curved, even=even) for even in (False, True))
    assert np.array_equal(best.knots, even.knots)
    assert np.array_equal(best.angles, even.angles)


@pytest.mark.parametrize(("patches", "least"), [(3, 2), (6, 2), (7, 1), (12, 1)])
def test_patches_may_be_shorter_where_there_are_more_of_them_than_room(patches, least):
    turned = np.cumsum(np.random.default_rng(2).normal(size=(3, 13)), axis=1)
    steps = np.diff(cut_profile(turned, patches * (True,)).knots, axis=1)
    assert steps.min() >= least
    assert steps.sum(axis=1).tolist() == [12, 12, 12]


@pytest.mark.parametrize(
    ("curved", "runs"),
    [
        ((False,), []),
        ((True,), [(0, 1)]),
        ((False, True, True, False, True), [(1, 3), (4, 5)]),
        ((True, True, False), [(0, 2)]),
    ],
)
def test_runs_are_stretches_of_curved_patches(curved, runs):
    assert curved_runs(curved) == runs


@few
@given(steps=st.lists(st.floats(0.0, 2.0), min_size=64, max_size=64), hook=st.integers(1, 7), start=st.integers(30, 50))
def test_a_narrow_hook_is_taken_out_of_a_walk_and_a_sharp_fold_is_not(steps, hook, start):
    walk = np.cumsum(np.array([0.0, *steps]) * np.array([30.0 if k == 20 else 0.01 for k in range(65)]))[None]
    np.testing.assert_array_equal(without_blemishes(np.radians(walk)), np.radians(walk))
    hooked = walk.copy()
    hooked[:, start : start + hook] += 100.0
    assert np.abs(without_blemishes(np.radians(hooked)) - np.radians(walk)).max() < np.radians(1.0)
