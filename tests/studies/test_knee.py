"""Where a curve of costs has its knee."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cadpanel.studies.knee import knee

GAPS = [1.0, 2.0, 5.0, 10.0, 20.0]


def test_the_knee_is_where_the_steep_part_ends():
    assert knee(GAPS, [16.0, 12.0, 4.0, 3.9, 3.8]) == 2
    assert knee(GAPS, [16.0, 4.0, 3.9, 3.85, 3.8]) == 1


@given(last=st.sampled_from(range(1, 4)), high=st.floats(2.0, 100.0), low=st.floats(0.0, 1.0))
def test_of_two_straight_parts_it_is_where_they_meet(last, high, low):
    x = np.log(GAPS)
    values = np.interp(x, [x[0], x[last], x[-1]], [high, low + 0.02 * (high - low), low])
    assert knee(GAPS, values.tolist()) == last


@pytest.mark.parametrize("values", [[5.0, 5.0, 5.0, 5.0, 5.0], [5.0, 4.99, 4.9, 4.89, 4.89]])
def test_a_level_curve_has_none(values):
    assert knee(GAPS, values) is None


def test_a_straight_one_and_one_that_bulges_have_none_and_two_points_neither():
    x = np.log(GAPS)
    assert knee(GAPS, (10.0 - 3.0 * x).tolist()) is None
    assert knee(GAPS, (10.0 - x**2).tolist()) is None
    assert knee(GAPS[:2], [10.0, 1.0]) is None
    assert knee([], []) is None


@given(scale=st.floats(1e-3, 1e3), gap=st.floats(1e-2, 1e2))
def test_units_change_no_knee(scale, gap):
    values = [16.0, 9.0, 4.0, 3.0, 2.9]
    assert knee([gap * one for one in GAPS], [scale * one for one in values]) == knee(GAPS, values)


def test_of_two_places_that_are_as_good_rounding_does_not_choose():
    x = np.log(np.array([1.0, 2.0, 4.0, 8.0]))
    for shake in (-1e-13, 0.0, 1e-13):
        values = np.interp(x, x, [10.0, 4.0, 10.0 / 6.0 * 0.4, 0.0])
        values[2] = values[1] - (values[0] - values[3]) / 3.0 + shake
        assert knee(np.exp(x).tolist(), values.tolist()) == 1
