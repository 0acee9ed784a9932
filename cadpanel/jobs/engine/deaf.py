"""Workers that are started here hear of no Ctrl-C: a terminal tells all processes of it, and one of them ends all."""

from __future__ import annotations

import signal
import sys
import threading
from collections.abc import Callable
from concurrent.futures import Future
from typing import TypeVar

Begun = TypeVar("Begun")


def dask_setup(_worker: object) -> None:
    """Hear of no Ctrl-C; called by dask once a worker runs, in its main thread."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def begin_deaf(begun: Future[Begun], begin: Callable[[], Begun]) -> None:
    """Call a function in a thread that hears of no Ctrl-C; what it gives or raises is told to whoever waits for it.

    Nor do threads and processes that begin in it, where the system has masks of signals, which they inherit. So this
    thread hears of it as ever, and may leave while that one goes on.
    """
    if sys.platform != "win32":
        from multiprocessing import resource_tracker

        resource_tracker.ensure_running()  # else it begins in that thread, and lifts the mask there

    def run() -> None:
        if sys.platform != "win32":
            signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
        if not begun.set_running_or_notify_cancel():
            return
        try:
            begun.set_result(begin())
        except BaseException as error:  # noqa: BLE001 - whoever waits for it is told
            begun.set_exception(error)

    threading.Thread(target=run, daemon=True).start()
