"""Distances and weights of held vectors."""

import numpy as np
import pytest

from cadpanel.solver.hold import Hold


def test_without_held_vectors_there_is_no_excess():
    assert Hold(np.ones((0, 4)), weight=1.0).excess(np.zeros((0, 4, 3))) == 0.0


def test_the_excess_is_that_of_the_longest_vector_by_its_own_distance():
    hold = Hold(np.array([[1.0, 10.0]]), weight=0.0)
    assert hold.excess(np.array([[[3.0, 4.0], [0.0, 20.0]]])) == pytest.approx(5.0)


def test_a_number_below_zero_exceeds_nothing_and_costs_nothing():
    numbers = np.array([[[-7.0]], [[0.5]]])
    one_sided = Hold(np.ones((2, 1)), weight=1.0, one_sided=True)
    assert one_sided.ratio(numbers) == pytest.approx(np.array([[0.0], [0.5]]))
    assert one_sided.squares(numbers) == pytest.approx(np.array([[0.0], [0.25]]))
    both = Hold(np.ones((2, 1)), weight=1.0)
    assert both.ratio(numbers) == pytest.approx(np.array([[7.0], [0.5]]))


def test_tightening_shrinks_distances_and_keeps_weights():
    hold = Hold(np.ones((2, 3)), weight=2.0)
    hold.tighten(np.array([0.5, 1.0]))
    assert np.all(hold.radius == [[0.5], [1.0]])
    assert np.all(hold.weight == 2.0)
