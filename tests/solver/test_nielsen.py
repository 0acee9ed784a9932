"""Damping follows what steps keep of their promises."""

import numpy as np
import pytest

from cadpanel.solver.nielsen import FIRST_GROWTH, Nielsen

RULE = Nielsen(least=1e-3, most=1e3, drop=0.2, rise=2.0)


def after(*gains, damping=1.0, growth=FIRST_GROWTH, failed=False, rule=RULE):
    gain = np.array(gains)
    same = np.ones_like(gain)
    return rule.after(damping * same, growth * same, gain, np.full(gain.shape, failed))


def test_damping_stays_where_half_the_promise_was_kept_doubles_where_nothing_was_and_falls_no_further_than_it_may():
    damping, _ = after(-3.0, 0.0, 0.25, 0.5, 0.75, 0.9, 1.0, 5.0)
    assert damping == pytest.approx([2.0, 2.0, 1.125, 1.0, 0.875, 0.488, 0.2, 0.2])


def test_damping_rises_ever_faster_while_steps_are_refused_and_calms_down_after_the_first_that_is_not():
    damping, growth, rises = np.ones(1), np.full(1, FIRST_GROWTH), []
    rule = Nielsen(least=1e-3, most=1e30, drop=0.2)
    for _ in range(8):
        risen, growth = rule.after(damping, growth, np.array([-1.0]), np.array([True]))
        rises.append(float(risen[0] / damping[0]))
        damping = risen
    assert rises == pytest.approx([2.0, 4.0, 8.0, 16.0, 32.0, 64.0, 64.0, 64.0])
    assert rule.after(damping, growth, np.array([0.6]), np.array([False]))[1] == pytest.approx([FIRST_GROWTH])


def test_a_refusal_raises_damping_by_what_the_rule_says_beside():
    assert after(0.0, failed=True)[0] == pytest.approx([4.0])


@pytest.mark.parametrize(("damping", "failed", "end"), [(1e-3, False, 1e-3), (1e3, True, 1e3)])
def test_damping_stays_within_its_bounds(damping, failed, end):
    assert after(1.0, damping=damping, failed=failed)[0] == pytest.approx([end])
