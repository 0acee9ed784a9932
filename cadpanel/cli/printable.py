r"""What is printed: names and file names are data, and nothing in them may steer a terminal or end a run.

A name out of a file may hold the characters by which a terminal is told to move, colour or ring; they are shown as
`\x1b` and the like. What the terminal's encoding has no sign for is shown so, too. And a reader that has gone away, as
`head` does, is no reason to fail: what was to be delivered has been.
"""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Iterable
from contextlib import suppress
from typing import TextIO

from rich.console import Console, ConsoleOptions, ConsoleRenderable, RenderHook, RenderResult
from rich.segment import Segment

_STEERING = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f\u2028\u2029\u202a-\u202e\u2066-\u2069]")


def printable(text: str) -> str:
    """The same with every character that steers a terminal, or turns the direction of writing, shown by its number."""
    return _STEERING.sub(lambda found: found[0].encode("unicode_escape").decode("ascii"), text)


def complain(text: str) -> None:
    """Print to the error stream, as far as anybody reads it."""
    with suppress(OSError, ValueError):
        sys.stderr.write(printable(text))


def stand_in_for_closed_streams() -> None:
    """Give what whoever started the program has closed to nobody; else the next file that is opened took its place."""
    for name in ("stdin", "stdout", "stderr"):
        if getattr(sys, name) is None:
            mode = "r" if name == "stdin" else "w"
            setattr(sys, name, open(os.devnull, mode, encoding="utf-8"))  # noqa: SIM115, PTH123 - until the very end


def forgive_encodings() -> None:
    """Let the standard streams show by its number what their encoding has no sign for."""
    for stream in (sys.stdout, sys.stderr):
        with suppress(AttributeError, ValueError):  # someone has put another stream there, or closed it
            stream.reconfigure(errors="backslashreplace")  # type: ignore[union-attr]


class PrintableConsole(Console):
    """A console whose output steers no terminal but by rich's own styles, and that outlives its reader."""

    def __init__(self, width: int | None) -> None:
        """Print to standard output; lines as wide as the terminal where `width` is None."""
        super().__init__(file=_Forgiving(sys.stdout), highlight=False, width=width)  # type: ignore[arg-type]
        self.push_render_hook(_Printable())


class _Printable(RenderHook):
    def process_renderables(self, renderables: list[ConsoleRenderable]) -> list[ConsoleRenderable]:
        return [_Clean(one) for one in renderables]


class _Clean:
    def __init__(self, inner: ConsoleRenderable) -> None:
        self._inner = inner

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        return _cleaned(console.render(self._inner, options))


def _cleaned(segments: Iterable[Segment]) -> Iterable[Segment]:
    for text, style, control in segments:
        yield Segment(text if control else printable(text), style, control)


class _Forgiving:
    """A stream that drops what nobody reads any more."""

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream

    def write(self, text: str) -> int:
        """Write, or drop."""
        with _dropping():
            self._stream.write(text)
        return len(text)

    def flush(self) -> None:
        """Flush, or drop."""
        with _dropping():
            self._stream.flush()

    def __getattr__(self, name: str) -> object:
        return getattr(self._stream, name)


class _dropping:  # noqa: N801 - it reads as a statement
    def __enter__(self) -> None:
        return

    def __exit__(self, _kind: object, error: object, _traceback: object) -> bool:
        """Forgive a stream that cannot be written to, and send what follows nowhere, also what Python still holds."""
        if not isinstance(error, OSError):
            return False
        with suppress(OSError, ValueError):
            nowhere = os.open(os.devnull, os.O_WRONLY)
            os.dup2(nowhere, sys.stdout.fileno())
            os.close(nowhere)
        return True
