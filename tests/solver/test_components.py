"""Sums, means and largest values of components are those of their members."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from cadpanel.solver.components import Components
from tests.solver.models import grid, pattern, strip


@given(seed=st.integers(0, 2**32 - 1), count=st.integers(1, 5), extra=st.integers(0, 9))
def test_every_member_counts_for_its_component_alone(seed, count, extra):
    random = np.random.default_rng(seed)
    label = random.permutation(np.concatenate([np.arange(count), random.integers(0, count, extra)]))
    values, components = random.normal(size=len(label)), Components(count, label)
    for one in range(count):
        own = values[label == one]
        assert np.isclose(components.total(values)[one], own.sum())
        assert np.isclose(components.mean(values)[one], own.mean())
        assert components.largest(values, -np.inf)[one] == own.max()
        assert components.largest(values)[one] == max(own.max(), 0.0)
        assert components.smallest(values)[one] == own.min()
        assert np.all(components.each(np.arange(float(count)))[label == one] == one)


def test_rows_of_several_values_count_with_their_largest_and_nothing_with_the_least():
    components = Components(3, np.array([2, 0, 2]))
    rows = np.array([[1.0, 5.0], [-2.0, -3.0], [4.0, 0.5]])
    assert components.largest(rows, -9.0).tolist() == [-2.0, -9.0, 5.0]
    assert components.smallest(rows, 9.0).tolist() == [-3.0, 9.0, 0.5]
    assert Components(2, np.empty(0, dtype=np.intp)).largest(np.empty((0, 3)), 1.0).tolist() == [1.0, 1.0]


def test_what_is_no_number_is_seen_in_its_component_alone():
    found = Components(2, np.array([0, 1])).largest(np.array([np.nan, 1.0]))
    assert np.isnan(found).tolist() == [True, False]


def test_blocks_that_are_coupled_and_what_sees_them_are_of_one_component():
    pairs = [*strip(3), *[(a + 3, b + 3) for a, b in grid(2, 2)]]
    components = Components.of(pattern(8, 1, pairs))
    assert components.count == 3
    assert len(set(components.label[:3])) == len(set(components.label[3:7])) == 1
    assert components.seen_by(np.array([7, 0])).label.tolist() == components.label[[7, 0]].tolist()
