"""Panels by words."""

from cadpanel.reference.named import meant_by, near_names

NAMES = ["NW-01", "NW-02", "NW-1*", "SE [3]"]


def test_a_star_stands_for_anything_and_no_other_sign_does() -> None:
    assert meant_by("NW-0*", NAMES) == ["NW-01", "NW-02"]
    assert meant_by("*", NAMES) == NAMES
    assert meant_by("SE [3]", NAMES) == ["SE [3]"]
    assert meant_by("NW-0[12]", NAMES) == meant_by("nw-01", NAMES) == []


def test_a_name_as_it_is_written_counts_before_what_its_star_stands_for() -> None:
    assert meant_by("NW-1*", [*NAMES, "NW-11"]) == ["NW-1*"]


def test_names_are_near_whatever_their_case_and_the_first_one_if_none_is() -> None:
    assert near_names("nw-03", NAMES)[0] in ("NW-01", "NW-02")
    assert near_names("quite another", NAMES) == ["NW-01"]
