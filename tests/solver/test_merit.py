"""What points are worth, and which part of a step is taken."""

import numpy as np
import pytest

from cadpanel.solver.barrier import Barriers
from cadpanel.solver.components import Components
from cadpanel.solver.held_rows import HeldRows
from cadpanel.solver.merit import Merit
from tests.solver.models import held_points

# Three points by themselves, each drawn to (1, 0) and held within 0.5 of the origin.
TARGETS, CENTRES = np.tile([1.0, 0.0], (3, 1)), np.zeros((3, 2))


def made():
    model = held_points(TARGETS, CENTRES, np.full(3, 0.5))
    blocks = Components.of(model.pattern)
    held = HeldRows.of_batches(model.held, model.at(CENTRES).vectors, 3, 0)
    return Merit(model, blocks, held), Barriers(held, most=1.0, ease=1.0)


def taken(start, step, *, goes_on=(True, True, True)):
    merit, barriers = made()
    how = {"barriers": barriers, "mu": np.full(3, 0.01), "goes_on": np.array(goes_on), "least": np.zeros(3)}
    return merit.take(merit.at(np.array(start, dtype=float)), np.array(step, dtype=float), np.full(3, 0.01), **how)


def test_a_step_is_taken_where_it_helps_and_not_where_it_harms():
    """Toward the target within the ball; away from it; and far out of the ball."""
    start = [[0.1, 0.0]] * 3
    found = taken(start, [[0.2, 0.0], [-0.3, 0.0], [20.0, 0.0]])
    assert found.blocks.tolist() == [True, False, False]
    assert found.failed.tolist() == [False, True, True]
    assert found.gain[0] > 0.0 > max(found.gain[1:])
    assert found.place.point.unknowns == pytest.approx(np.array([[0.3, 0.0], [0.1, 0.0], [0.1, 0.0]]), abs=1e-15)


def test_what_is_at_rest_never_fails():
    assert not taken([[0.1, 0.0]] * 3, [[0.0, 0.0]] * 3, goes_on=(False, False, False)).failed.any()


def test_a_point_is_worth_its_excess_and_its_free_cost():
    merit, barriers = made()
    place = merit.at(np.array([[0.25, 0.0], [0.5, 0.0], [1.0, 0.0]]))
    worth = merit.worth(place, barriers)
    assert np.maximum(worth.firm, worth.excess) == pytest.approx([0.5, 1.0, 2.0], rel=1e-12)
    assert merit.free_cost(place) == pytest.approx(0.5 * np.array([0.75, 0.5, 0.0]) ** 2, abs=1e-12)
    # Where nothing is held the penalty is what is left.
    assert np.all(np.diff(merit.penalized(place, barriers, np.full(3, 0.01)) - place.point.cost) > 0.0)
