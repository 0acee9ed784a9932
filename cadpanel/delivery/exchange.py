"""Folders that take each other's place in one step, where the system can: no reader ever sees neither of them.

Linux exchanges two names by renameat2(2), macOS by renamex_np(2); elsewhere two renames have to do.
"""

from __future__ import annotations

import ctypes
import errno
import os
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path

_AT_CWD = -100
_NO_REPLACE = 1
_EXCHANGE = 2
_NOT_POSSIBLE = frozenset({errno.EINVAL, errno.ENOSYS, errno.ENOTSUP, errno.EPERM})
"""What a system, or a disk, says that cannot exchange."""
_KEEPS_ITSELF = frozenset({errno.EINVAL, errno.ENOTSUP, errno.EBADF})
"""What a shared disk says that takes no order to write a folder down: it does so when it likes."""

_Rename = Callable[[bytes, bytes, int], int]


def exchanged(one: Path, other: Path) -> bool:
    """Let two folders that are there take each other's name; False where the system or the disk cannot.

    Raises:
        OSError: it can, and does not, as one of them is not there, or writing is not permitted.
    """
    return _renamed(one, other, _EXCHANGE)


def put_where_nothing_is(folder: Path, place: Path) -> None:
    """Give a folder another name that nothing has.

    Raises:
        FileExistsError: something has it.
        OSError: it cannot be renamed.
    """
    if not _renamed(folder, place, _NO_REPLACE):
        if os.path.lexists(place):
            raise FileExistsError(errno.EEXIST, os.strerror(errno.EEXIST), str(folder), None, str(place))
        folder.rename(place)


def make_lasting(folder: Path) -> None:
    """See that a folder's files are on the disk, and not only on their way there, before it takes its place.

    Raises:
        OSError: a file cannot be written down. Of a folder it is passed over where the disk has no such order.
    """
    if os.name == "nt":
        return  # a folder cannot be opened there, and files are written through when they are closed
    for path in (*folder.rglob("*"), folder):
        if path.is_symlink():
            continue
        handle = os.open(path, os.O_RDONLY)
        try:
            os.fsync(handle)
        except OSError as error:
            if error.errno not in _KEEPS_ITSELF or not path.is_dir():
                raise
        finally:
            os.close(handle)


def _renamed(source: Path, destination: Path, how: int) -> bool:
    rename = _system_rename()
    if rename is None:
        return False
    if rename(os.fsencode(source), os.fsencode(destination), how) == 0:
        return True
    code = ctypes.get_errno()
    if code in _NOT_POSSIBLE:
        return False
    raise OSError(code, os.strerror(code), str(source), None, str(destination))


@cache
def _system_rename() -> _Rename | None:
    """The system's own call; None where it has none."""
    if os.name == "nt":
        return None
    library = ctypes.CDLL(None, use_errno=True)
    if sys.platform == "darwin" and hasattr(library, "renamex_np"):
        flags = {_EXCHANGE: 0x2, _NO_REPLACE: 0x4}
        return lambda source, destination, how: int(library.renamex_np(source, destination, flags[how]))
    if hasattr(library, "renameat2"):
        return lambda source, destination, how: int(library.renameat2(_AT_CWD, source, _AT_CWD, destination, how))
    return None
