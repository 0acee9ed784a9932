"""Gaps in parts: each is seen in its own direction, and counted in what is allowed of it."""

import numpy as np
import pytest

from cadpanel.fitting.methods.holding import gap_terms
from cadpanel.terms.outermost_gap import OutermostGap
from cadpanel.terms.parted_gap import PartedGap
from cadpanel.terms.parts import PARTS
from tests.terms.models import case_of, twice_in_place

ALLOWED = dict(zip(PARTS, (4.0, 2.0, 8.0), strict=True))


def ends_of(problem, allowed, state):
    """What holds the outermost corners of the first batch, lengths in the solver's unit."""
    gap = OutermostGap(problem.seams[0], problem.place, problem.layout, tolerance=1.0)
    return PartedGap(gap, state, allowed)


@pytest.mark.parametrize("name", ["plane-cone-plane", "cylinder", "planar-quadrilateral", "polygon of 5"])
def test_a_gap_is_the_sum_of_its_parts(name):
    case = case_of(name, 4)
    state = case.problem.state(case.unknowns)
    parted = ends_of(case.problem, dict.fromkeys(ALLOWED, 1.0), state)
    whole = np.linalg.norm(parted.gap.vectors(state), axis=-1)
    assert np.linalg.norm(parted.vectors(state), axis=-1) == pytest.approx(whole, rel=1e-12)


@pytest.mark.parametrize("part", ALLOWED)
def test_a_part_that_is_used_up_has_the_length_that_is_held(part):
    """Whichever part it is: then the vector's length is the least of what is allowed."""
    case = case_of("plane-cone-plane", 4)
    state = case.problem.state(case.unknowns)
    plain = ends_of(case.problem, dict.fromkeys(ALLOWED, 1.0), state).vectors(state)
    counted = ends_of(case.problem, ALLOWED, state)
    place = counted.parts.index(part)
    assert counted.vectors(state)[..., place] * ALLOWED[part] == pytest.approx(2.0 * plain[..., place], rel=1e-12)
    assert (counted.hold.radius == 2.0).all()


def test_a_panel_moved_out_of_its_neighbours_skin_has_a_step_and_hardly_anything_else():
    case = twice_in_place("planar-quadrilateral", 5, 1)
    case.unknowns[1, 1] += 1e-3  # along its own normal
    state = case.problem.state(case.unknowns)
    width, step, shift = np.moveaxis(
        np.abs(ends_of(case.problem, dict.fromkeys(ALLOWED, 1.0), state).vectors(state)), 2, 0
    )
    assert step == pytest.approx(np.full(step.shape, 1e-3), rel=1e-2)
    assert max(width.max(), shift.max()) <= 1e-4  # its frame's normal leans from the skin's by a few degrees


def test_what_is_not_limited_is_not_held():
    case = case_of("plane-cone-plane", 4)
    state = case.problem.state(case.unknowns)
    parts = [term.parts for term in gap_terms(case.problem, {"step": 3.0}, state) if isinstance(term, PartedGap)]
    assert parts
    assert set(parts) == {("step",)}
    # Between their ends curves have no shift.
    shifts = gap_terms(case.problem, {"shift": 3.0}, state)
    assert all(isinstance(term, PartedGap) and isinstance(term.gap, OutermostGap) for term in shifts)
