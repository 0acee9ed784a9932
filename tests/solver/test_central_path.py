"""The weight of a number on the central path."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cadpanel.solver.central_path import central_weight, penalty

few = settings(max_examples=30)
numbers = st.floats(-3.0, 12.0).map(lambda exponent: 10.0**-exponent)
signs = st.sampled_from([-1.0, 1.0])


@few
@given(size=numbers, sign=signs, mu=st.sampled_from([1e-8, 1e-3, 1.0]), most=st.sampled_from([1e-4, 1.0, 1e3]))
def test_the_weight_balances_slack_and_excess(size, sign, mu, most):
    c, greatest = np.array([sign * size]), np.array([most])
    weight = central_weight(c, mu, greatest)
    if mu / most < 1e-9 * size:  # the weight is the greatest one but for rounding, or none
        assert weight[0] == pytest.approx(most if sign > 0.0 else 0.0, abs=1e-6 * most)
        return
    assert 0.0 < weight[0] < most
    slack, over = mu / weight, mu / (greatest - weight)
    assert (over - slack)[0] == pytest.approx(c[0], rel=1e-4, abs=1e-9 * (slack + over)[0])


@few
@given(size=numbers, sign=signs, mu=st.sampled_from([1e-6, 1e-3, 1.0]))
def test_the_weight_is_the_slope_of_the_penalty(size, sign, mu):
    c, most = sign * size, np.array([1.0])
    step = 1e-5 * max(size, mu)
    ahead, behind = (float(penalty(np.array([c + side * step]), mu, most)[0]) for side in (1.0, -1.0))
    assert (ahead - behind) / (2.0 * step) == pytest.approx(central_weight(np.array([c]), mu, most)[0], abs=1e-6)


def test_without_a_barrier_the_penalty_is_what_is_exceeded_times_the_greatest_weight():
    c = np.array([-1.0, -1e-3, 1e-3, 1.0])
    assert penalty(c, 1e-12, np.full(4, 5.0)) == pytest.approx(5.0 * np.maximum(c, 0.0), abs=1e-9)


@pytest.mark.parametrize("c", [1e9, 1e30])
def test_however_far_something_is_exceeded_its_weight_is_seen_to_be_below_the_greatest(c):
    """Both the weight and a tenth of what is left of the greatest: the stiffness divides by that."""
    for most in (3e-7, 1.0, 7e5):
        weight = central_weight(np.array([c]), 1e-12 * most, np.array([most]))
        assert weight[0] < most
        assert most - 0.1 * (most - weight[0]) < most


@few
@given(size=numbers, sign=signs, unit=st.sampled_from([1e-3, 7.0]))
def test_the_penalty_counts_in_the_unit_of_the_greatest_weight(size, sign, unit):
    c, most = np.array([sign * size]), np.array([2.0])
    assert penalty(c, 0.1 * unit, unit * most) == pytest.approx(unit * penalty(c, 0.1, most), rel=1e-9)
