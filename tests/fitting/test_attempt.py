"""Fits of one reference with these features or with those."""

from __future__ import annotations

import numpy as np
import pytest

from cadpanel.errors import PanelError
from cadpanel.features.catalogue import feature
from cadpanel.fitting.attempt import Attempts
from cadpanel.fitting.methods.local import fit_local
from cadpanel.fitting.run import fit
from cadpanel.fitting.settings import FitSettings
from tests.instances import random_shapes
from tests.known_panels import alone

NAME = "plane-cone-plane"


@pytest.fixture(scope="module")
def known():
    return alone(*random_shapes(feature(NAME), 3, 2))


def attempts(reference, **changes):
    return Attempts(reference, FitSettings(feature=NAME, **changes), None, None)


@pytest.mark.parametrize("method", ["local", "concurrent"])
def test_an_attempt_is_the_fit_with_those_features(known, method):
    found = attempts(known, method=method).fit([feature(NAME)] * 2)
    same = fit(known, FitSettings(feature=NAME, method=method))
    assert found.measures.overall_rms == pytest.approx(same.measures.overall_rms, abs=1e-12)
    assert found.measures.max_deviation.max() <= 1e-4


def test_panels_whose_local_fits_are_known_need_no_other(known):
    run = attempts(known)
    problem, starts = run.posed([feature(NAME)] * 2)
    unknowns = fit_local(problem, known, starts).unknowns
    for found in (run.fit_together(problem, unknowns), run.try_together(problem, unknowns)):
        assert found.tolerance_met
        assert found.measures.max_deviation.max() <= 1e-4


def test_local_fits_that_are_none_are_refused(known):
    run = attempts(known)
    problem, starts = run.posed([feature(NAME)] * 2)
    unknowns = fit_local(problem, known, starts).unknowns
    unknowns[1, 1] += 0.5
    with pytest.raises(PanelError, match="comes near it"):
        run.try_together(problem, unknowns)


def test_time_is_over_when_somebody_says_so(known):
    run = Attempts(known, FitSettings(feature=NAME), lambda *_: False, None)
    assert not run.over
    run.fit([feature(NAME)] * 2)
    assert run.over


def test_time_is_over_when_it_is(known):
    run = Attempts(known, FitSettings(feature=NAME), None, 0.0)
    result = run.fit([feature(NAME)] * 2)
    assert run.over
    assert np.isfinite(result.measures.overall_rms)
