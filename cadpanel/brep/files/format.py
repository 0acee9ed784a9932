"""What every format does: tell its files by their first bytes, check their text, and read them into a model."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from cadpanel.brep.files.model import Model


@dataclass(frozen=True, slots=True, kw_only=True)
class Format:
    """One file format.

    Attributes:
        name: what users call it.
        suffixes: usual endings of its files, lower case.
        recognises: whether the first bytes of a file are of this format.
        check: refuses a file by its text alone, before the kernel sees it: told the path and all bytes.
        read: reads a file into a model: told the path, and how many mm the unit has that the user gives (None: he gives
            none), which counts for a file without one of its own. Runs in a guarded interpreter of its own, as the
            kernel may crash over a damaged file.
    """

    name: str
    suffixes: tuple[str, ...]
    recognises: Callable[[bytes], bool]
    check: Callable[[Path, bytes], None]
    read: Callable[[Path, float | None], Model]


def check_nothing(_path: Path, _text: bytes) -> None:
    """For a format whose text shows nothing that its reader would not find."""
