"""Panels of several features in one problem, which meet along any of their edges, alike or not."""

from dataclasses import replace
from functools import lru_cache
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cadpanel.features.carrying import carry, moves_over
from cadpanel.features.catalogue import feature
from cadpanel.features.cut_planes import cut_planes
from cadpanel.features.feature import Feature
from cadpanel.features.polygon import Polygon
from cadpanel.fitting.objective import Objective
from cadpanel.fitting.shapes import panel_shapes
from cadpanel.geometry.shape import PanelShape
from cadpanel.terms.edge_gap import MixedGap
from tests.chains import mixed_unknowns, problem_of
from tests.terms.models import (
    DIFFERENCES,
    MIXED,
    ROUNDING,
    TERMS,
    Case,
    Together,
    assert_cost_is_half_the_squares,
    assert_model_is_that_of_the_rows,
    cost,
    counted_from,
    flipped,
    jacobian_fault,
    made_term,
    mixed_case,
    moved,
    renumbered,
    seams_of,
    with_seams,
)
from tests.thorough import cases

pytestmark = pytest.mark.each_value_once

few = settings(max_examples=3)
seeds = st.integers(0, 10_000)
every_term = pytest.mark.parametrize("term", TERMS)


def test_the_mixed_problem_has_seams_of_every_kind():
    batches = mixed_case(0).problem.seams
    kinds = {(batch.alike, batch.straight(0), batch.straight(1)) for batch in batches}
    assert kinds == {
        (True, True, True),
        (True, False, False),
        (False, True, False),
        (False, False, True),
        (False, False, False),
    }
    assert sum(len(batch.index) for batch in batches) == 10
    assert any(batch.reversed.any() and not batch.alike for batch in batches)


@lru_cache(maxsize=2)
def walked_once(seed):
    """A case that all terms share, as walking it once for each unknown takes longer than the terms do."""
    return mixed_case(seed)


@every_term
@settings(max_examples=1)
@given(seed=seeds)
def test_the_rows_jacobian_agrees_with_finite_differences(term, seed):
    case = walked_once(seed)
    assert jacobian_fault(made_term(term, case.problem, seed), case) <= DIFFERENCES


@pytest.mark.parametrize("panel", cases([0], [0, 1]))
def test_a_jacobian_of_a_mixed_gap_that_is_off_by_a_little_is_found(panel):
    class Wrong(Together):
        def rows(self, state):
            rows = super().rows(state)
            rows[-1].jacobians[panel][0, 0, 0] += 1e-4
            return rows

    case = walked_once(3)
    assert jacobian_fault(Wrong(case.problem, TERMS["mixed gap"](case.problem)), case) > DIFFERENCES


@every_term
@few
@given(seed=seeds)
def test_the_model_is_that_of_the_rows(term, seed):
    case = mixed_case(seed)
    assert_model_is_that_of_the_rows(made_term(term, case.problem, seed), case)


@every_term
@few
@given(seed=seeds)
def test_the_cost_is_half_the_squares_of_the_rows(term, seed):
    case = mixed_case(seed)
    assert_cost_is_half_the_squares(made_term(term, case.problem, seed), case)


@every_term
@few
@given(seed=seeds, order=st.permutations(range(len(MIXED))))
def test_the_order_of_panels_does_not_matter(term, seed, order):
    case = mixed_case(seed)
    there = cost(term, renumbered(case, np.array(order)))
    assert there == pytest.approx(cost(term, case)[np.array(order)], rel=ROUNDING)


@every_term
@few
@given(seed=seeds)
def test_turning_and_shifting_everything_does_not_matter(term, seed):
    case = mixed_case(seed)
    assert cost(term, moved(case, seed)) == pytest.approx(cost(term, case), rel=1e-9)


@every_term
@pytest.mark.parametrize("panel", [i for i, one in enumerate(MIXED) if isinstance(one, Feature)])
def test_a_panel_walked_from_its_other_end_costs_the_same(term, panel):
    case = mixed_case(4)
    assert cost(term, flipped(case, panel)) == pytest.approx(cost(term, case), rel=1e-9)


@every_term
@pytest.mark.parametrize("corner", [1, 4])
def test_a_polygon_counted_from_another_corner_costs_the_same(term, corner):
    case = mixed_case(4)
    (panel,) = (i for i, one in enumerate(MIXED) if isinstance(one, Polygon))
    assert cost(term, counted_from(case, panel, corner)) == pytest.approx(cost(term, case), rel=1e-9)


def test_an_edge_that_is_named_the_wrong_way_round_costs_something_else():
    """The smallest case in which the sense of a seam matters: two corners change places."""
    case = mixed_case(4)
    panels, edges, backwards = seams_of(case.problem)
    backwards[0] ^= True
    wrong = replace(case, problem=with_seams(case.problem, panels, edges, backwards))
    assert abs(cost("corner gap", wrong).sum() / cost("corner gap", case).sum() - 1.0) > 1e-3


def test_unknowns_that_a_feature_does_not_have_are_left_alone():
    """Rows of unknowns are as long as the longest: what is idle has no gradient, and a model that can be solved."""
    case = mixed_case(5)
    problem = case.problem
    terms = [term for make in TERMS.values() for term in make(problem)]
    _, normal = Objective(problem, terms, coupled=True).linearize(case.unknowns)
    idle = ~problem.layout.used
    assert idle.any()
    assert not normal.gradient[idle].any()
    for i in range(problem.panels):
        assert np.array_equal(normal.diagonal[i][idle[i]], np.eye(problem.layout.size)[idle[i]])
    for (i, j), block in zip(problem.pairs, normal.coupling, strict=True):
        assert not block[idle[i]].any()
        assert not block[:, idle[j]].any()


def mixed_gap(features, edges, seed, backwards=False):
    """Two panels, the one term that holds their edges, its vectors, and their shapes in mm."""
    problem = with_seams(problem_of(features, seed, [(0, 1)], [edges]), [(0, 1)], [edges], [backwards])
    unknowns = mixed_unknowns(problem.layout, seed)
    (term,) = problem.curve_gaps(1.0)
    assert isinstance(term, MixedGap)
    state = problem.state(unknowns)
    return problem, state, term.vectors(state)[0] * problem.place.length, panel_shapes(problem, unknowns)


def from_plane(points, point, normal):
    return (points - point) @ normal


@pytest.mark.parametrize("backwards", [False, True])
@pytest.mark.parametrize("edge", [0, 1])
def test_points_of_a_curved_end_are_held_to_the_line_of_a_straight_edge(edge, backwards):
    features = [feature("plane-cone-plane"), feature("planar-quadrilateral")]
    problem, state, vectors, (fold, flat) = mixed_gap(features, (1, edge), 3, backwards)
    place = problem.place
    arcs = place.to_world(state.arcs.position)[0, 3:] * place.length + place.centre
    points = np.concatenate([fold.corners()[1, 1:-1], arcs])
    start, stop = flat.corners()[edge]
    along = (stop - start) / np.linalg.norm(stop - start)
    distance = np.linalg.norm(np.cross(points - start, along), axis=-1)
    assert np.linalg.norm(vectors[:5], axis=-1) == pytest.approx(distance, rel=1e-9)


@pytest.mark.parametrize("backwards", [False, True])
def test_points_of_a_straight_edge_are_held_to_the_skin_and_the_cut_plane_of_a_curved_end(backwards):
    features = [Polygon(6), feature("cylinder")]
    _, _, vectors, (hexagon, roll) = mixed_gap(features, (2, 0), 3, backwards)
    start, stop = hexagon.corners()[0, 2:4]
    points = start + np.array([0.25, 0.5, 0.75])[:, None] * (stop - start)
    assert isinstance(roll, PanelShape)
    patch: Any = roll.patches[0]
    centre, axis = roll.points[0] - patch.radius * roll.normals[0], roll.directions[0]
    from_axis = np.linalg.norm(np.cross(points - centre, axis), axis=-1)
    assert np.abs(vectors[:3, 0]) == pytest.approx(np.abs(from_axis - patch.radius), rel=1e-9)
    from_cut = from_plane(points, roll.cut_points[0], roll.cut_normals[0])
    assert vectors[:3, 1] == pytest.approx(from_cut, rel=1e-9)
    assert not vectors[:3, 2].any()


def one_cone_told_twice(stretch=1.0):
    """A cone as one patch and as two, in one place: ends that are not alike and yet the same curve."""
    whole, split = feature("cone"), feature("cone-spline-2")
    radius, half_angle, sweeps = 0.3, 0.04, (0.5, 0.8)
    problem = problem_of([split, whole], 1, [(0, 1)], [(1, 1)])
    values = np.zeros((1, len(split.numbers)))
    values[0, split.patch_slice(0)] = radius, half_angle, sweeps[0]
    values[0, split.patch_slice(1)] = radius, half_angle, sweeps[1]
    values[0, split.cut_numbers[0]], values[0, split.cut_numbers[1]] = (-0.5, 0.02, -0.1), (0.5, -0.05, 0.15)
    walked = split.walk(values, derivatives=False)
    # The anchor of the whole cone lies further on, by half of the second sweep.
    over = moves_over("cone", np.array([radius, half_angle, 0.5 * sweeps[1]]), np.array(1.0), derivatives=False)
    middle = carry(over.frames, walked.anchor.frames[0, 0])
    into = middle[:3].T
    numbers = np.zeros((1, len(whole.numbers)))
    numbers[0, whole.patch_slice(0)] = radius * stretch, half_angle, sum(sweeps)
    m, s = (one[0] for one in cut_planes(walked))
    for end in (0, 1):
        across, along, out = m[end] @ into
        numbers[0, whole.cut_numbers[end]] = (s[end] - m[end] @ middle[3]) / along, across / along, out / along
    place, length = problem.place, problem.place.length
    place = replace(
        place,
        origins=np.array([place.origins[0], place.origins[0] + length * place.axes[0] @ middle[3]]),
        axes=np.array([place.axes[0], place.axes[0] @ into]),
    )
    unknowns = np.zeros((2, problem.layout.size))
    for i, (of, all_) in enumerate(((split, values), (whole, numbers))):
        unknowns[i, : len(of.free)] = all_[0, of.free]
    return Case(replace(problem, place=place), unknowns)


def test_the_same_end_told_in_one_patch_and_in_two_has_no_gap():
    same = one_cone_told_twice()
    assert not any(batch.alike for batch in same.problem.seams)
    assert all(cost(term, same).sum() <= 1e-24 for term in ("corner gap", "mixed gap"))
    wider = one_cone_told_twice(1.0 + 1e-6)
    assert cost("mixed gap", wider).sum() > 1e-16
