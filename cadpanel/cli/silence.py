"""Lines of a program that is at work, none of them later than some seconds after the one before."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import TextIO


class Unsilent:
    """Writes lines, and where none came for long, what it is told to say then."""

    def __init__(self, stream: TextIO, silence: float, saying: Callable[[], str]) -> None:
        """Write to `stream`.

        Args:
            stream: of text.
            silence: after so many seconds without a line one is written, s.
            saying: what it says; nothing is written where that is empty.
        """
        self._stream, self._silence, self._saying = stream, silence, saying
        self._said, self._over = threading.Event(), threading.Event()
        self._watch = threading.Thread(target=self._break_silence, daemon=True)
        self._watch.start()

    def write(self, line: str) -> None:
        """Write a line."""
        self._put(line)
        self._said.set()

    def close(self) -> None:
        """Write nothing any more."""
        self._over.set()
        self._said.set()
        self._watch.join()

    def _put(self, line: str) -> None:
        self._stream.write(f"{line}\n")
        self._stream.flush()

    def _break_silence(self) -> None:
        while not self._over.is_set():
            if self._said.wait(self._silence):
                self._said.clear()
            elif line := self._saying():
                self._put(line)
