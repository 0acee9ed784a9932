"""On which line of a TOML file something stands, as no parser of Python's tells it.

The file is read anew up to one line and the next: a key stands on the line with which it first appears. So nothing here
knows the grammar, and dotted keys, inline tables and values over many lines are all the same.
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping, Sequence
from typing import Any


def line_of(text: str, path: Sequence[str]) -> int:
    """The line, counted from 1, of a key or table; of the table around it where it is not there.

    Args:
        text: a file that is TOML.
        path: the names of the tables from the outermost in, then that of the key.
    """
    lines = [f"{line}\n" for line in text.split("\n")]  # only these end a line for TOML, and for editors
    whole = tomllib.loads(text)
    known = list(path)
    while known and not _holds(whole, known):
        known.pop()
    if not known:
        return 1
    written = [number for number, line in enumerate(lines, 1) if known[-1] in line]
    for number in written or range(1, len(lines) + 1):  # a name may be written with escapes
        if _holds(_begun(lines, number), known):
            return number
    return 1


def _begun(lines: Sequence[str], number: int) -> Mapping[str, Any]:
    """What the lines up to that one hold; with those behind it that a value goes on in."""
    for end in range(number, len(lines) + 1):
        try:
            return tomllib.loads("".join(lines[:end]))
        except tomllib.TOMLDecodeError:
            continue
    return {}


def _holds(table: object, path: Sequence[str]) -> bool:
    for name in path:
        if not isinstance(table, Mapping) or name not in table:
            return False
        table = table[name]
    return True
