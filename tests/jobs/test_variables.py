from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cadpanel.errors import SettingsError
from cadpanel.jobs.variables import escaped, names_in, substituted

KNOWN = {"n": 3, "folder": "a/b", "grid": [2, 4], "on": True}
VALUES = st.recursive(
    st.text("${}a") | st.integers() | st.booleans(),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text("${}a"), inner, max_size=3),
    max_leaves=6,
)


@given(VALUES)
def test_what_is_escaped_means_itself_whatever_stands_in_it(value: object) -> None:
    assert substituted(escaped(value), {}) == value
    assert list(names_in(escaped(value))) == []


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


def test_the_names_that_a_value_needs_are_those_without_which_it_is_refused() -> None:
    value = {"x": ["${n}", 1.5, "$${on}"], "y": {"z": "${folder}/${n}"}}
    names = list(names_in(value))
    assert names == ["n", "folder", "n"]
    for name in names:
        with pytest.raises(SettingsError, match=f"no variable '{name}'"):
            substituted(value, {other: 1 for other in names if other != name})


def test_a_variable_that_there_is_not_is_refused_with_the_nearest_or_with_where_it_is() -> None:
    with pytest.raises(SettingsError, match="no variable 'foldr'; perhaps 'folder' is meant"):
        substituted("${foldr}", KNOWN)
    with pytest.raises(SettingsError, match="it is elsewhere"):
        substituted("${foldr}", KNOWN, {"foldr": "it is elsewhere"})
    assert substituted("${n}", KNOWN, {"n": "it is elsewhere"}) == 3
