"""The paper's Table 1 under rules."""

from __future__ import annotations

from dataclasses import replace

from cadpanel.fitting.rules.book import rules_of
from cadpanel.fitting.settings import LIKE_THE_PAPER
from cadpanel.studies.table1 import compare
from tests.delivered import strip


def test_rules_are_held_by_the_fit_of_all_panels_at_once_and_measured_of_the_others() -> None:
    rules = rules_of(
        {
            "equal": [{"panels": "*", "radius": True}],
            "feature": [{"panels": "N 2", "feature": "plane-cylinder-plane"}],
        }
    )
    columns = compare(strip(), replace(LIKE_THE_PAPER, rules=rules))
    for column in columns:
        (feature, equal) = column.outcomes
        assert feature.kept
        assert column.shapes[1].feature == "plane-cylinder-plane"
        assert equal.kept is (column.settings.method == "concurrent")
        assert equal.kept or not column.tolerance_met
