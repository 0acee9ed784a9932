"""What a result is held against is fitted and measured by whoever asks for it, once, and by nobody else."""

import pickle

import numpy as np
import pytest

from cadpanel.delivery.deliver import deliver
from cadpanel.fitting import attempt, baselines
from cadpanel.fitting.measures.fit import measure
from cadpanel.fitting.methods.catalogue import TWO_STAGE
from cadpanel.fitting.methods.two_stage import TwoStage
from cadpanel.fitting.run import fit
from cadpanel.fitting.settings import FitSettings
from cadpanel.fitting.shapes import panel_shapes
from cadpanel.studies.table1 import compare
from fixtures.arrays import reference
from tests.benchmarks.strips import long_lip

STRIP = reference(long_lip(2))


@pytest.fixture
def counted(monkeypatch):
    """How often a result was measured, something was measured to hold it against, and two stages were fitted."""
    counts = {"results": 0, "baselines": 0, "two_stage": 0}

    def counting(name, called):
        def call(*args, **kwargs):
            counts[name] += 1
            return called(*args, **kwargs)

        return call

    monkeypatch.setattr(attempt, "measure", counting("results", measure))
    monkeypatch.setattr(baselines, "measure", counting("baselines", measure))
    monkeypatch.setattr(TwoStage, "fit", counting("two_stage", TwoStage.fit))
    return counts


def test_a_fit_measures_its_result_alone(counted):
    fit(STRIP)
    assert counted == {"results": 1, "baselines": 0, "two_stage": 0}


def test_whoever_asks_twice_has_it_measured_once(counted):
    result = fit(STRIP)
    assert result.local is result.local
    assert counted == {"results": 1, "baselines": 1, "two_stage": 0}
    assert result.two_stage is result.two_stage
    assert counted == {"results": 1, "baselines": 2, "two_stage": 1}


def test_a_delivery_shows_both(counted, tmp_path):
    result = fit(STRIP)
    report = deliver(result, tmp_path / "out")
    assert counted == {"results": 1, "baselines": 2, "two_stage": 1}
    assert report.baselines.local.rms_deviation == result.local.overall_rms
    assert report.baselines.two_stage.max_corner_gap == result.two_stage.max_corner_gap
    assert report.timing.fit > result.seconds


def test_what_is_chosen_automatically_is_held_against_nothing_on_the_way(counted):
    """A limit that closing the seams breaks has several candidates fitted one after the other."""
    fit(STRIP, FitSettings(feature="auto", max_deviation=20.0, gap_tolerance=1.0))
    assert counted["results"] > 1
    assert (counted["baselines"], counted["two_stage"]) == (0, 0)


def test_a_study_has_two_stages_fitted_only_where_they_are_its_columns(counted):
    columns = compare(STRIP)
    asked = [result.settings.method for result in columns].count("two_stage")
    assert counted == {"results": len(columns), "baselines": 0, "two_stage": asked}


@pytest.mark.parametrize("method", ["local", "two_stage"])
def test_a_result_that_is_a_baseline_itself_is_not_measured_again(counted, method):
    result = fit(STRIP, FitSettings(method=method))
    assert getattr(result, method) is result.measures
    assert counted == {"results": 1, "baselines": 0, "two_stage": int(method == "two_stage")}


def test_two_stages_begin_from_the_local_fits():
    result = fit(STRIP)
    of = result.baselines
    assert isinstance(of, baselines.Baselines)
    staged = TWO_STAGE.fit(of.problem, [of.alone], result.settings)
    assert np.array_equal(result.two_stage.seam_gap, measure(panel_shapes(of.problem, staged.unknowns), STRIP).seam_gap)
    assert np.array_equal(result.local.seam_gap, measure(panel_shapes(of.problem, of.alone), STRIP).seam_gap)
    assert not np.array_equal(result.two_stage.seam_gap, result.local.seam_gap)


@pytest.mark.parametrize("asked", [False, True])
def test_a_result_that_was_put_away_is_held_against_the_same(asked):
    result = fit(STRIP)
    expected = result.two_stage.seam_gap if asked else None
    again = pickle.loads(pickle.dumps(result))
    assert np.array_equal(again.measures.seam_gap, result.measures.seam_gap)
    assert np.array_equal(again.two_stage.seam_gap, result.two_stage.seam_gap if expected is None else expected)
    assert np.array_equal(again.local.seam_gap, result.local.seam_gap)
