from __future__ import annotations

import pytest

from cadpanel.errors import SettingsError
from cadpanel.jobs.variables import combinations, resolved, substituted

KNOWN = {"n": 3, "folder": "a/b", "grid": [2, 4], "on": True}


@pytest.mark.parametrize(
    ("written", "meant"),
    [
        ("${n}", 3),
        ("${grid}", [2, 4]),
        ("${on}", True),
        ("${folder}/${n}.step", "a/b/3.step"),
        ("$${n} of $5", "${n} of $5"),
        ({"x": ["${n}", 1.5]}, {"x": [3, 1.5]}),
    ],
)
def test_a_variable_alone_keeps_its_type_and_in_a_text_is_text(written: object, meant: object) -> None:
    assert substituted(written, KNOWN) == meant


def test_a_variable_that_there_is_not_is_refused_with_the_nearest() -> None:
    with pytest.raises(SettingsError, match="no variable 'foldr'; perhaps 'folder' is meant"):
        substituted("${foldr}", KNOWN)


def test_variables_may_be_made_of_those_before_them_alone() -> None:
    assert resolved({"a": "x", "b": "${a}y", "c": "${b}z"})["c"] == "xyz"
    with pytest.raises(SettingsError):
        resolved({"b": "${a}", "a": "x"})


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
