"""Names of regions: every one can be that of a folder, no two are the same, and plain ones are told as they are."""

from __future__ import annotations

import unicodedata
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cadpanel.delivery.file_names import file_names
from cadpanel.jobs.names import LONGEST, RESERVED, combinations, first_fault, variant_names

WORDS = st.text('aAbB1/\\*:"<>|?. \u00e9\u0301\x00\n', max_size=6) | st.text("a", min_size=100, max_size=200)
VALUES = st.lists(WORDS | st.integers(0, 9) | st.lists(WORDS, max_size=2), min_size=1, max_size=4, unique_by=repr)
MATRICES = st.dictionaries(WORDS, VALUES, min_size=1, max_size=2)


def folded(name: str) -> str:
    return unicodedata.normalize("NFC", unicodedata.normalize("NFD", name).casefold())


def names_of(region: str, matrix: dict[str, list[Any]]) -> list[str]:
    return variant_names([f"{region}{ending}" for ending, _ in combinations(matrix)], RESERVED)


@given(MATRICES)
def test_every_combination_can_have_a_folder_of_its_own(matrix: dict[str, list[Any]]) -> None:
    names = names_of("NW", matrix)
    assert all(file_names([name], LONGEST, RESERVED) == [name] for name in names)
    assert len({folded(name) for name in names}) == len(names)
    assert names == names_of("NW", matrix)


@given(st.lists(st.integers(-9, 9) | st.floats(-9.0, 9.0) | st.text("abc", max_size=5), min_size=1, unique_by=str))
def test_values_that_files_can_be_called_by_are_told_as_they_are(values: list[Any]) -> None:
    values = [value for value in values if value != ""]
    assert names_of("NW", {"x": values}) == [f"NW-x={value}" for value in values]


def test_a_matrix_has_every_combination_once_and_each_a_name_of_its_own() -> None:
    found = list(combinations({"gap": [1, 3.5], "grid": [[2, 4], "2x5"]}))
    assert [name for name, _ in found] == [
        "-gap=1-grid=2x4",
        "-gap=1-grid=2x5",
        "-gap=3.5-grid=2x4",
        "-gap=3.5-grid=2x5",
    ]
    assert found[2][1] == {"gap": 3.5, "grid": [2, 4]}
    assert list(combinations({})) == [("", {})]


def test_values_that_no_file_can_be_called_by_are_told_by_what_is_left_of_them() -> None:
    assert [name for name, _ in combinations({"reference": ["x.step", "sub/y.step"], "only": ["NW-*", "NW-?"]})] == [
        "-reference=x.step-only=NW-_",
        "-reference=x.step-only=NW-_-2",
        "-reference=sub_y.step-only=NW-_",
        "-reference=sub_y.step-only=NW-_-2",
    ]
    assert [name for name, _ in combinations({"rules": [{"shop": {"radii": [300, 350]}}]})] == [
        "-rules=shop_radii_300x350"
    ]


def test_of_a_name_that_is_too_long_the_end_is_a_sum_that_hangs_on_nothing_else() -> None:
    long = [f"{sign * 130}-x={number}" for sign in ("a", "\u00e9") for number in range(3)]
    names = variant_names(long, RESERVED)
    assert len(set(names)) == len(long)
    assert names == [variant_names([name], RESERVED)[0] for name in long]
    assert all(name[:80] == wanted[:80] for name, wanted in zip(names, long, strict=True))


@pytest.mark.parametrize(
    ("names", "place", "said"),
    [
        (["NW", "a/b"], 1, "'a/b' cannot have a folder of its name: call it 'a_b'"),
        (["..", "NW"], 0, "call it '_'"),
        (["NW", "E", "nw"], 2, "called as another one, where case does not count: call it 'nw-2'"),
        (["x" * (LONGEST + 1)], 0, "cannot have a folder"),
        *(([name.upper()], 0, "called as a file that stands beside the regions") for name in sorted(RESERVED)),
    ],
)
def test_names_that_cannot_be_are_told_with_one_that_can(names: list[str], place: int, said: str) -> None:
    found = first_fault(names, [True] * len(names))
    assert found is not None
    assert found[0] == place
    assert said in found[1]


def test_a_name_that_something_is_put_behind_need_not_be_free() -> None:
    names = ["NW", "nw", "job.toml"]
    assert first_fault(names, [True, False, False]) is None
    assert first_fault([*names, "a/b"], [False] * 4) is not None
