"""Ctrl-C while something runs that can end early: the first ends it, the second stops the program."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType


class Interrupt:
    """Whether the user asked for an end. Until somebody has looked once, Ctrl-C stops the program as ever."""

    def __init__(self) -> None:
        """Nobody asked yet, and nobody looked."""
        self._asked = self._looked = False

    def heard(self) -> bool:
        """Whether somebody asked; from now on the first Ctrl-C only asks."""
        self._looked = True
        return self._asked

    def hear(self, _signal: int, _frame: FrameType | None) -> None:
        """Take a Ctrl-C.

        Raises:
            KeyboardInterrupt: it is the second one, or nothing runs yet that could end early.
        """
        if self._asked or not self._looked:
            raise KeyboardInterrupt
        self._asked = True


@contextmanager
def first_interrupt_ends() -> Iterator[Interrupt]:
    """Let the first Ctrl-C ask for an end while the block runs, where Ctrl-C stops programs at all."""
    interrupt = Interrupt()
    here = threading.current_thread() is threading.main_thread()
    if not here or signal.getsignal(signal.SIGINT) is not signal.default_int_handler:
        yield interrupt
        return
    signal.signal(signal.SIGINT, interrupt.hear)
    try:
        yield interrupt
    finally:
        signal.signal(signal.SIGINT, signal.default_int_handler)
