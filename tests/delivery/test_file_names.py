"""Names of files that every system takes, of which no two are the same file anywhere."""

import unicodedata

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cadpanel.delivery.file_names import file_names


def key(name):
    return unicodedata.normalize("NFC", unicodedata.normalize("NFD", name).casefold())


@pytest.mark.parametrize(
    ("name", "safe"),
    [
        ("NW-01", "NW-01"),
        ("a/b\\c:d", "a_b_c_d"),
        ('<>"|?*', "______"),
        ("con", "con_"),
        ("Con.panel", "Con.panel_"),
        ("COM1", "COM1_"),
        ("lpt\u00b2", "lpt\u00b2_"),
        ("console", "console"),
        ("trailing. .", "trailing___"),
        (".hidden", "_hidden"),
        ("..", "_"),
        (" ", "_"),
        ("tab\there", "tab_here"),
        ("Dach S\u00fcd", "Dach S\u00fcd"),
        ("u\u0308ber", "\u00fcber"),
        ("\u200bzero", "_zero"),
    ],
)
def test_a_name_becomes_safe(name, safe):
    assert file_names([name], 80) == [safe]


def test_names_that_differ_by_case_or_accents_only_get_numbers():
    assert file_names(["wall", "WALL", "Wall"], 80) == ["wall", "WALL-2", "Wall-3"]
    assert file_names(["\u00fc", "U\u0308"], 80) == ["\u00fc", "\u00dc-2"]
    assert file_names(["a/b", "a_b", "a?b"], 80) == ["a_b-2", "a_b", "a_b-3"]


def test_a_number_never_takes_the_name_of_another_panel():
    assert file_names(["wall", "WALL", "wall-2"], 80) == ["wall", "WALL-3", "wall-2"]
    assert file_names(["All"], 80, taken=["all"]) == ["All-2"]


def test_long_names_are_cut_and_stay_different():
    found = file_names(["panel-number-1", "panel-number-2"], 8)
    assert found == ["panel-nu", "panel--2"]
    assert [len(name) for name in file_names(["\u7a97" * 100], 120)] == [66]


@given(st.lists(st.text(max_size=12), max_size=12, unique=True), st.integers(8, 20))
def test_no_two_names_are_one_file(names, longest):
    found = file_names(names, longest, taken=["all"])
    assert len({key(name) for name in [*found, "all"]}) == len(names) + 1
    for name in found:
        assert 1 <= len(name) <= longest
        assert not set(name) & set('<>:"/\\|?*')
        assert name == name.strip(". ")
        assert name.split(".")[0].lower() not in {"con", "aux", "nul", "prn", "com1", "lpt9"}
