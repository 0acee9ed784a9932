"""How an interpreter ends with the one that asked it, while it loads or works and the kernel gives Python no turn.

Between requests it waits for the next one, and sees the end of its input. While it works, nobody writes to it: whatever
then happens at its input is that the other end is closed, as the one that asked is gone. While it loads, the same goes
for its output. Linux tells that by a signal, and nothing but the system has to act on it. Elsewhere it ends when it has
loaded, or when the time is over that a request may take.
"""

from __future__ import annotations

import os
import select
import sys
from collections.abc import Iterator
from contextlib import contextmanager

try:
    import fcntl
except ImportError:
    WATCHES = False  # on Windows
else:
    WATCHES = sys.platform.startswith("linux")
    """Whether the system tells."""


@contextmanager
def ends_with_whoever_asked(handle: int) -> Iterator[None]:
    """End this process as soon as the other end of a pipe is closed, for as long as this lasts.

    Args:
        handle: this process's end of the pipe; nothing must go through it meanwhile.
    """
    if not WATCHES:
        yield
        return
    usual = fcntl.fcntl(handle, fcntl.F_GETFL)
    fcntl.fcntl(handle, fcntl.F_SETOWN, os.getpid())
    fcntl.fcntl(handle, fcntl.F_SETFL, usual | os.O_ASYNC)
    try:
        if _is_closed(handle):  # before the system was asked to tell
            os._exit(1)
        yield
    finally:
        fcntl.fcntl(handle, fcntl.F_SETFL, usual)


def _is_closed(handle: int) -> bool:
    """Whether nobody holds the other end any more: one that is read from hangs up, one that is written to fails."""
    poll = select.poll()
    poll.register(handle, select.POLLIN)
    return any(event & (select.POLLHUP | select.POLLERR) for _, event in poll.poll(0))
