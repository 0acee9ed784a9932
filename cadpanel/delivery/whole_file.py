"""A file that is written whole or not at all: what stood there stays until the new one is on the disk."""

from __future__ import annotations

import os
import re
import secrets
from pathlib import Path

_DIGITS = 8


def write_whole(path: Path, data: bytes) -> None:
    """Write beside the file, and let that take its place.

    A run that is killed may leave what it wrote beside it: see `is_left_of`.

    Args:
        path: the file; an existing one is replaced.
        data: all that it shall hold.

    Raises:
        OSError: it cannot be written; what stood there is as it was, and nothing else is left.
    """
    work = path.with_name(f".{path.name}.{secrets.token_hex(_DIGITS // 2)}")
    try:
        with work.open("xb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())  # else a file may be empty after the power was cut, though it has its name
        work.replace(path)
    except BaseException:  # an interrupt must clean up as well
        work.unlink(missing_ok=True)
        raise


def is_left_of(name: str, path_names: frozenset[str]) -> bool:
    """Whether a file's name is one that is written to beside one of some files until that is whole."""
    found = re.fullmatch(rf"\.(?P<whole>.+)\.[0-9a-z_]{{{_DIGITS}}}", name)
    return found is not None and found["whole"] in path_names
