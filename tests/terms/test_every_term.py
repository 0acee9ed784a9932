"""The laws that every term of the objective obeys, on strips and rings of every feature."""

from functools import lru_cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cadpanel.fitting.objective import Objective
from cadpanel.solver.blocks import Normal
from tests.chains import FEATURES, SYMMETRIC
from tests.terms.models import (
    DIFFERENCES,
    ROUNDING,
    TERMS,
    Together,
    applies,
    assert_cost_is_half_the_squares,
    assert_model_is_that_of_the_rows,
    case_of,
    cost,
    empty,
    flipped,
    jacobian_fault,
    largest,
    made_term,
    moved,
    renumbered,
    twice_in_place,
)

pytestmark = pytest.mark.each_value_once

few = settings(max_examples=2)
seeds = st.integers(0, 10_000)

PAIRED = ("corner gap", "arc gap", "mixed gap", "parted gap", "evenness", "kink")
ON_A_FOLD = [term for term in TERMS if applies(term, "plane-cone-plane")]

every_term = pytest.mark.parametrize("term", ON_A_FOLD)
every_term_of_every_feature = pytest.mark.parametrize(
    ("term", "name"), [(term, name) for name in sorted(FEATURES) for term in TERMS if applies(term, name)]
)
every_term_of_symmetric_features = pytest.mark.parametrize(
    # Parts of gaps are looked at in directions of their own, which do not turn with the panel.
    ("term", "name"),
    [(term, name) for term in TERMS for name in sorted(SYMMETRIC) if applies(term, name) and term != "parted gap"],
)


@lru_cache(maxsize=4)
def small_ring(name, seed):
    """A case that all terms share, as walking it once for each unknown takes longer than the terms do."""
    return case_of(name, seed, panels=3, ring=True)


@every_term_of_every_feature
def test_the_rows_jacobian_agrees_with_finite_differences(term, name):
    case = small_ring(name, 7)
    assert jacobian_fault(made_term(term, case.problem, 7), case) <= DIFFERENCES


@every_term
def test_a_jacobian_that_is_off_by_a_little_is_found(term):
    class Wrong(Together):
        def rows(self, state):
            rows = super().rows(state)
            rows[0].jacobians[0][0, 0, 0] += 1e-4
            return rows

    case = small_ring("plane-cone-plane", 3)
    assert jacobian_fault(Wrong(case.problem, TERMS[term](case.problem)), case) > DIFFERENCES


@every_term_of_every_feature
@few
@given(seed=seeds, ring=st.booleans())
def test_the_model_is_that_of_the_rows(term, name, seed, ring):
    case = case_of(name, seed, ring=ring)
    assert_model_is_that_of_the_rows(made_term(term, case.problem, seed), case)


@every_term_of_every_feature
@few
@given(seed=seeds, ring=st.booleans())
def test_the_cost_is_half_the_squares_of_the_rows(term, name, seed, ring):
    case = case_of(name, seed, ring=ring)
    assert_cost_is_half_the_squares(made_term(term, case.problem, seed), case)


@every_term
@few
@given(seed=seeds)
def test_adding_twice_adds_twice(term, seed):
    case = case_of("plane-cone-plane", seed)
    made, state = made_term(term, case.problem, seed), case.problem.state(case.unknowns, derivatives=True)
    once, twice = (empty(case.problem) for _ in range(2))
    made.add_to(once, state)
    for _ in range(2):
        made.add_to(twice, state)
    for one, two in ((once.gradient, twice.gradient), (once.diagonal, twice.diagonal), (once.coupling, twice.coupling)):
        assert np.abs(2.0 * one - two).max() <= ROUNDING * largest(two)


@every_term_of_every_feature
@few
@given(seed=seeds, ring=st.booleans(), order=st.permutations(range(4)))
def test_the_order_of_panels_does_not_matter(term, name, seed, ring, order):
    case = case_of(name, seed, ring=ring)
    there = cost(term, renumbered(case, np.array(order)))
    assert there == pytest.approx(cost(term, case)[np.array(order)], rel=ROUNDING)


@every_term_of_symmetric_features
@few
@given(seed=seeds, ring=st.booleans(), panel=st.integers(0, 3))
def test_a_panel_walked_from_its_other_end_costs_the_same(term, name, seed, ring, panel):
    case = case_of(name, seed, ring=ring)
    assert cost(term, flipped(case, panel)) == pytest.approx(cost(term, case), rel=1e-9)


@every_term
@few
@given(seed=seeds)
def test_turning_and_shifting_everything_does_not_matter(term, seed):
    case = case_of("plane-cone-plane", seed)
    assert cost(term, moved(case, seed)) == pytest.approx(cost(term, case), rel=1e-9)


@pytest.mark.parametrize(
    ("term", "name", "edge"),
    [
        (term, name, edge)
        for term in ("corner gap", "arc gap")
        for name, of in sorted(FEATURES.items())
        for edge in range(len(of.edges))
        if term == "corner gap" or not of.edges[edge].straight
    ],
)
def test_a_panel_that_continues_its_neighbour_has_no_gap(term, name, edge):
    case = twice_in_place(name, 5, edge)
    assert cost(term, case).sum() <= 1e-24
    case.unknowns[1, 0] += 1e-6
    assert cost(term, case).sum() > 1e-24


@pytest.mark.parametrize("term", PAIRED)
def test_without_seams_there_is_no_gap(term):
    case = case_of("plane-cone-plane", 1, panels=1)
    made, state = made_term(term, case.problem), case.problem.state(case.unknowns, derivatives=True)
    assert case.problem.seams == ()
    assert np.array_equal(made.cost(state), np.zeros(1))
    assert np.array_equal(made.add_to(Normal.zero(1, case.problem.layout.size, 0), state), np.zeros(1))
    assert made.rows(state) == []


@every_term
def test_rows_without_derivatives_are_refused(term):
    case = case_of("plane-cone-plane", 1)
    with pytest.raises(ValueError, match="without derivatives"):
        made_term(term, case.problem).rows(case.problem.state(case.unknowns))


@pytest.mark.parametrize("name", ["plane-cone-plane", "plane-cone", "polygon of 5"])
def test_an_objective_is_the_sum_of_its_terms(name):
    case = case_of(name, 6)
    problem, unknowns = case.problem, case.unknowns
    terms = [term for make in TERMS.values() for term in make(problem)]
    objective = Objective(problem, terms, coupled=True)
    state = problem.state(unknowns)
    assert objective.cost(unknowns) == pytest.approx(sum(term.cost(state) for term in terms), rel=ROUNDING)
    booked, normal = objective.linearize(unknowns)
    assert booked == pytest.approx(objective.cost(unknowns), rel=ROUNDING)
    parts = [np.linalg.norm(normal.coupling[i]) for i in range(len(problem.pairs))]
    assert min(parts) > 0.0
