"""One run at a time writes into the folder of a job: another would take its summary and its assembly away."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from cadpanel.errors import DeliveryError

LOCK = ".cadpanel-lock"
"""Hidden in the folder while a run is at it; that it is there says nothing, as the system holds the lock on it."""


@contextmanager
def alone(out: Path) -> Iterator[None]:
    """Let no other run write into a folder while the block runs; the folder is made if it is not there.

    A run that is killed leaves the file, but no lock.

    Raises:
        DeliveryError: another run is at it, or nothing can be written there.
    """
    path = out / LOCK
    try:
        out.mkdir(parents=True, exist_ok=True)
        handle = _locked(path)
    except OSError as error:
        raise DeliveryError(f"'{out}' cannot be written: {error.strerror or error}.") from error
    if handle is None:
        raise DeliveryError(f"another run writes into '{out}' now: wait until it has ended, or name another folder.")
    try:
        yield
    finally:
        if os.name == "nt":
            os.close(handle)  # an open file is not deleted there
        with suppress(OSError):
            path.unlink()
        if os.name != "nt":
            os.close(handle)  # only now: nobody else is to lock a file that is deleted next


def _locked(path: Path) -> int | None:
    """A handle of the file with the lock on it; None where another run has that."""
    while True:
        handle = os.open(path, os.O_RDWR | os.O_CREAT, 0o666)
        taken = _is_taken(handle)
        if _is_there(path, handle):
            if not taken:
                return handle
            os.close(handle)
            return None
        os.close(handle)


def _is_there(path: Path, handle: int) -> bool:
    """Whether the file of a handle is still the one in its place, and not one that its run has deleted meanwhile."""
    try:
        return os.path.samestat(os.fstat(handle), path.stat())
    except FileNotFoundError:
        return False


if sys.platform == "win32":
    from msvcrt import LK_NBLCK, locking

    def _lock(handle: int) -> None:
        """Lock a file, or raise a PermissionError where another has it."""
        locking(handle, LK_NBLCK, 1)
else:
    try:
        from fcntl import LOCK_EX, LOCK_NB, flock
    except ImportError:  # a system that knows no locks

        def _lock(handle: int) -> None:
            """Nothing."""
    else:

        def _lock(handle: int) -> None:
            """Lock a file as long as the handle is open, or raise a BlockingIOError where another has it."""
            flock(handle, LOCK_EX | LOCK_NB)


def _is_taken(handle: int) -> bool:
    """Whether another has the lock; else it is ours now."""
    try:
        _lock(handle)
    except (PermissionError, BlockingIOError):
        return True
    except OSError:
        return False  # a disk that knows no locks: a run there is as safe as it was without
    return False
