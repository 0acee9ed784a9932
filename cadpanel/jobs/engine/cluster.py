"""Tasks worked off by many workers of dask.distributed, on this machine or elsewhere.

Workers elsewhere need no file of this machine: the bytes of references go to them once, as tasks of their own that the
scheduler keeps, so that they come again where the worker that had them is lost. Those that are started here read the
files themselves. What a lost worker was at goes to another one. Only a few tasks are given out at a time, so that
references and deliveries of a whole building never lie in memory together.
"""

from __future__ import annotations

import logging
from asyncio import gather
from collections import Counter, deque
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, suppress
from dataclasses import replace
from importlib.util import find_spec
from time import monotonic
from types import TracebackType
from typing import TYPE_CHECKING, Any, Self

from cadpanel.errors import SettingsError
from cadpanel.jobs.engine import deaf as first_loaded
from cadpanel.jobs.engine.deaf import deaf
from cadpanel.jobs.engine.engine import TellOf
from cadpanel.jobs.task import Content, Task
from cadpanel.jobs.work import FAILED, Made, refused, work

if TYPE_CHECKING:
    from distributed import Client, Future, LocalCluster

LOST = 3
"""Workers that may be lost over one task before it is taken to be at fault."""
_LOST_OVER_IT = (
    f"{LOST + 1} workers were lost over it, most often for want of memory: give fewer workers, or part it into smaller "
    "regions"
)
_TOPIC = "cadpanel"
_NEEDED = "distributed"
_SECONDS_TO_CONNECT = 20
_SECONDS_TO_END = 0.5
"""For a worker that is not to finish what it is at."""
_AHEAD = 2
"""Tasks given out for each that can be worked at, so that no worker waits for the next one."""
_FEWEST = 4
"""Of them at least, as workers elsewhere may come while the first tasks are worked at."""
_SECONDS_BETWEEN = 0.5
"""Between two words on how far a step is; each passes through three processes."""
_SETTINGS = {
    "distributed.scheduler.allowed-failures": LOST,
    "distributed.admin.log-format": "%(message)s",
    # References are sent as tasks on purpose, see above.
    "distributed.admin.large-graph-warning-threshold": "1 TiB",
}
_CALM = {
    # Made for tasks of milliseconds. With those of minutes, looking so often at what each process does, and at its
    # memory, takes a fifth of two processors.
    "distributed.worker.preload": [first_loaded.__name__],
    "distributed.worker.profile.enabled": False,
    "distributed.worker.memory.monitor-interval": "2s",
    "distributed.admin.tick.interval": "2s",
    "distributed.admin.tick.limit": "1h",  # the kernel gives Python no turn for as long as it likes
    "distributed.admin.system-monitor.interval": "10s",
    # Without the variable by which dask has the C library give back memory at once: to get it again for every array
    # takes a fit half as long again.
    "distributed.nanny.pre-spawn-environ": {"OMP_NUM_THREADS": 1, "MKL_NUM_THREADS": 1, "OPENBLAS_NUM_THREADS": 1},
}
"""Settings of the workers that are started here."""


class Cluster:
    """An engine with workers; the block that it is used in ends those that it started.

    Attributes:
        client: by which the scheduler is asked.
    """

    client: Client

    def __init__(self, *, workers: int | None = None, scheduler: str | None = None) -> None:
        """Say how many workers to start here, or where a scheduler listens.

        Raises:
            SettingsError: the package for it is missing.
        """
        if find_spec(_NEEDED) is None:
            raise SettingsError(
                "several workers need dask.distributed: install it with pip install 'cadpanel[cluster]', or leave out "
                "--workers and --scheduler"
            )
        self._workers, self._scheduler = workers, scheduler
        self._started: LocalCluster | None = None
        self._open = ExitStack()

    def __enter__(self) -> Self:
        """Start workers, or find the scheduler.

        Raises:
            SettingsError: there is none, or workers do not start.
        """
        import dask
        from distributed import Client

        self._open.enter_context(dask.config.set(_SETTINGS | (_CALM if self._scheduler is None else {})))
        where: Any = self._scheduler
        if where is None:
            where = self._started = self._open.enter_context(self._start())
        try:
            self.client = self._open.enter_context(Client(where, timeout=_SECONDS_TO_CONNECT, set_as_default=False))
        except (OSError, ValueError) as error:
            self._open.close()
            raise SettingsError(
                f"no scheduler answers at '{self._scheduler}': start one there with 'dask scheduler', or give "
                "--workers to start workers here"
            ) from error
        return self

    def _start(self) -> LocalCluster:
        from distributed import LocalCluster

        try:
            with deaf():  # those that begin later are told by `dask_setup`
                # One thread each: a process has one environment, and one second interpreter.
                return LocalCluster(
                    n_workers=self._workers,
                    threads_per_worker=1,
                    dashboard_address=":0",  # any that is free: two jobs may run side by side
                    scheduler_kwargs={"dashboard": False},
                    silence_logs=logging.CRITICAL,
                )
        except RuntimeError as error:
            self._open.close()
            raise SettingsError(
                "no workers start here: a script that asks for some does so below 'if __name__ == \"__main__\":', as "
                f"each of them reads it again ({' '.join(str(error).split())})"
            ) from error

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """End what was started; where something went wrong, whatever it is at."""
        if error is not None and self._started is not None:
            self._started.sync(_end_at_once, self._started)
        self._open.__exit__(kind, error, trace)

    def run(self, tasks: Sequence[Task], tell: TellOf) -> Iterator[Made]:
        """See `Engine.run`."""
        from distributed import as_completed

        self.client.subscribe_topic(_TOPIC, lambda event: tell(*event[1]))
        left = deque(tasks)
        given: dict[Future, Task] = {}
        contents = _Contents(self.client, tasks, here=self._scheduler is None)
        ended = as_completed(loop=self.client.loop)
        while left or given:
            while left and len(given) < _AHEAD * max(_FEWEST, len(self.client.nthreads())):
                task = left.popleft()
                try:
                    found = contents.of(task)
                except SettingsError as error:
                    yield refused(task, error)
                    continue
                future = self.client.submit(
                    _at_a_worker, task, found, _workers_by_host(self.client), key=f"region-{task.key}"
                )
                given[future] = task
                ended.add(future)
            if not given:
                return
            future = next(ended)
            task = given.pop(future)
            contents.done(task)
            yield self._made(future, task)
            future.release()  # what was made is large, and the scheduler keeps it as long as somebody wants it

    @staticmethod
    def _made(future: Any, task: Task) -> Made:
        error = future.exception()
        if error is None:
            made: Made = future.result()
            return made
        told = f"{type(error).__name__}: {' '.join(str(error).split())}"
        said = _LOST_OVER_IT if type(error).__name__ == "KilledWorker" else told
        return Made(key=task.key, code=FAILED, archive=None, said=said, details=told)


async def _end_at_once(cluster: LocalCluster) -> None:
    """End workers that would first go on for seconds with what they are at."""
    with suppress(TimeoutError):  # one that takes its time to end is ended already
        await gather(*(nanny.close(timeout=_SECONDS_TO_END) for nanny in cluster.workers.values()))


class _Contents:
    """What the files of tasks hold, for workers: where they lie, or their bytes, as long as a task needs them."""

    def __init__(self, client: Client, tasks: Sequence[Task], *, here: bool) -> None:
        self._client, self._here = client, here
        self._needed = Counter(sha256 for task in tasks for sha256 in _sums(task))
        self._sent: dict[str, Future] = {}

    def of(self, task: Task) -> list[Content | Future]:
        """Those of a task.

        Raises:
            SettingsError: one cannot be read, or has changed since.
        """
        if self._here:
            return [replace(content, path=content.path.absolute()) for content in task.contents]
        return [self._sent_of(content) for content in task.contents]

    def _sent_of(self, content: Content) -> Future:
        sha256 = content.sha256
        if sha256 not in self._sent:
            self._sent[sha256] = self._client.submit(_bytes, content.read(), key=f"bytes-{sha256}", pure=True)
        return self._sent[sha256]

    def done(self, task: Task) -> None:
        """Let go of what no other task needs."""
        for sha256 in _sums(task):
            self._needed[sha256] -= 1
            if not self._needed[sha256]:
                self._sent.pop(sha256, None)


def _sums(task: Task) -> set[str]:
    return {content.sha256 for content in task.contents}


def _workers_by_host(client: Client) -> dict[str, int]:
    """How many tasks are worked at side by side on each machine: one a worker, as a process has one environment."""
    return dict(Counter(map(_host, client.nthreads())))


def _host(address: str) -> str:
    from distributed.comm import get_address_host

    host: str = get_address_host(address)
    return host


def _bytes(data: bytes) -> bytes:
    return data


def _at_a_worker(task: Task, contents: Sequence[Content | bytes], by_host: Mapping[str, int]) -> Made:
    """The same as everywhere, told to whoever listens."""
    from distributed import get_worker

    worker = get_worker()
    return work(task, contents, _Telling(worker, task.name), side_by_side=by_host.get(_host(worker.address), 1))


class _Telling:
    """Passes on each step of a region, and now and then how far it is."""

    def __init__(self, worker: Any, region: str) -> None:
        self._worker, self._region = worker, region
        self._step, self._until = "", 0.0

    def __call__(self, step: str, done: int, of: int, detail: str) -> None:
        now = monotonic()
        if step == self._step and now < self._until:
            return
        self._step, self._until = step, now + _SECONDS_BETWEEN
        self._worker.log_event(_TOPIC, (self._region, step, done, of, detail))
