"""Things that have names: the one of a name, or what to say of a name that there is not."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from difflib import get_close_matches
from typing import Protocol, TypeVar

_MOST, _LIKE = 3, 0.6


class Named(Protocol):
    """A panel, of a reference or of a result."""

    @property
    def name(self) -> str:
        """What it is called."""


Panel = TypeVar("Panel", bound=Named)


def panel_named(name: str, panels: Sequence[Panel]) -> Panel:
    """The panel of a name.

    Raises:
        KeyError: there is none; the message names those that are nearly like it.
    """
    names = [panel.name for panel in panels]
    if not isinstance(name, str):  # a place, most often: panels have none that a file would keep
        raise KeyError(f"a panel is found by its name, not by {name!r:.80}; {near_names('', names)}")
    for panel in panels:
        if panel.name == name:
            return panel
    raise KeyError(f"there is no panel '{name}'; {near_names(name, names)}")


def holds(thing: object, panels: Sequence[Named]) -> bool:
    """Whether a panel, or one of that name, is among some."""
    return any(panel is thing or (isinstance(thing, str) and panel.name == thing) for panel in panels)


def near_names(name: str, names: Iterable[str]) -> str:
    """Which of the names may be meant, as the end of a sentence; the first of them where none is like it."""
    known = list(names)
    folded = {one.casefold(): one for one in reversed(known)}
    like = [folded[one] for one in get_close_matches(name.casefold(), folded, _MOST, _LIKE)]
    if like:
        return f"perhaps {' or '.join(_quoted(like))} is meant"
    shown = _quoted(known[:_MOST])
    more = f" and {len(known) - _MOST} more" if len(known) > _MOST else ""
    return f"there is {', '.join(shown)}{more}" if shown else "there is none at all"


def _quoted(names: list[str]) -> list[str]:
    return [f"'{name}'" for name in names]
