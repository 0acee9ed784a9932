"""What a worker of a cluster does for a task: the same as everywhere, and tells of it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from time import monotonic
from typing import TYPE_CHECKING, Any

from cadpanel.garbage import own_process
from cadpanel.jobs.task import Content, Task
from cadpanel.jobs.work import Made, work

if TYPE_CHECKING:
    from distributed import Client

_SECONDS_BETWEEN = 0.5
"""Between two words on how far a step is; each passes through three processes."""


def work_told(task: Task, contents: Sequence[Content | bytes], by_host: Mapping[str, int], topic: str) -> Made:
    """The same as everywhere, told to whoever listens to the topic."""
    from distributed import get_worker

    own_process()
    worker = get_worker()
    return work(task, contents, _Telling(worker, topic, task.name), side_by_side=by_host.get(_host(worker.address), 1))


class _Telling:
    """Passes on each step of a region, and now and then how far it is."""

    def __init__(self, worker: Any, topic: str, region: str) -> None:
        self._worker, self._topic, self._region = worker, topic, region
        self._step, self._until = "", 0.0

    def __call__(self, step: str, done: int, of: int, detail: str) -> None:
        now = monotonic()
        if step == self._step and now < self._until:
            return
        self._step, self._until = step, now + _SECONDS_BETWEEN
        self._worker.log_event(self._topic, (self._region, step, done, of, detail))


def workers_by_host(client: Client) -> dict[str, int]:
    """How many tasks are worked at side by side on each machine: one a worker, as a process has one environment."""
    return dict(Counter(map(_host, client.nthreads())))


def _host(address: str) -> str:
    from distributed.comm import get_address_host

    host: str = get_address_host(address)
    return host
