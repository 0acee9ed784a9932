"""Patches and cut planes of all panels in arrays, against those of the panels one by one."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cadpanel.features.cut_planes import cut_planes
from cadpanel.features.distance import assign, patch_distance_inner
from cadpanel.terms.surfaces import cut_planes_of
from tests.chains import FEATURES, made_problem, mixed_unknowns
from tests.terms.models import case_of, mixed_case

few = settings(max_examples=3)
seeds = st.integers(0, 10_000)
every_feature = pytest.mark.parametrize("name", sorted(FEATURES))


def everywhere(seed, panels, count=60):
    """(panels, count, 3) points on and around a panel."""
    return np.random.default_rng(seed).uniform(-0.6, 0.6, (panels, count, 3))


@every_feature
@few
@given(seed=seeds)
def test_points_are_given_to_the_same_patch_as_in_the_regression(name, seed):
    case = case_of(name, seed)
    state = case.problem.state(case.unknowns)
    x = everywhere(seed, case.problem.panels)
    (walked,) = state.walks
    assert np.array_equal(
        state.surfaces.assign(x, np.arange(case.problem.panels)), assign(walked, np.moveaxis(x, 2, 0))
    )


@few
@given(seed=seeds)
def test_points_are_given_to_the_same_patch_where_features_are_mixed(seed):
    case = mixed_case(seed)
    state = case.problem.state(case.unknowns)
    x = everywhere(seed, case.problem.panels)
    panels = np.arange(case.problem.panels)[::-1]
    found = state.surfaces.assign(x[panels], panels)[::-1]
    for group, walked in zip(case.problem.layout.groups, state.walks, strict=True):
        own = assign(walked, np.moveaxis(x[group.panels], 2, 0))
        assert np.array_equal(found[group.panels], own)


@few
@given(seed=seeds)
def test_distances_and_their_inner_derivatives_are_those_of_the_patches(seed):
    case = mixed_case(seed)
    state = case.problem.state(case.unknowns)
    x = everywhere(seed, case.problem.panels)
    for group, walked in zip(case.problem.layout.groups, state.walks, strict=True):
        for patch in range(len(group.feature.patches)):
            which = np.full((len(group.panels), x.shape[1]), patch)
            found = state.surfaces.distance_inner(x[group.panels], group.panels, which)
            own = patch_distance_inner(walked, np.moveaxis(x[group.panels], 2, 0), patch)
            for one, other in zip(found, own, strict=True):
                assert one == pytest.approx(other, abs=1e-13)


@every_feature
def test_cut_planes_have_unit_normals_and_lie_where_the_walk_has_them(name):
    problem = made_problem(FEATURES[name], 2)
    walks = problem.layout.walk(mixed_unknowns(problem.layout, 2), derivatives=True)
    cuts = cut_planes_of(problem.layout, walks)
    if name.startswith("polygon"):
        assert not any(part.any() for part in (cuts.m, cuts.s, cuts.dm, cuts.ds) if part is not None)
        return
    m, s = cut_planes(walks[0])
    size = np.linalg.norm(m, axis=-1)
    assert np.linalg.norm(cuts.m, axis=-1) == pytest.approx(np.ones(size.shape), abs=1e-14)
    assert cuts.m * size[..., None] == pytest.approx(m, abs=1e-14)
    assert cuts.s * size == pytest.approx(s, abs=1e-14)
