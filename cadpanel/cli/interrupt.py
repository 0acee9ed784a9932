"""Ctrl-C: it stops the program once; while something runs that can end early, the first ends that."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType
from typing import NoReturn


def stop_once(_signal: int, _frame: FrameType | None) -> NoReturn:
    """Stop the program, and let nothing disturb it while it clears up: whoever presses three times means it once.

    Raises:
        KeyboardInterrupt: always.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    raise KeyboardInterrupt


@contextmanager
def interrupts_stop_once() -> Iterator[None]:
    """Heed Ctrl-C by `stop_once` while the block runs, where Ctrl-C stops programs at all."""
    if signal.getsignal(signal.SIGINT) is not signal.default_int_handler:
        yield
        return
    signal.signal(signal.SIGINT, stop_once)
    try:
        yield
    finally:
        if signal.getsignal(signal.SIGINT) is stop_once:  # else it is on its way out, to its very end
            signal.signal(signal.SIGINT, signal.default_int_handler)


class Interrupt:
    """Whether the user asked for an end. Until somebody has looked once, Ctrl-C stops the program as ever."""

    def __init__(self) -> None:
        """Nobody asked yet, and nobody looked."""
        self._asked = self._looked = False

    def heard(self) -> bool:
        """Whether somebody asked; from now on the first Ctrl-C only asks."""
        self._looked = True
        return self._asked

    def hear(self, number: int, frame: FrameType | None) -> None:
        """Take a Ctrl-C.

        Raises:
            KeyboardInterrupt: it is the second one, or nothing runs yet that could end early.
        """
        if self._asked or not self._looked:
            stop_once(number, frame)
        self._asked = True


@contextmanager
def first_interrupt_ends() -> Iterator[Interrupt]:
    """Let the first Ctrl-C ask for an end while the block runs, where Ctrl-C stops programs at all."""
    interrupt = Interrupt()
    here = threading.current_thread() is threading.main_thread()
    before = signal.getsignal(signal.SIGINT)
    if not here or before not in (signal.default_int_handler, stop_once):
        yield interrupt
        return
    signal.signal(signal.SIGINT, interrupt.hear)
    try:
        yield interrupt
    finally:
        if signal.getsignal(signal.SIGINT) == interrupt.hear:
            signal.signal(signal.SIGINT, before)
