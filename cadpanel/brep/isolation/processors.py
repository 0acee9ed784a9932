"""How many processors a piece of work may keep busy: all that this process may use, or its share of them.

More interpreters than processors make nothing quicker, and each loads the kernel again: where others work on the same
machine, whoever gives out the work says so. Results do not depend on it.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar

_GIVEN: ContextVar[int | None] = ContextVar("processors", default=None)


def processors() -> int:
    """How many this work may keep busy at once."""
    given = _GIVEN.get()
    return usable() if given is None else given


def usable() -> int:
    """How many this process may use at once."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


@contextmanager
def given_processors(count: int) -> Iterator[None]:
    """Let what is called in the block, in this thread, keep so many busy."""
    before = _GIVEN.set(count)
    try:
        yield
    finally:
        _GIVEN.reset(before)
