"""Panels are chosen by name, with * for anything."""

import pytest

from cadpanel.delivery.chosen_panels import chosen_panels
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
