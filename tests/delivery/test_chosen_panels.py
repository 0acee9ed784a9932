"""Panels are chosen by name, with * for anything."""

import pytest

from cadpanel.delivery.chosen_panels import chosen_panels, names_along
from cadpanel.errors import SettingsError

NAMES = ["NW-01", "NW-02", "SE-01", "a*", "ab"]


@pytest.mark.parametrize(
    ("only", "chosen"),
    [
        ((), NAMES),
        (("SE-01", "NW-01"), ["NW-01", "SE-01"]),
        (("NW-*",), ["NW-01", "NW-02"]),
        (("*-01", "NW-01"), ["NW-01", "SE-01"]),
        (("a*",), ["a*"]),
        (("*",), NAMES),
    ],
)
def test_names_are_taken_in_their_own_order(only, chosen):
    assert list(chosen_panels(NAMES, only)) == chosen


@pytest.mark.parametrize("word", ["NW-03", "NW-0?", "nw-01", "N[W]-01"])
def test_a_word_that_fits_no_panel_is_refused_with_one_that_is_like_it(word):
    with pytest.raises(SettingsError, match=r"there is no panel '.*' to deliver; there is 'NW-0\d'"):
        chosen_panels(NAMES, ["NW-01", word])


@pytest.mark.parametrize("word", ["S1-12", "S2-07", "S1-105", "S1-007", "*-03"])
def test_names_of_panels_whose_number_is_not_known_yet_are_all_that_there_may_be(word):
    assert chosen_panels(names_along(["S1-01", "S1-02", "S2-01"], 200), [word])


@pytest.mark.parametrize("word", ["S1-201", "S3-01", "S1-00", "S1-1"])
def test_a_name_that_no_number_of_panels_gives_is_refused(word):
    with pytest.raises(SettingsError, match="there is no panel"):
        chosen_panels(names_along(["S1-01", "S1-02", "S2-01"], 200), [word])
