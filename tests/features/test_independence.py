"""Features whose unknowns depend on each other are refused when they are made, and told by name."""

import re
from types import SimpleNamespace

import numpy as np
import pytest

from cadpanel.errors import SettingsError
from cadpanel.features import independence
from cadpanel.features.distance import patch_distance_inner
from cadpanel.features.feature import Feature
from cadpanel.features.independence import LARGEST_FIXED, TRIALS, typical_values
from cadpanel.features.patches import Cone, Cylinder, Patch, Plane
from tests.own_patches import ByRoot, CurvedBy

KINDS: dict[str, Patch] = {"P": Plane(), "C": Cone(), "R": Cylinder()}


def named_dependent(make):
    """The unknowns that the refusal names."""
    with pytest.raises(SettingsError, match="depend on each other, so that no fit could tell them apart") as refused:
        make()
    found = re.search(r"apart: (.*); fix one of them", str(refused.value))
    assert found is not None
    return set(found.group(1).split(", "))


def test_two_planes_after_each_other_are_refused_by_their_widths_and_turns():
    names = named_dependent(lambda: Feature(Plane(), Plane()))
    assert names
    assert all(re.fullmatch(r"patch [01]: (width|turn)", name) for name in names)
    assert {name[:7] for name in names} == {"patch 0", "patch 1"}


def test_a_fold_between_two_planes_and_another_is_refused_for_the_planes_only():
    names = named_dependent(lambda: Feature(Plane(), Cone(), Plane(), Plane()))
    assert {name[:7] for name in names} == {"patch 2", "patch 3"}


def test_one_plane_after_another_whose_ruling_is_fixed_in_it_passes():
    """With its width and turn given, the ruling between the two is no matter of the fit."""
    fold = (Plane(), Cone(), Plane())
    assert len(Feature(Plane(width=200.0, turn=0.0), *fold).free) == len(Feature(*fold).free)


def test_a_cone_that_does_not_turn_is_refused_by_its_radius_and_half_angle():
    names = named_dependent(lambda: Feature(Plane(), Cone(sweep=0.0), Plane()))
    assert names & {"patch 1: radius", "patch 1: half_angle"}
    assert not any(name.startswith("cut") for name in names)


def test_two_cylinders_of_one_radius_are_refused_by_their_sweeps():
    names = named_dependent(lambda: Feature(Cylinder(radius=200.0), Cylinder(radius=200.0)))
    assert {"patch 0: sweep", "patch 1: sweep"} <= names


def test_two_cylinders_of_two_radii_pass():
    assert len(Feature(Cylinder(radius=200.0), Cylinder(radius=300.0)).free) == 5 + 2 + 6


@pytest.mark.parametrize("length", [1.0, 37.0, 2000.0, 1e5])
def test_fixed_lengths_of_any_size_pass(length):
    of = Feature(Plane(width=length), Cone(radius=1.5 * length), Plane(width=0.1 * length))
    assert len(of.free) == 18 - 3


def test_a_radius_that_is_held_on_the_concave_side_passes():
    assert len(Feature(Plane(), Cone(radius=-300.0), Plane()).free) == 17


@pytest.mark.parametrize("cuts", ["mitre", "upright", "parallel", "square"])
def test_a_plane_alone_may_be_cut_in_any_way(cuts):
    """Where the width's turn says what the cut's skew says, there is none to spare."""
    assert len(Feature(Plane(turn=0.0), cuts=cuts).free) > 0


def test_a_feature_that_leaves_nothing_of_its_patches_to_the_fit_still_has_a_place():
    of = Feature(Plane(width=100.0, turn=0.0), Cylinder(radius=50.0, sweep=0.5), Plane(width=100.0, turn=0.0))
    assert all(of.numbers[i].name.startswith(("anchor", "cut")) for i in of.free)


@pytest.mark.parametrize("second", [(1e12, 1.0), (1e-12, 1e-24), (1.0, 0.0)])
def test_a_feature_is_independent_if_it_is_so_on_one_trial_however_large_its_numbers_on_another(monkeypatch, second):
    trials = np.array([np.diag((1.0, 1e-3)), np.diag(second)])
    monkeypatch.setattr(independence, "motions", lambda *_: trials)
    monkeypatch.setattr(independence, "typical_values", lambda *_: None)
    feature = SimpleNamespace(name="any", free=(0, 1), numbers=(SimpleNamespace(name="a"), SimpleNamespace(name="b")))
    independence.refuse_dependent(feature)
    trials[:] = np.diag((1.0, 1e-12))
    with pytest.raises(SettingsError, match="depend on each other"):
        independence.refuse_dependent(feature)


def any_feature(unknowns):
    """A feature of which no more is known than how many unknowns it has."""
    names = [SimpleNamespace(name=f"number {i}") for i in range(unknowns)]
    return SimpleNamespace(name="any", free=range(unknowns), numbers=names)


def test_the_trial_that_counts_is_the_one_whose_least_singular_value_is_largest_beside_its_greatest(monkeypatch):
    """The second trial has the larger one of the two in the middle, and one that moves nothing."""
    monkeypatch.setattr(independence, "motions", lambda *_: np.array([np.diag((1, 1e-3, 1e-3)), np.diag((1, 1, 0))]))
    monkeypatch.setattr(independence, "typical_values", lambda *_: None)
    independence.refuse_dependent(any_feature(3))


def test_all_of_many_unknowns_are_named_that_take_part_alike(monkeypatch):
    unknowns = 25
    together = np.full(unknowns, unknowns**-0.5)
    monkeypatch.setattr(independence, "motions", lambda *_: (np.eye(unknowns) - np.outer(together, together))[None])
    monkeypatch.setattr(independence, "typical_values", lambda *_: None)
    assert named_dependent(lambda: independence.refuse_dependent(any_feature(unknowns))) == {
        f"number {i}" for i in range(unknowns)
    }


@pytest.mark.parametrize("kinds", ["PCPCP", "CCC", "CPC", "RP"])
def test_a_feature_is_tried_at_points_of_its_own_patches(monkeypatch, kinds):
    """On either end and, on a curved patch, between its rulings too."""
    of = Feature(*(KINDS[kind] for kind in kinds))
    tried = []

    def noted(walked, x, patch):
        found = patch_distance_inner(walked, x, patch)
        tried.append((patch, x, found[0]))
        return found

    monkeypatch.setattr(independence, "patch_distance_inner", noted)
    independence.motions(of, typical_values(of))
    assert [patch for patch, _, _ in tried] == list(range(len(kinds)))
    for patch, x, distance in tried:
        assert distance == pytest.approx(0.0, abs=1e-12)
        assert len(np.unique(x[:, 0].round(9), axis=1).T) == (10 if of.curved[patch] else 4)


@pytest.mark.parametrize("unit", [1e-12, 1e-3, 1e6])
@pytest.mark.parametrize(("least", "passes"), [(1e-8, True), (1e-10, False)])
def test_the_unit_of_what_can_be_seen_does_not_matter(monkeypatch, unit, least, passes):
    monkeypatch.setattr(independence, "motions", lambda *_: unit * np.diag((1.0, least))[None])
    monkeypatch.setattr(independence, "typical_values", lambda *_: None)
    feature = SimpleNamespace(name="any", free=(0, 1), numbers=(SimpleNamespace(name="a"), SimpleNamespace(name="b")))
    if passes:
        independence.refuse_dependent(feature)
    else:
        with pytest.raises(SettingsError, match=r"depend on each other, so .*: b; fix"):
            independence.refuse_dependent(feature)


def test_no_two_trials_share_a_number_and_cuts_stand_on_both_sides():
    of = Feature(Plane(), Cone(), Plane())
    values = typical_values(of)
    assert all(len(np.unique(values[:, free])) == TRIALS for free in of.free)
    first, second = of.cut_numbers[:, 0]
    assert (values[:, first] < -0.3).all()
    assert (values[:, second] > 0.3).all()


@pytest.mark.parametrize(
    ("patch", "fixed", "scaled"),
    [
        (ByRoot(root=20.0), 20.0, LARGEST_FIXED**0.5),  # 400 mm wide
        (CurvedBy(curvature=1.0 / 500.0), 1.0 / 500.0, 1.0 / LARGEST_FIXED),  # a radius of 500 mm
        (Cylinder(radius=500.0), 500.0, LARGEST_FIXED),
    ],
)
def test_what_is_fixed_is_tried_at_one_size_in_whatever_unit_it_is_told(patch, fixed, scaled):
    of = Feature(patch, Cone())
    (place,) = (i for i, number in enumerate(of.numbers) if number.fixed == fixed)
    assert typical_values(of)[:, place] == pytest.approx(scaled)
