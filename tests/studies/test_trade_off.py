"""All combinations of a study, in order, with their knees."""

from dataclasses import replace
from functools import cache

import pytest

from cadpanel.errors import SettingsError
from cadpanel.fitting.rules.book import rules_of
from cadpanel.fitting.settings import FitSettings, Weights
from cadpanel.studies.prepared import unprepared
from cadpanel.studies.trade_off import trade_off
from tests.delivered import strip
from tests.thorough import thorough

FEATURES = ("plane-cylinder-plane", "plane-cone-plane")
GAPS = (0.5, 3.0)


@cache
def study():
    every = [FitSettings(feature=feature, gap_tolerance=gap) for gap in GAPS for feature in FEATURES]
    other = replace(strip(), source="other.step")
    return trade_off([strip, lambda: other], every)


@thorough
def test_every_combination_is_there_once_and_in_order():
    found = [(point.reference.source, point.settings.feature, point.settings.gap_tolerance) for point in study()]
    assert found == [
        (source, feature, gap) for source in (strip().source, "other.step") for feature in FEATURES for gap in GAPS
    ]


def test_progress_is_told_as_each_fit_begins_and_goes_on():
    told = []
    trade_off([strip], [FitSettings()], lambda how, _, step, *__: told.append((how.widest_gap, step)))
    assert told[0] == (3.0, 0)
    assert len(told) > 1


def test_no_settings_and_weights_make_no_study():
    with pytest.raises(SettingsError, match="at least one gap"):
        trade_off([strip], [])
    with pytest.raises(SettingsError, match="whose place weights would take"):
        trade_off([strip], [FitSettings(weights=Weights())])


@thorough
def test_two_gaps_make_no_knee():
    assert not any(point.knee for point in study())


def test_every_point_holds_the_rules_and_rules_learn_of_the_reference():
    rules = rules_of({"seam": [{"between": ["N 1", "N 2"], "step": 0.3}]})
    prepared = []

    def prepare(how, reference):
        prepared.append(reference.source)
        return replace(unprepared(how, reference), rules=rules)

    points = trade_off([strip], [FitSettings(gap_tolerance=gap) for gap in GAPS], prepare=prepare)
    assert prepared == [strip().source] * 2
    results = [point.result for point in points if point.result is not None]
    assert [result.tolerance_met and result.outcomes[0].kept for result in results] == [True, True]
