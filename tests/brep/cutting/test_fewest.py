"""The fewest panels of which none is too large."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cadpanel.brep.cutting.fewest import SLACK, fewest
from cadpanel.errors import SettingsError


@given(whole=st.floats(1.0, 1e6), most=st.floats(1.0, 1e5))
def test_one_panel_fewer_would_be_too_large(whole, most):
    count = fewest(lambda number: whole / number, whole, most, "the strip")
    assert whole / count <= most * (1.0 + SLACK)
    assert count == 1 or whole / (count - 1) > most


@pytest.mark.parametrize("last_digit", [-1e-9, 0.0, 1e-9])
def test_the_last_digit_of_a_length_makes_no_panel_more(last_digit):
    assert fewest(lambda number: (9000.0 + last_digit) / number, 9000.0 + last_digit, 1000.0, "the strip") == 9


@given(uneven=st.floats(0.0, 0.5), whole=st.floats(1e3, 1e5))
def test_the_largest_panel_counts_where_they_differ(uneven, whole):
    def largest(number):
        return whole / number * (1.0 + uneven)

    count = fewest(largest, whole, 900.0, "the strip")
    assert largest(count) <= 900.0 * (1.0 + SLACK)
    assert count == 1 or largest(count - 1) > 900.0


def test_panels_that_are_never_small_enough_or_too_many_are_refused():
    with pytest.raises(SettingsError, match="their lengths differ too much"):
        fewest(lambda _: 950.0, 9000.0, 900.0, "the strip")
    with pytest.raises(SettingsError, match="would be more than 1000000"):
        fewest(lambda number: 1e4 / number, 1e4, 1e-3, "the strip")
    assert np.isfinite(fewest(lambda number: 1e4 / number, 1e4, 1.0, "the strip"))
