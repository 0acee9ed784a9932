"""Tasks worked off by many workers of dask.distributed, on this machine or elsewhere.

Workers elsewhere need no file of this machine: the bytes of references go to them once, as tasks of their own that the
scheduler keeps, so that they come again where the worker that had them is lost. Those that are started here read the
files themselves. What a lost worker was at goes to another one; what several were lost over is tried once more alone.
Only a few tasks are given out at a time, so that references and deliveries of a whole building never lie in memory
together.
"""

from __future__ import annotations

import logging
from asyncio import gather
from collections import deque
from collections.abc import Iterator, Sequence
from concurrent.futures import Future, wait
from contextlib import ExitStack, suppress
from functools import partial
from importlib.util import find_spec
from types import TracebackType
from typing import TYPE_CHECKING, Any, Self

from cadpanel.brep.isolation.client import LOOK_UP
from cadpanel.errors import SettingsError
from cadpanel.jobs.engine import deaf as first_loaded
from cadpanel.jobs.engine.at_worker import work_told, workers_by_host
from cadpanel.jobs.engine.contents import Contents
from cadpanel.jobs.engine.deaf import begin_deaf
from cadpanel.jobs.engine.ended import Ended
from cadpanel.jobs.engine.engine import TellOf
from cadpanel.jobs.task import Task
from cadpanel.jobs.work import FAILED, Made, refused

if TYPE_CHECKING:
    from distributed import Client, LocalCluster
    from distributed import Future as Given

LOST = 3
"""Workers that may be lost over one task before it is taken to be at fault."""
_LOST_OVER_IT = (
    f"{LOST + 1} workers were lost over it, and as many again while nothing else was worked at, most often for want of "
    "memory: part it into smaller regions, or take a machine with more memory"
)
_NEEDED = "distributed"
_SECONDS_TO_CONNECT = 20
_SECONDS_TO_BEGIN = 20
"""For workers that are not wanted any more before they have begun: then they are ended in order."""
_SECONDS_TO_END = 0.5
"""For a worker that is not to finish what it is at."""
_AHEAD = 2
"""Tasks given out for each that can be worked at, so that no worker waits for the next one."""
_FEWEST = 4
"""Of them at least, as workers elsewhere may come while the first tasks are worked at."""
_SETTINGS = {
    "distributed.scheduler.allowed-failures": LOST,
    "distributed.admin.log-format": "%(message)s",
    # References are sent as tasks on purpose, see above.
    "distributed.admin.large-graph-warning-threshold": "1 TiB",
}
_CALM = {
    # Made for tasks of milliseconds. With those of minutes, looking so often at what each process does takes a fifth of
    # two processors.
    "distributed.worker.preload": [first_loaded.__name__],
    "distributed.worker.profile.enabled": False,
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
        self._place = "on this machine" if scheduler is None else f"at {scheduler}"
        self._started: LocalCluster | None = None
        self._open = ExitStack()

    def __enter__(self) -> Self:
        """Start workers, or find the scheduler.

        Raises:
            SettingsError: there is none, or workers do not start.
        """
        import dask
        from distributed import Client
        from distributed.utils import silence_logging_cmgr

        with ExitStack() as opened:
            # A scheduler that is gone is told in one sentence, and not also by the log of the client.
            for logger in ("distributed", "distributed.client"):
                opened.enter_context(silence_logging_cmgr(logging.CRITICAL + 1, logger))
            opened.enter_context(dask.config.set(_SETTINGS | (_CALM if self._scheduler is None else {})))
            where: Any = self._scheduler
            if where is None:
                where = self._started = opened.enter_context(self._start())
            try:
                self.client = opened.enter_context(Client(where, timeout=_SECONDS_TO_CONNECT, set_as_default=False))
            except (OSError, ValueError) as error:
                raise SettingsError(
                    f"no scheduler answers at '{self._scheduler}': start one there with 'dask scheduler', or give "
                    "--workers to start workers here"
                ) from error
            self._open = opened.pop_all()
        return self

    def _start(self) -> LocalCluster:
        from distributed import LocalCluster

        start = partial(
            LocalCluster,
            n_workers=self._workers,
            threads_per_worker=1,  # a process has one environment, and one second interpreter
            memory_limit=0,  # a share of it each would end a large region that finds room beside small ones
            dashboard_address=":0",  # any that is free: two jobs may run side by side
            scheduler_kwargs={"dashboard": False},
            silence_logs=logging.CRITICAL,
        )
        begun = Future[LocalCluster]()
        try:
            begin_deaf(begun, start)
            while not begun.done():
                wait([begun], timeout=LOOK_UP)
            return begun.result()
        except RuntimeError as error:
            raise SettingsError(
                "no workers start here: a script that asks for some does so below 'if __name__ == \"__main__\":', as "
                f"each of them reads it again ({' '.join(str(error).split())})"
            ) from error
        except BaseException:  # Ctrl-C
            if not begun.cancel():
                with suppress(Exception):
                    begun.result(timeout=_SECONDS_TO_BEGIN).close()
            raise

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """End what was started; where something went wrong, whatever it is at."""
        if error is not None and self._started is not None:
            self._started.sync(_end_at_once, self._started)
        self._open.__exit__(kind, error, trace)

    def run(self, tasks: Sequence[Task], tell: TellOf) -> Iterator[Made]:
        """See `Engine.run`.

        Raises:
            SettingsError: the scheduler is gone.
        """
        from distributed import CancelledError
        from distributed.client import ClosedClientError

        try:
            yield from self._run(tasks, tell)
        except (OSError, CancelledError, ClosedClientError) as error:
            raise SettingsError(
                f"the scheduler {self._place} is gone, or the way to it: see that it runs, and run the same "
                "again, which goes on from what is done"
            ) from error

    def _run(self, tasks: Sequence[Task], tell: TellOf) -> Iterator[Made]:
        topic = f"cadpanel-{self.client.id}"  # others may run jobs by the same scheduler
        self.client.subscribe_topic(topic, lambda event: tell(*event[1]))
        left, lost, alone = deque(tasks), deque[Task](), set[str]()
        given: dict[Given, Task] = {}
        contents = Contents(self.client, tasks, here=self._scheduler is None)
        ended = Ended(self.client, lambda task: tell(task.name, f"no worker {self._place} yet", 0, 1, ""))
        while left or given or lost:
            if not (left or given):  # a lost worker may have been at another task, too: now there is none
                alone.add(lost[0].key)
                left.append(lost.popleft())
            while left and len(given) < _AHEAD * max(_FEWEST, len(self.client.nthreads())):
                task = left.popleft()
                try:
                    found = contents.of(task)
                except SettingsError as error:
                    contents.done(task)
                    yield refused(task, error)
                    continue
                key = f"region-{task.key}{'-alone' if task.key in alone else ''}"
                future = self.client.submit(work_told, task, found, workers_by_host(self.client), topic, key=key)
                given[future] = task
                ended.add(future)
            if not given:
                continue
            future = ended.next(given)
            task = given.pop(future)
            made = _made(future, task)
            future.release()  # what was made is large, and the scheduler keeps it as long as somebody wants it
            if made is None and task.key not in alone:
                lost.append(task)
                continue
            contents.done(task)
            yield made or Made(key=task.key, code=FAILED, archive=None, said=_LOST_OVER_IT)


def _made(future: Any, task: Task) -> Made | None:
    """What came of a task; None where workers were lost over it."""
    error = future.exception()
    if error is None:
        made: Made = future.result()
        return made
    if type(error).__name__ == "KilledWorker":
        return None
    told = f"{type(error).__name__}: {' '.join(str(error).split())}"
    return Made(key=task.key, code=FAILED, archive=None, said=told, details=told)


async def _end_at_once(cluster: LocalCluster) -> None:
    """End workers that would first go on for seconds with what they are at."""
    with suppress(TimeoutError):  # one that takes its time to end is ended already
        await gather(*(nanny.close(timeout=_SECONDS_TO_END) for nanny in cluster.workers.values()))
