"""Arguments of another kind than their annotations say are refused, and everything that is one of theirs is taken."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, Literal, cast

import numpy as np
import pytest

from cadpanel.errors import SettingsError
from cadpanel.kinds import called, checked, fits

KINDS: list[tuple[Any, list[Any], list[Any]]] = [
    (float, [1, 1.5, np.float64(2.0), np.int64(3)], [True, "1", None, [1.0], 1j]),
    (int, [1, np.int64(3)], [True, 1.0, "1"]),
    (bool, [True], [1, "yes"]),
    (str | None, ["x", None], [b"x", 1]),
    (Path | str, [Path("x"), "x"], [1, b"x"]),
    (Literal["a", 2], ["a", 2], ["b", 2.0, True]),
    (Sequence[float], [[1.0], (1, 2), np.ones(3), range(3)], ["12", 1.0, [None], {1.0}, np.array(1.0)]),
    (tuple[str, float], [("a", 1.0), ["a", 2]], [("a",), (1.0, "a")]),
    (Mapping[str, float], [{}], [[]]),
    (Callable[..., None] | None, [print, None], [1]),
    (Any, [object()], []),
]


@pytest.mark.parametrize(("kind", "good", "bad"), KINDS)
def test_a_value_is_of_its_kind_or_not(kind, good, bad):
    assert [value for value in good if not fits(value, kind)] == []
    assert [value for value in bad if fits(value, kind)] == []
    assert "typing" not in called(kind) or kind is Any


@checked
def doubled(number: "float", words: "Sequence[str]" = ()) -> float:
    """What is annotated."""
    return 2.0 * number * max(len(words), 1)


@checked
def joined(*words: "str") -> str:
    """Of any number of words."""
    return "".join(words)


def test_any_number_of_arguments_are_each_of_the_kind_that_is_annotated():
    assert (joined(), joined("a", "b")) == ("", "ab")
    with pytest.raises(SettingsError, match=r"'words' of joined[(][)] must be a list, of which each is a word"):
        cast(Any, joined)("a", 2)


def test_a_function_refuses_in_one_sentence_and_stays_as_it_is():
    assert doubled(2, words=["a"]) == 4.0
    assert (doubled.__name__, doubled.__doc__) == ("doubled", "What is annotated.")
    with pytest.raises(SettingsError, match=r"^'number' of doubled\(\) must be a number, not '2'$"):
        doubled(cast(Any, "2"))
    with pytest.raises(SettingsError, match="must be a list, of which each is a word"):
        doubled(2, words="a")
    with pytest.raises(SettingsError, match=r"^doubled\(\) missing a required argument: 'number'$"):
        cast(Any, doubled)()
    with pytest.raises(SettingsError, match=r"unexpected keyword argument 'word'; perhaps 'words' is meant$"):
        cast(Any, doubled)(2, word=["a"])
