"""Panels of several features in one array of unknowns."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cadpanel.features.layout import Layout
from tests.chains import FEATURES, mixed_unknowns

few = settings(max_examples=10)
choices = st.lists(st.sampled_from(sorted(FEATURES)), min_size=1, max_size=7)


def laid_out(names):
    return Layout.of([FEATURES[name] for name in names])


@few
@given(names=choices)
def test_every_panel_is_in_one_group_and_keeps_its_feature(names):
    layout = laid_out(names)
    members = np.concatenate([group.panels for group in layout.groups])
    assert sorted(members.tolist()) == list(range(len(names)))
    assert len(layout.groups) == len({FEATURES[name] for name in names})
    assert list(layout.feature_of) == [FEATURES[name] for name in names]


@few
@given(names=choices)
def test_panels_walk_together_as_they_do_alone(names):
    layout = laid_out(names)
    unknowns = mixed_unknowns(layout, 1)
    walks = layout.walk(unknowns, derivatives=False)
    corners = layout.gather(
        [group.feature.corners(walked).position for group, walked in zip(layout.groups, walks, strict=True)]
    )
    for i, name in enumerate(names):
        of = FEATURES[name]
        alone = of.walk(of.expand(unknowns[i : i + 1, : len(of.free)]), derivatives=False)
        own = of.corners(alone).position[0]
        assert corners[i, : len(own)] == pytest.approx(own, abs=1e-14)
        assert not corners[i, len(own) :].any()


@few
@given(names=choices)
def test_used_entries_are_those_of_each_panels_own_unknowns(names):
    layout = laid_out(names)
    assert layout.size == max(len(FEATURES[name].free) for name in names)
    for i, name in enumerate(names):
        assert layout.used[i].tolist() == [j < len(FEATURES[name].free) for j in range(layout.size)]


def test_in_the_solvers_units_the_features_lengths_are_too():
    of = FEATURES["roof edge"]
    (group,) = Layout.of([of, of], 2000.0).groups
    assert group.feature == of.in_units(2000.0)
    assert group.feature != of
