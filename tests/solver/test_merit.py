"""What points are worth, and which part of a step is taken."""

import numpy as np
import pytest

from cadpanel.solver.barrier import Barriers
from cadpanel.solver.components import Components
from cadpanel.solver.held_rows import HeldRows
from cadpanel.solver.merit import Merit
from tests.solver.models import held_chain, held_points

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


def test_of_a_step_that_fails_as_a_whole_what_helped_is_kept_and_what_harmed_is_not():
    """Of a chain of eight the first goes a little nearer to where it wants to be, the last far away, the others not."""
    model = held_chain(np.zeros((8, 2)), 5.0)
    blocks, start, step = Components.of(model.pattern), np.zeros((8, 2)), np.zeros((8, 2))
    start[0], step[0], step[7] = [-0.4, 0.0], [0.25, 0.0], [3.0, 0.0]
    held = HeldRows.of_batches(model.held, model.at(start).vectors, 8, 7)
    merit = Merit(model, blocks, held)
    barriers = Barriers(held, most=1.0, ease=1.0)
    where = merit.at(start)
    found = merit.take(
        where,
        step,
        np.full(8, 0.01),
        barriers=barriers,
        mu=np.full(1, 1e-3),
        goes_on=np.ones(1, dtype=bool),
        least=np.zeros(1),
    )
    assert found.failed.tolist() == [True]
    assert found.blocks.tolist() == [True] * 3 + [False] * 5
    assert found.place.point.unknowns[[0, 7], 0] == pytest.approx([-0.15, 0.0], abs=1e-15)


@pytest.mark.parametrize(("start", "promised", "least"), [(TARGETS, 0.0, 0.0), (CENTRES, 0.01, 0.02)])
def test_where_nothing_is_left_to_gain_no_step_fails(start, promised, least):
    """Of a cost of 0, or below the least that counts."""
    merit, barriers = made()
    how = {"barriers": barriers, "mu": np.full(3, 0.01), "goes_on": np.ones(3, dtype=bool), "least": np.full(3, least)}
    found = merit.take(merit.at(start), np.zeros((3, 2)), np.full(3, promised), **how)
    assert found.gain.tolist() == [1.0] * 3
    assert not found.failed.any()
