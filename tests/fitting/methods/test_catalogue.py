"""The catalogue of methods: which names there are, and which method rules where the user gives weights."""

from typing import get_args

import numpy as np
import pytest

from cadpanel.fitting.baselines import Baselines
from cadpanel.fitting.methods.catalogue import LOCAL, METHODS, TWO_STAGE, method_for
from cadpanel.fitting.methods.concurrent import Concurrent
from cadpanel.fitting.methods.method import Fitted, Method
from cadpanel.fitting.methods.weighted import Weighted
from cadpanel.fitting.run import fit
from cadpanel.fitting.settings import FitSettings, Weights
from cadpanel.fitting.settings import Method as MethodName
from cadpanel.solver.stop import Stop
from tests.known_panels import alone
from tests.shapes import folded_panel


def test_settings_and_catalogue_know_the_same_methods():
    assert tuple(METHODS) == get_args(MethodName)


@pytest.mark.parametrize("name", METHODS)
def test_every_method_has_one_name_and_is_its_own_equal(name):
    assert isinstance(METHODS[name], Method)
    assert METHODS[name] == type(METHODS[name])()
    assert [other for other, method in METHODS.items() if method == METHODS[name]] == [name]


def test_a_method_without_a_fit_cannot_be_made():
    class Unfinished(Method):
        pass

    with pytest.raises(TypeError, match="fit"):
        Unfinished()  # type: ignore[abstract]


def test_weights_take_the_place_of_the_tolerance_in_the_concurrent_method_alone():
    assert method_for(FitSettings()) == Concurrent()
    assert method_for(FitSettings(weights=Weights())) == Weighted()
    assert method_for(FitSettings(method="two_stage", weights=Weights())) is TWO_STAGE
    assert method_for(FitSettings(method="local")) is LOCAL


def test_a_method_of_ones_own_is_used_under_its_name(monkeypatch):
    """It begins from the local fits or what these began with, and what it gives is what is measured."""
    told = []

    class Shifted(Method):
        def fit(self, problem, starts, settings, progress=None):
            del settings
            assert progress is not None
            progress(1, 0.5, 7.5)
            told.extend(starts)
            moved = starts[0].copy()
            moved[:, 1] += 3.0 / problem.place.length
            return Fitted(moved, 7, Stop.STALLED)

    monkeypatch.setitem(METHODS, "concurrent", Shifted())
    rounds = []
    result = fit(alone(folded_panel()), progress=lambda *args: rounds.append(args))
    assert len(told) >= 2
    assert all(start.shape == told[0].shape for start in told)
    assert isinstance(result.baselines, Baselines)
    assert np.array_equal(told[0], result.baselines.alone)
    assert rounds == [("concurrent", 1, 0.5, 7.5)]
    assert (result.iterations, result.stopped) == (7, Stop.STALLED)
    assert result.measures.max_deviation == pytest.approx([3.0], abs=1e-3)
    assert result.local.max_deviation == pytest.approx([0.0], abs=1e-6)
