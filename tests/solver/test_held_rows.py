"""All held vectors in a row."""

import numpy as np

from cadpanel.solver.held_rows import HeldRows
from cadpanel.solver.hold import Hold
from tests.solver.models import HeldBatch


def test_vectors_of_any_batches_stand_after_each_other_and_numbers_below_0_count_nothing():
    """Pairs of vectors in space between neighbours, and numbers of single blocks that may be as low as they like."""
    first = np.arange(2)
    gaps = HeldBatch(Hold(np.ones((2, 2)), weight=0.0, gives_way=True), np.zeros((2, 2, 3)), (first, first + 1), first)
    lacks = HeldBatch(Hold(np.full((3, 1), 4.0), weight=2.0, one_sided=True), np.zeros((3, 1, 1)), (np.arange(3),))
    apart = np.random.default_rng(0).normal(size=(2, 2, 3))
    numbers = np.array([[[-2.0]], [[0.0]], [[0.2]]])
    held = HeldRows.of_batches([gaps, lacks], [apart, numbers], 3, 2)
    at = held.measured([apart, numbers])
    assert np.allclose(at.squares, [*np.sum(apart**2, axis=-1).reshape(-1), 0.0, 0.0, 0.04])
    assert at.values[-3:].tolist() == [-2.0, 0.0, 0.2]
    assert held.first.tolist() == [0, 0, 1, 1, 0, 1, 2]
    assert held.second.tolist() == [1, 1, 2, 2, 0, 1, 2]
    assert held.weights().tolist() == [0.0] * 4 + [2.0] * 3
    assert (held.gives_way == ~held.one_sided).all()
    assert held.gives_way.tolist() == [True] * 4 + [False] * 3
    back = held.by_batch(at.squares)
    assert [one.shape for one in back] == [(2, 2), (3, 1)]
    assert np.allclose(back[0], np.sum(apart**2, axis=-1))


def test_where_nothing_is_held_there_is_nothing_in_the_row():
    held = HeldRows.of_batches([], [], 3, 2)
    assert all(len(part) == 0 for part in held.measured([]))
