"""Which of two points is the better one, component by component."""

import numpy as np
import pytest

from cadpanel.solver.components import Components
from cadpanel.solver.ended import Best, Limits
from cadpanel.solver.interior_point import interior_point
from tests.solver.models import held_points

CASES = [
    ((1.0, 5.0), (1.2, 1.0), False),  # what must hold comes first
    ((1.2, 1.0), (1.1, 9.0), True),
    ((0.3, 5.0), (0.9, 4.0), True),  # what holds holds, by however much
    ((0.3, 1.1), (0.3, 1.2), False),
    ((0.3, 0.2), (0.9, 0.9), True),  # all is held: the later one has settled more
]


def best(values, at):
    firm, excess = np.array(values).T
    return Best(np.full((len(values), 1), at), firm, excess, np.full(len(values), at))


@pytest.mark.parametrize(("mine", "its", "beaten"), CASES)
def test_the_best_holds_what_it_must_and_exceeds_the_rest_least(mine, its, beaten):
    assert best([mine], 0.0).beaten_by(best([its], 1.0)).tolist() == [beaten]


def test_the_better_one_is_taken_in_each_component_by_itself():
    mine, its, beaten = zip(*CASES, strict=True)
    one, other = best(mine, 0.0), best(its, 1.0)
    taken = one.mixed(other, one.beaten_by(other), Components(len(CASES), np.arange(len(CASES))))
    assert taken.unknowns[:, 0].tolist() == taken.cost.tolist() == [float(new) for new in beaten]
    assert [(f, e) for f, e in zip(taken.firm, taken.excess, strict=True)] == [
        theirs if new else ours for ours, theirs, new in CASES
    ]


def test_ends_are_mixed_with_their_multipliers():
    model = held_points(np.array([[3.0, 0.0], [0.0, 2.0]]), np.zeros((2, 2)), np.ones(2))
    wide, narrow = (interior_point(model, model.targets.copy(), Limits(), ease=ease) for ease in (1.5, 1.0))
    mixed = narrow.mixed(wide, np.array([True, False]), Components.of(model.pattern))
    assert np.array_equal(mixed.best.unknowns[0], wide.best.unknowns[0])
    assert np.array_equal(mixed.best.unknowns[1], narrow.best.unknowns[1])
    assert mixed.multipliers[0][:, 0].tolist() == [wide.multipliers[0][0, 0], narrow.multipliers[0][1, 0]]
    assert mixed.ease.tolist() == [1.5, 1.0]
    assert mixed.steps == wide.steps + narrow.steps


def test_of_mixed_ends_one_that_was_told_to_stop_is_enough():
    model = held_points(np.array([[3.0, 0.0]]), np.zeros((1, 2)), np.ones(1))
    free, told = (interior_point(model, model.targets.copy(), Limits(steps=2), tell=tell) for tell in (None, no))
    for one, other in ((free, told), (told, free)):
        assert one.mixed(other, np.array([True]), Components.of(model.pattern)).told_to_stop


def no(*_: object) -> bool:
    return False
