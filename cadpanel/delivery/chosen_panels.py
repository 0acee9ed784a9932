"""Which of the panels are delivered."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from difflib import get_close_matches
from fnmatch import fnmatchcase
from glob import escape

from cadpanel.errors import SettingsError


def chosen_panels(names: Sequence[str], only: Sequence[str]) -> tuple[str, ...]:
    """The names that are asked for, in their own order; all where nothing is.

    A name that is written as it is asked for counts before what * would stand for.

    Raises:
        SettingsError: a word fits none of them.
    """
    if not only:
        return tuple(names)
    taken: set[str] = set()
    for word in only:
        pattern = escape(word).replace("[*]", "*")  # no other sign stands for anything
        fitting = {word} & set(names) or {name for name in names if fnmatchcase(name, pattern)}
        if not fitting:
            alike = {name.casefold(): name for name in names}
            near = get_close_matches(word.casefold(), alike, n=1) or list(alike)[:1]
            raise SettingsError(f"there is no panel '{word}' to deliver; there is '{alike[near[0]]}', for example")
        taken |= fitting
    return tuple(name for name in names if name in taken)


def names_along(names: Iterable[str], most: int) -> tuple[str, ...]:
    """Every name that panels along the same strips may have where their number, at most `most`, is not known yet.

    Numbers stand behind the last hyphen of a name, and have as many digits as that of the panels, two at least.
    """
    strips = dict.fromkeys(name.rpartition("-")[0] for name in names)
    lengths = range(2, max(2, len(str(most))) + 1)
    found = (f"{strip}-{place:0{digits}d}" for strip in strips for digits in lengths for place in range(1, most + 1))
    return tuple(dict.fromkeys(found))
