"""Panels by words: a name as it is written counts before what * in it would stand for."""

from __future__ import annotations

from collections.abc import Sequence
from difflib import get_close_matches
from fnmatch import fnmatchcase
from glob import escape

_MOST_NEAR = 3


def meant_by(word: str, names: Sequence[str]) -> list[str]:
    """The names that a word means, in their own order; none where it fits none."""
    pattern = escape(word).replace("[*]", "*")  # no other sign stands for anything
    return [name for name in names if name == word] or [name for name in names if fnmatchcase(name, pattern)]


def near_names(word: str, names: Sequence[str], most: int = _MOST_NEAR) -> list[str]:
    """The names most like a word that fits none, or the first of all where none is like it."""
    alike = {name.casefold(): name for name in reversed(names)}
    near = get_close_matches(word.casefold(), alike, n=most)
    return [alike[one] for one in near] or list(names[:1])
