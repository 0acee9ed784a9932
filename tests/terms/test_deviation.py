"""What is special about deviation: samples find their patch, weigh what they weigh, and are worked on in parts."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cadpanel.features.distance import assign, skin_normals
from cadpanel.features.panel_edges import ARC_SHARES
from cadpanel.features.walk import arc_rulings
from cadpanel.solver.blocks import Normal
from cadpanel.terms.deviation import Deviation
from tests.chains import CHAINS, FEATURES, POLYGONS, mixed_unknowns, problem_of
from tests.terms.models import (
    DIFFERENCES,
    ROUNDING,
    Case,
    assert_model_is_that_of_the_rows,
    case_of,
    empty,
    jacobian_fault,
    largest,
    made_term,
    mixed_case,
)

few = settings(max_examples=2)
seeds = st.integers(0, 10_000)


def points_on_patches(walked):
    """Points (panels, m, 3) inside the patches, and their patches (m,); first those of the arcs' rulings."""
    points = [arc_rulings(walked).p]
    patches = [i for i, one in enumerate(walked.feature.curved) if one for _ in ARC_SHARES]
    for i, curved in enumerate(walked.feature.curved):
        if not curved:
            points.append(0.5 * (walked.edges.p[:, i] + walked.edges.p[:, i + 1])[:, None])
            patches.append(i)
    return np.concatenate(points, axis=1), np.array(patches)


@pytest.mark.parametrize("name", sorted(CHAINS))
@few
@given(seed=seeds)
def test_every_sample_belongs_to_the_patch_on_which_its_foot_lies(name, seed):
    case = case_of(name, seed)
    state = case.problem.state(case.unknowns)
    (walked,) = state.walks
    stacked, patches = points_on_patches(walked)
    x = np.moveaxis(stacked, 2, 0)
    assert np.array_equal(assign(walked, x), np.broadcast_to(patches, stacked.shape[:2]))
    # They lie on the skin: no distance, and the normals are those of their rulings.
    distance, found = Deviation(x, np.ones(stacked.shape[:2])).distances(state)
    assert np.array_equal(found, assign(walked, x))
    assert np.abs(distance).max() <= 1e-12
    normals = skin_normals(walked, x, assign(walked, x))
    inside = arc_rulings(walked)
    assert np.abs(normals[:, : inside.n.shape[1]] - inside.n).max(initial=0.0) <= 1e-12
    # Off the skin by a height, along the normal: that height is the distance.
    height = np.random.default_rng(seed).uniform(-0.02, 0.02, stacked.shape[:2])
    lifted = Deviation(np.moveaxis(stacked + height[..., None] * normals, 2, 0), np.ones(stacked.shape[:2]))
    assert np.abs(lifted.distances(state)[0] - height).max() <= 1e-12


@pytest.mark.parametrize("name", sorted(POLYGONS))
@few
@given(seed=seeds)
def test_the_distance_from_a_polygon_is_that_from_its_plane(name, seed):
    case = case_of(name, seed)
    state = case.problem.state(case.unknowns)
    (walked,) = state.walks
    random = np.random.default_rng(seed)
    height, corners = random.uniform(-0.1, 0.1, (case.problem.panels, 9)), state.corners.position
    share = random.dirichlet(np.ones(corners.shape[1]), (case.problem.panels, 9))
    points = share @ corners + height[..., None] * walked.anchor.n
    distance, patch = Deviation(np.moveaxis(points, 2, 0), np.ones(height.shape)).distances(state)
    assert np.abs(distance - height).max() <= 1e-12
    assert not patch.any()


def test_samples_of_weight_zero_do_not_count():
    case = case_of("plane-cone-plane", 4)
    problem, state = case.problem, case.problem.state(case.unknowns)
    roots = problem.deviation.roots.copy()
    roots[:, ::2] = 0.0
    half = Deviation(problem.deviation.samples, roots)
    wild = problem.deviation.samples.copy()
    wild[:, :, ::2] += 0.7
    assert np.array_equal(half.cost(state), Deviation(wild, roots).cost(state))
    assert half.cost(state).sum() < problem.deviation.cost(state).sum()


def assert_panels_count_as_alone(case: Case, panels):
    """Cost and model of each of these panels are those it has when there is no other."""
    problem, unknowns = case.problem, case.unknowns
    state = problem.state(unknowns, derivatives=True)
    normal = empty(replace(problem, pairs=problem.pairs[:0]))
    together = problem.deviation.add_to(normal, state)
    assert together == pytest.approx(problem.deviation.cost(state), rel=ROUNDING)
    for i in panels:
        alone = problem.take(np.array([i]))
        size = alone.layout.size
        own = Normal.zero(1, size, 0)
        one = alone.state(unknowns[i : i + 1, :size], derivatives=True)
        assert alone.deviation.add_to(own, one)[0] == pytest.approx(together[i], rel=ROUNDING)
        assert np.abs(own.gradient[0] - normal.gradient[i, :size]).max() <= ROUNDING * largest(own.gradient)
        assert np.abs(own.diagonal[0] - normal.diagonal[i, :size, :size]).max() <= ROUNDING * largest(own.diagonal)
        assert not normal.diagonal[i, size:].any()


@pytest.mark.parametrize("name", ["plane-cone-plane", "polygon of 5"])
def test_many_panels_are_worked_on_in_parts_that_do_not_show(name):
    """More panels than are worked on together, against each of them alone."""
    assert_panels_count_as_alone(case_of(name, 9, panels=70), (0, 63, 64, 69))


def test_panels_of_several_features_count_as_each_of_them_does_alone():
    case = mixed_case(9)
    assert_panels_count_as_alone(case, range(case.problem.panels))


@pytest.mark.parametrize("count", [1, 2, 3])
def test_so_do_panels_of_any_number_of_features_in_whatever_order(count):
    features = [FEATURES[name] for name in ("plane-cone-plane", "polygon of 5", "tri-cone")[:count]]
    order = [*features, features[0], *features[::-1]]
    pairs = [(k, k + 1) for k in range(len(order) - 1)]
    problem = problem_of(order, 4, pairs, np.tile([1, 0], (len(pairs), 1)))
    assert len(problem.layout.groups) == count
    assert_panels_count_as_alone(Case(problem, mixed_unknowns(problem.layout, 4)), range(len(order)))


def held_case(name, seed):
    """Samples held to patches at random, whatever patch they lie over."""
    case = mixed_case(seed) if name == "mixed" else case_of(name, seed)
    free, random = case.problem.deviation, np.random.default_rng(seed)
    patches = np.array([len(feature.curved) for feature in case.problem.layout.feature_of])[:, None]
    first = random.integers(0, patches, free.roots.shape)
    held = Deviation(free.samples, free.roots, (first, random.integers(first, patches)))
    return replace(case, problem=replace(case.problem, deviation=held))


HELD_FEATURES = ["plane-cone-plane", "tri-cone", "mixed"]


@pytest.mark.parametrize("name", HELD_FEATURES)
def test_held_samples_obey_the_laws_of_terms(name):
    case = held_case(name, 5)
    made = made_term("deviation", case.problem)
    assert jacobian_fault(made, case) <= DIFFERENCES
    assert_model_is_that_of_the_rows(made, case)
    assert_panels_count_as_alone(case, range(min(4, case.problem.panels)))


@pytest.mark.parametrize("name", HELD_FEATURES)
def test_held_samples_belong_to_the_nearest_patch_that_they_may(name):
    case = held_case(name, 6)
    state, deviation = case.problem.state(case.unknowns), case.problem.deviation
    patch, held = (deviation.distances(state, held=how)[1] for how in (False, True))
    first, last = deviation.allowed
    assert np.array_equal(held, np.clip(patch, first, last))
    assert (patch != held).any()
