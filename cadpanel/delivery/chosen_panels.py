"""Which of the panels are delivered."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from cadpanel.errors import SettingsError
from cadpanel.reference.named import meant_by, near_names


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
        fitting = meant_by(word, names)
        if not fitting:
            near = near_names(word, names, 1)[0]
            raise SettingsError(f"there is no panel '{word}' to deliver; there is '{near}', for example")
        taken |= set(fitting)
    return tuple(name for name in names if name in taken)


def names_along(names: Iterable[str], most: int) -> tuple[str, ...]:
    """Every name that panels along the same strips may have where their number, at most `most`, is not known yet.

    Numbers stand behind the last hyphen of a name, and have as many digits as that of the panels, two at least.
    """
    strips = dict.fromkeys(name.rpartition("-")[0] for name in names)
    lengths = range(2, max(2, len(str(most))) + 1)
    found = (f"{strip}-{place:0{digits}d}" for strip in strips for digits in lengths for place in range(1, most + 1))
    return tuple(dict.fromkeys(found))
