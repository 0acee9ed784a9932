"""What workers that are started here load first: a terminal tells all processes of Ctrl-C, and one of them ends all."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager


def dask_setup(_worker: object) -> None:
    """Hear of no Ctrl-C; called by dask once a worker runs, in its main thread."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


@contextmanager
def deaf() -> Iterator[None]:
    """Hear of no Ctrl-C in the block, nor do processes that begin in it, until they are told otherwise."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
