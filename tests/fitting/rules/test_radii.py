"""Radii that are equal, of few kinds, or a tool's: exactly, and as near to the drawing as that can be."""

from itertools import product

import numpy as np
import pytest

from cadpanel.errors import SettingsError
from cadpanel.features.feature import Feature
from cadpanel.features.patches import Cone, Cylinder, Plane
from cadpanel.fitting.rules.bends import bends_of
from cadpanel.fitting.rules.equal import SAME_RADIUS
from cadpanel.fitting.rules.kinds import KindsOfBends, parted
from cadpanel.fitting.rules.rule import Bends
from tests.ruled import free, radii, ruled


def test_without_rules_no_two_radii_are_alike() -> None:
    assert free().outcomes == ()
    assert np.diff(np.sort(radii(free()))).min() > 1.0


def test_a_group_has_one_radius_and_the_best_one() -> None:
    group = ruled({"equal": [{"panels": "*", "radius": True}]})
    (outcome,) = group.outcomes
    assert group.tolerance_met
    assert np.ptp(radii(group)) <= SAME_RADIUS
    assert outcome.kept
    assert list(outcome.values) == ["N 1", "N 2", "N 3", "N 4"]
    best, deviation = radii(group)[0], {}
    for factor in (0.98, 1.0, 1.02):
        die = Feature(Plane(), Cone(radius=factor * best), Plane())
        deviation[factor] = ruled(None, feature=die).measures.overall_rms
    assert deviation[1.0] < min(deviation[0.98], deviation[1.02])
    assert group.measures.overall_rms == pytest.approx(deviation[1.0], rel=1e-3)


def test_half_angles_and_radii_of_a_part_of_the_strip() -> None:
    group = ruled({"equal": [{"panels": ["N 1", "N 3"], "radius": True, "half_angle": True}]})
    assert [outcome.found for outcome in group.outcomes] == pytest.approx([0.0, 0.0], abs=1e-9)
    assert group.tolerance_met
    assert abs(radii(group)[1] - radii(group)[0]) > 0.1


def test_tools_are_met_and_the_nearest_are_taken() -> None:
    found = ruled({"shop": {"radii": [300, 420, 450, 480], "add": 3}})
    assert found.tolerance_met
    nearest = np.array([423.0, 453.0, 483.0])[
        np.abs(np.log(radii(free())[:, None] / [423.0, 453.0, 483.0])).argmin(axis=1)
    ]
    assert radii(found) == pytest.approx(nearest)


def test_a_fixed_radius_has_no_tool() -> None:
    with pytest.raises(SettingsError, match="fixed by its author"):
        ruled({"shop": {"radii": [300]}}, feature=Feature(Plane(), Cylinder(radius=300.0), Plane()))
    with pytest.raises(SettingsError, match="no panel has one"):
        ruled({"shop": {"radii": [300]}}, feature="planar-quadrilateral")


def test_there_are_no_more_kinds_of_bends_than_asked_for_or_of_radii_alone() -> None:
    bends, one = (ruled({"kinds": kinds}) for kinds in ({"most": 2}, {"most": 1, "of": "radii"}))
    cones = np.abs(bends_of(bends.shapes)[:, 0])
    assert len(np.unique(np.round(cones, 6), axis=0)) == 2
    assert bends.tolerance_met
    assert bends.outcomes[0].found == 2.0
    assert len(np.unique(np.round(radii(one), 6))) == 1
    assert len(np.unique(np.round(bends_of(one.shapes)[:, 0, 1], 6))) > 1
    assert free().measures.overall_rms < min(bends.measures.overall_rms, one.measures.overall_rms)


def test_a_kind_of_bends_is_a_cone_whichever_of_its_ends_lies_first() -> None:
    names, panels = list("abcde"), np.arange(5)
    kinds = KindsOfBends(names, panels, 2, 2000.0, np.full(5, True))
    cones = [(300.0, 0.04), (303.0, -0.05), (300.0, 0.2), (305.0, 0.06), (300.0, -0.22)]
    bends = Bends(np.array(cones)[:, None], np.zeros((5, 1, 2), dtype=bool), np.zeros(5, dtype=bool))
    for alike in kinds.groupings(bends.values)[0]:
        bends = alike.settled(bends, 0)
    assert bends.held.all()
    found = bends.values[:, 0]
    assert found[:, 1] == pytest.approx([0.05, -0.05, 0.21, 0.05, -0.21])
    assert np.ptp(found[[0, 1, 3], 0]) == np.ptp(found[[2, 4], 0]) == 0.0


def test_kinds_are_parted_as_well_as_can_be() -> None:
    values = np.random.default_rng(2).normal(size=7)

    def cost(kinds):
        return sum(np.sum((values[kinds == kind] - values[kinds == kind].mean()) ** 2) for kind in set(kinds.tolist()))

    for most in (1, 2, 3):
        best = min(cost(np.array(kinds)) for kinds in product(range(most), repeat=7))
        assert cost(parted(values, most)) == pytest.approx(best)
    assert len(set(parted(values, 9).tolist())) == 7
