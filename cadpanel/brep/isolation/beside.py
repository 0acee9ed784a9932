"""A part of a piece of work done beside it by a copy of this process, which begins with all that this one has loaded.

A copy begins within milliseconds, where an interpreter of its own would load the kernel again. Only an interpreter that
does one thing at a time is copied like that, the second one: nothing is half done in it that a copy could not go on
with. The copy ends with this process, whatever happens to it.
"""

from __future__ import annotations

import ctypes
import os
import pickle
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from cadpanel.brep.isolation.requests import HEADER, framed

POSSIBLE = sys.platform.startswith("linux") and hasattr(os, "fork")
"""Elsewhere a copy of a process that has loaded a system's libraries may not run."""
_DIES_WITH_PARENT = 1  # PR_SET_PDEATHSIG of Linux's prctl


class Lost(Exception):
    """The other one has ended, or failed, before it said anything."""


class Channel:
    """What one of two processes says to the other one, message by message."""

    def __init__(self, reading: int, writing: int) -> None:
        self._reading = os.fdopen(reading, "rb")
        self._writing = os.fdopen(writing, "wb")

    def say(self, message: object) -> None:
        """Say something that can be pickled.

        Raises:
            Lost: nobody hears it.
        """
        try:
            self._writing.write(framed(message))
            self._writing.flush()
        except OSError as error:
            raise Lost from error

    def hear(self) -> object:
        """What the other one says next.

        Raises:
            Lost: it says nothing any more.
        """
        header = self._reading.read(HEADER.size)
        if len(header) == HEADER.size:
            (size,) = HEADER.unpack(header)
            data = self._reading.read(size)
            if len(data) == size:
                message: object = pickle.loads(data)
                return message
        raise Lost

    def handles(self) -> set[int]:
        """Of both its ends."""
        return {self._reading.fileno(), self._writing.fileno()}

    def close(self) -> None:
        """Say and hear nothing any more."""
        for stream in (self._reading, self._writing):
            with suppress(OSError):  # what nobody has heard
                stream.close()


@contextmanager
def beside(work: Callable[[Channel], None]) -> Iterator[Channel]:
    """Let a copy of this process do some work until it is done, or this ends.

    Args:
        work: told whom to talk to; whatever it raises is silence.

    Yields:
        Whom to talk to.
    """
    own_reading, its_writing = os.pipe()
    its_reading, own_writing = os.pipe()
    parent = os.getpid()
    process = os.fork()
    if process == 0:
        _be_the_copy(work, Channel(its_reading, its_writing), parent)
    os.close(its_reading)
    os.close(its_writing)
    channel = Channel(own_reading, own_writing)
    try:
        yield channel
    finally:
        os.kill(process, signal.SIGKILL)
        os.waitpid(process, 0)
        channel.close()


def _be_the_copy(work: Callable[[Channel], None], channel: Channel, parent: int) -> None:
    """Work, and end without a word to whoever else this process could talk to."""
    try:
        ctypes.CDLL(None).prctl(_DIES_WITH_PARENT, signal.SIGKILL)
        if os.getppid() == parent:
            let_go_of_all_but({1, 2, *channel.handles()})
            work(channel)
            channel.close()
    except BaseException:  # noqa: BLE001 - silence says it, and nothing of this process may run on
        os._exit(1)
    os._exit(0)


def let_go_of_all_but(handles: set[int]) -> None:
    """Close what others wait to be closed: the pipes to the process that has asked."""
    for handle in [int(entry.name) for entry in Path("/proc/self/fd").iterdir()]:
        if handle not in handles:
            with suppress(OSError):  # the one by which they were listed
                os.close(handle)
