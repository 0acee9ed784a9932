"""What is special about drift: it is split into along and across, and inner corners may slide along their end."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cadpanel.features.cut_planes import cut_planes
from cadpanel.geometry.vectors import dot
from cadpanel.terms.outline import Limited
from tests.chains import CHAINS, POLYGONS
from tests.terms.models import Case, case_of, cost, drift_terms, mixed_case

few = settings(max_examples=2)
seeds = st.integers(0, 10_000)


def vectors_of(case):
    """Drifts along, across and whole, of all panels."""
    along, across = drift_terms(case.problem)
    state = case.problem.state(case.unknowns)
    return along.vectors(state), across.vectors(state), case.problem.outline.drift(state)


def outer_corners(of):
    return [0, of.corner_count // 2 - 1, of.corner_count // 2, of.corner_count - 1]


@pytest.mark.parametrize("name", sorted(CHAINS))
@few
@given(seed=seeds)
def test_drift_is_split_into_along_and_across(name, seed):
    case = case_of(name, seed)
    along, across, drift = vectors_of(case)
    corner = outer_corners(CHAINS[name])
    # At the outer corners the gauge is the direction of the strip itself.
    outer = along[:, corner] * case.problem.outline.along.part[:, corner, 0]
    assert np.abs(outer + across - drift[:, corner]).max() <= 1e-14
    assert np.abs(dot(outer, across)).max() <= 1e-14


@pytest.mark.parametrize("name", sorted(POLYGONS))
def test_all_of_a_polygons_drift_is_limited_as_one(name):
    along, across, drift = vectors_of(case_of(name, 3))
    assert not along.any()
    assert np.array_equal(across, drift)


def test_panels_of_several_features_drift_as_each_of_them_does_alone():
    case = mixed_case(2)
    together = vectors_of(case)
    for i, of in enumerate(case.problem.layout.feature_of):
        alone = vectors_of(Case(case.problem.take(np.array([i])), case.unknowns[i : i + 1]))
        for one, other in zip(together, alone, strict=True):
            assert one[i, : other.shape[1]] == pytest.approx(other[0], abs=1e-15)
            assert not one[i, other.shape[1] :].any()
        assert alone[2].shape[1] == of.corner_count


def test_inner_corners_may_slide_along_an_end_that_runs_askew():
    """Corners of the same cut plane lie on one plane: moved within it they stay on the reference's end."""
    case = case_of("plane-cone-plane", 8)
    problem, state = case.problem, case.problem.state(case.unknowns)
    m, _ = cut_planes(state.walks[0])
    normals = np.repeat(m, 4, axis=1)
    inner = np.tile([0.0, 0.1, -0.05, 0.0], 2)[:, None]
    gauge = problem.outline.along.part.copy()
    gauge[:, [1, 2, 5, 6], 0] = normals[:, [1, 2, 5, 6]]
    along = Limited(corners=problem.outline.along.corners, part=gauge)
    sliding = np.cross(normals, [0.3, 0.2, 0.9]) * inner
    for shift, bound in ((sliding, 1e-24), (sliding + 1e-6 * normals, np.inf)):
        outline = replace(problem.outline, corners=state.corners.position + shift, along=along)
        there = cost("drift along", Case(replace(problem, outline=outline), case.unknowns))
        assert there.max() <= bound
    assert there.min() > 1e-24


@pytest.mark.parametrize(
    ("name", "terms"),
    [
        ("plane-cone-plane", ("drift along", "drift across")),
        ("planar-rectangle", ("drift along", "drift across")),
        ("polygon of 6", ("drift across",)),
    ],
)
def test_a_corner_on_its_reference_has_no_drift_and_one_off_it_has(name, terms):
    case = case_of(name, 2)
    problem, state = case.problem, case.problem.state(case.unknowns)
    outline = replace(problem.outline, corners=state.corners.position)
    there = Case(replace(problem, outline=outline), case.unknowns)
    assert all(cost(term, there).sum() == 0.0 for term in terms)
    there.unknowns[0] += 1e-6
    assert all(cost(term, there)[0] > 0.0 for term in terms)
