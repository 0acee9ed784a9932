"""Tasks that were given to workers, as they end; where nobody works at them, that is told."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import suppress
from queue import Empty, SimpleQueue
from time import monotonic
from typing import TYPE_CHECKING, Any

from cadpanel.brep.isolation.client import LOOK_UP
from cadpanel.jobs.task import Task

if TYPE_CHECKING:
    from distributed import Client

SECONDS_WITHOUT = 5.0
"""After which it is asked whether workers are there, and again, as long as nothing ends."""


class Ended:
    """Futures in the order in which they end."""

    def __init__(self, client: Client, tell_nobody: Callable[[Task], None]) -> None:
        """Say who is told that no worker is there, with a task that waits: once, until one was there."""
        self._client, self._tell_nobody = client, tell_nobody
        self._told = False
        self._ended: SimpleQueue[Any] = SimpleQueue()

    def add(self, future: Any) -> None:
        """Wait for this one, too."""
        future.add_done_callback(self._ended.put)

    def next(self, given: Mapping[Any, Task]) -> Any:
        """The next one of those that were given out."""
        until = monotonic() + SECONDS_WITHOUT
        while True:
            with suppress(Empty):
                return self._ended.get(timeout=LOOK_UP)
            if monotonic() > until:
                self._look(next(iter(given.values())))
                until = monotonic() + SECONDS_WITHOUT

    def _look(self, waiting: Task) -> None:
        nobody = not self._client.nthreads()
        if nobody and not self._told:
            self._tell_nobody(waiting)
        self._told = nobody
