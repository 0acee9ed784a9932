"""What every point of a study promises: never worse than a fit of its own, nor than what its neighbours know."""

from dataclasses import replace
from functools import cache
from itertools import pairwise

import numpy as np
import pytest

from cadpanel.errors import PanelError, SettingsError
from cadpanel.fitting.baselines import Baselines
from cadpanel.fitting.run import fit
from cadpanel.fitting.settings import FitSettings
from cadpanel.studies import held_points
from cadpanel.studies.held_points import better, fit_points, judged_by
from fixtures.arrays import reference as sampled_lip
from fixtures.lips import Lip

GAPS = (10.0, 0.5, 2.0)
ROUNDING = 1.0 + 2e-6


@cache
def lip():
    """A lip that resists: closing its seams costs several times the local deviation."""
    return sampled_lip(Lip(panels=4, twist=(3.0, 5.0), radius=(300.0, 260.0), plan=(3.0,), rise=(1.0,)))


@cache
def points():
    return fit_points(lip(), [FitSettings(gap_tolerance=gap) for gap in GAPS])


@cache
def cold(gap):
    return fit(lip(), FitSettings(gap_tolerance=gap))


def test_points_go_from_tight_to_wide_and_are_judged_by_their_own_gap():
    assert [point.settings.gap_tolerance for point in points()] == sorted(GAPS)
    for point in points():
        assert point.result is not None
        assert point.result.settings == point.settings
        if point.result.tolerance_met:
            assert point.result.measures.max_seam_gap <= point.settings.gap_tolerance


def test_no_point_is_worse_than_a_fit_of_its_own():
    for point in points():
        alone = cold(point.settings.gap_tolerance)
        assert point.result is not None
        assert point.result.tolerance_met or not alone.tolerance_met
        if alone.tolerance_met:
            assert point.result.measures.overall_rms <= alone.measures.overall_rms * ROUNDING


def test_a_wider_gap_is_never_worse():
    held = [point.result.measures.overall_rms for point in points() if point.result and point.result.tolerance_met]
    assert len(held) >= 2
    assert all(second <= first * ROUNDING for first, second in pairwise(held))


def test_going_on_from_an_answer_ends_where_that_is_kept_or_bettered():
    tight = cold(2.0)
    warm = fit(lip(), FitSettings(gap_tolerance=10.0), after=tight)
    assert warm.tolerance_met
    assert warm.measures.overall_rms <= tight.measures.overall_rms * ROUNDING
    again = fit(lip(), FitSettings(gap_tolerance=2.0), after=tight)
    assert again.tolerance_met
    assert again.measures.overall_rms == pytest.approx(tight.measures.overall_rms, rel=0.02)


def test_a_fit_goes_on_only_from_one_of_the_same_panels_and_features():
    for how, after in (
        (FitSettings(feature="plane-cylinder-plane"), cold(2.0)),
        (FitSettings(tilt="fixed"), cold(2.0)),
        (FitSettings(), replace(cold(2.0), reference=replace(lip()))),
    ):
        with pytest.raises(SettingsError, match="the same reference with the same feature and tilt"):
            fit(lip(), how, after=after)
    for how in (FitSettings(method="two_stage"), FitSettings(feature="auto", max_deviation=50.0)):
        with pytest.raises(SettingsError, match="only a concurrent fit of one feature"):
            fit(lip(), how, after=cold(2.0))


def test_the_better_of_two_holds_or_exceeds_less_or_is_closer():
    good = cold(2.0)
    worse = replace(good, measures=replace(good.measures, overall_rms=good.measures.overall_rms * 1.1))
    open_one = replace(worse, tolerance_met=False)
    wider = replace(open_one, measures=replace(open_one.measures, seam_gap=open_one.measures.seam_gap + 5.0))
    ranked = [good, worse, open_one, wider]
    for place, result in enumerate(ranked):
        assert [better(result, other) for other in ranked] == [other > place for other in range(len(ranked))]
    close = replace(good, measures=replace(good.measures, overall_rms=good.measures.overall_rms * (1.0 - 1e-9)))
    assert not better(close, good)


def test_an_answer_is_judged_anew_under_other_tolerances():
    tight = cold(2.0)
    wide = judged_by(tight, FitSettings(gap_tolerance=10.0))
    assert wide.tolerance_met
    assert wide.gap_price is None
    np.testing.assert_array_equal(wide.unknowns, tight.unknowns)
    assert not judged_by(tight, FitSettings(gap_tolerance=0.5)).tolerance_met
    assert isinstance(wide.baselines, Baselines)
    assert wide.baselines.settings.gap_tolerance == 10.0
    assert wide.two_stage.overall_rms == pytest.approx(tight.two_stage.overall_rms)


def test_a_feature_that_cannot_follow_refuses_its_points_with_the_sentence(monkeypatch):
    def refuse(*_):
        raise PanelError("N-01", "no cone comes near it")

    monkeypatch.setattr(held_points, "fit", refuse)
    refused = fit_points(lip(), [FitSettings(gap_tolerance=gap) for gap in (1.0, 2.0)])
    assert [point.result for point in refused] == [None, None]
    assert all("no cone comes near it" in point.refused for point in refused)
