"""What an error was made of: a fault of a disk, a crash of the CAD kernel, or Ctrl-C.

An interrupt or a kill comes out as another error where it disturbs the import of an extension: that fails.
"""

from __future__ import annotations

from collections.abc import Iterator


def causes(error: BaseException) -> Iterator[BaseException]:
    """The error, what it was made of, and so on."""
    cause: BaseException | None = error
    while cause is not None:
        yield cause
        cause = cause.__cause__


def stopped_by(error: BaseException) -> KeyboardInterrupt | SystemExit | None:
    """The interrupt or the end of the program that an error was made of; None where it is a fault of its own."""
    return next((cause for cause in causes(error) if isinstance(cause, KeyboardInterrupt | SystemExit)), None)
