"""When Python looks for garbage: not among what has just been made and stays, nor again and again what was loaded.

The kernel's binding makes a hundred thousand objects, a report and a drawing that is read as many again for some
hundred panels. Each time their number has grown by a quarter, Python goes through all of them, and finds nothing.
"""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from threading import Event


@contextmanager
def garbage_left() -> Iterator[None]:
    """Look for no garbage in the block, for work of seconds that makes much and leaves little."""
    looked = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if looked:
            gc.enable()


_OWN = Event()


def own_process() -> None:
    """Say that this process is the program's, or a worker's: what it holds is of no host who calls it."""
    _OWN.set()


def keep_what_is_loaded() -> None:
    """Look for garbage no more among what there is now, once, when all is loaded, in a process of our own."""
    if _OWN.is_set():
        _freeze()


@cache
def _freeze() -> None:
    gc.collect()
    gc.freeze()
