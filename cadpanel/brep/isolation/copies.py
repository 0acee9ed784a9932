"""A copy of the second interpreter that takes requests of its own, as one that is started anew would.

It begins within milliseconds, where an interpreter loads the kernel for two seconds, and shares with the one that was
copied whatever neither changes: about 170 MB. Who asks for it makes two pipes; the one that is copied opens its ends of
them by the numbers that they have there, which Linux allows to processes of the same user.
"""

from __future__ import annotations

import math
import os
import select
import signal
import subprocess
import traceback
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import BinaryIO, NamedTuple

from cadpanel.brep.isolation.beside import POSSIBLE, let_go_of_all_but


def _tells_of_an_end() -> bool:
    """Whether the system tells a process of the end of one that it has not made: older ones and some boxes do not."""
    if not hasattr(os, "pidfd_open"):
        return False
    try:
        os.close(os.pidfd_open(os.getpid()))
    except OSError:
        return False
    return True


COPYABLE = POSSIBLE and _tells_of_an_end()
Serve = Callable[[BinaryIO, BinaryIO], None]
"""Answers requests, one after the other, until none comes."""
_COPIES: list[int] = []
"""Processes that this one has made and that may have to be seen off."""


class Ends(NamedTuple):
    """The ends of pipes that a copy is to use, by their numbers in the process that asks for it."""

    process: int
    requests: int
    answers: int


def serving_copy(ends: Ends, serve: Serve) -> int:
    """Make a copy of this process that serves; returns which process it is.

    Raises:
        OSError: the pipes cannot be opened, or the system makes no more processes.
    """
    there = Path(f"/proc/{ends.process}/fd")
    with (there / str(ends.requests)).open("rb") as requests, (there / str(ends.answers)).open("wb") as answers:
        process = os.fork()
        if process == 0:
            _be_the_copy(requests, answers, serve)
    _COPIES.append(process)
    return process


def _be_the_copy(requests: BinaryIO, answers: BinaryIO, serve: Serve) -> None:
    """Serve, and end without going on as the one that was copied would."""
    code = 1
    try:
        _COPIES.clear()
        let_go_of_all_but({1, 2, requests.fileno(), answers.fileno()})
        serve(requests, answers)
        code = 0
    except BaseException:  # noqa: BLE001 - nothing of this process may run on, whatever it is
        traceback.print_exc()
    finally:
        os._exit(code)


def see_off() -> None:
    """Let the system forget copies that have ended."""
    for process in list(_COPIES):
        with suppress(ChildProcessError):
            if os.waitpid(process, os.WNOHANG) == (0, 0):
                continue
        _COPIES.remove(process)


class Copy:
    """A copy as its user sees it, which is not its parent: like `subprocess.Popen`, but how it ended is not known.

    Attributes:
        pid: its number.
        stdin, stdout: what it hears and says.
    """

    def __init__(self, process: int, handle: int, requests: int, answers: int) -> None:
        """Take over what tells of its end, and the other ends of the pipes."""
        self.pid = process
        self._handle = handle
        self.stdin, self.stdout = os.fdopen(requests, "wb", 0), os.fdopen(answers, "rb", 0)

    def __del__(self) -> None:
        os.close(self._handle)

    def poll(self) -> int | None:
        """None while it runs, else a number as of one that was killed."""
        return self._ended(0.0)

    def wait(self, timeout: float | None = None) -> int:
        """Wait for its end.

        Raises:
            TimeoutExpired: it has not ended after so many seconds.
        """
        code = self._ended(timeout)
        if code is None:
            raise subprocess.TimeoutExpired("a copy", timeout or 0.0)
        return code

    def kill(self) -> None:
        """End it, if it has not ended."""
        with suppress(ProcessLookupError):
            signal.pidfd_send_signal(self._handle, signal.SIGKILL)

    def _ended(self, seconds: float | None) -> int | None:
        poll = select.poll()  # not select, for which no handle may be 1024 or more
        poll.register(self._handle, select.POLLIN)
        return -signal.SIGKILL if poll.poll(None if seconds is None else math.ceil(1000.0 * seconds)) else None
