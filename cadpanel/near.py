"""What to say of a name that there is not: those that are nearly like it."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches

_MOST, _LIKE = 3, 0.6


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
