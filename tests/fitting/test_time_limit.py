"""A fit that is told to end, or whose time is over: the best so far, which keeps every limit but perhaps gaps."""

import numpy as np
import pytest

import cadpanel as cp
from cadpanel.fitting.measures.verdict import limits_of
from cadpanel.solver.stop import Stop
from fixtures.arrays import reference
from fixtures.lips import Lip


def lip() -> cp.Reference:
    return reference(Lip(panels=12, twist=(1.0, -1.0)))


@pytest.mark.each_value_once
@pytest.mark.parametrize("steps", [1, 2, 5, 12])
@pytest.mark.parametrize("how", [{}, {"gap_tolerance": 0.01}, {"drift_along": 0.01, "drift_across": 0.005}])
def test_whenever_it_is_told_to_end_every_limit_but_gaps_holds(steps, how):
    told = []

    def progress(*args):
        told.append(args)
        return len(told) < steps

    result = cp.fit(lip(), progress=progress, **how)
    assert len(told) == steps
    for limit, allowed in limits_of(result.settings):
        assert limit.kept(result.measures, allowed).all(), limit.name
    assert result.stopped is Stop.TOLD
    if not result.tolerance_met:
        sentence = result.shortfall()
        assert sentence is not None
        assert sentence.endswith(Stop.TOLD.value)


def test_every_step_tells_the_method_its_number_the_excess_and_the_deviation():
    told = []
    result = cp.fit(lip(), progress=lambda *args: told.append(args))
    assert {method for method, *_ in told} == {"concurrent"}
    assert told[-1][2] <= 1.0 + 1e-6
    assert told[-1][3] == pytest.approx(result.measures.overall_rms, rel=1e-2)
    assert np.all(np.diff([count for _, count, *_ in told[:3]]) == 1)


def test_time_that_is_over_at_once_still_gives_panels_that_keep_their_limits():
    result = cp.fit(lip(), time_limit=1e-6)
    assert result.stopped is Stop.TOLD
    for limit, allowed in limits_of(result.settings):
        assert limit.kept(result.measures, allowed).all()
    assert cp.fit(lip(), time_limit=1e6).stopped is Stop.HELD


def test_an_automatic_choice_ends_in_time_too():
    result = cp.fit(reference(Lip(panels=3)), feature="auto", max_deviation=20.0, time_limit=1e-6)
    assert result.stopped is Stop.TOLD
    assert result.seconds < 60.0


@pytest.mark.parametrize("seconds", [0.0, -1.0, float("nan")])
def test_a_time_limit_that_is_none_is_refused(seconds):
    with pytest.raises(cp.SettingsError, match="time limit"):
        cp.fit(lip(), time_limit=seconds)
