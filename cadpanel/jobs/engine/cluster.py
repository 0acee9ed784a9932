"""Tasks worked off by many workers of dask.distributed, on this machine or elsewhere.

Workers need no file of this machine: the bytes of references go to them once, as tasks of their own that the scheduler
keeps, so that they come again where the worker that had them is lost. What a lost worker was at goes to another one.
"""

from __future__ import annotations

import logging
from collections.abc import Iterator, Sequence
from contextlib import ExitStack
from functools import partial
from importlib.util import find_spec
from types import TracebackType
from typing import TYPE_CHECKING, Any, Self

from cadpanel.errors import SettingsError
from cadpanel.jobs.engine.engine import TellOf
from cadpanel.jobs.task import Task
from cadpanel.jobs.work import FAILED, Made, work

if TYPE_CHECKING:
    from distributed import Client

LOST = 3
"""Workers that may be lost over one task before it is taken to be at fault."""
_TOPIC = "cadpanel"
_NEEDED = "distributed"
_SECONDS_TO_CONNECT = 20


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
        self._open = ExitStack()

    def __enter__(self) -> Self:
        """Start workers, or find the scheduler.

        Raises:
            SettingsError: there is none.
        """
        import dask
        from distributed import Client, LocalCluster

        settings = {"distributed.scheduler.allowed-failures": LOST, "distributed.admin.log-format": "%(message)s"}
        self._open.enter_context(dask.config.set(settings))
        where: Any = self._scheduler
        if where is None:
            where = self._open.enter_context(
                # One thread each: a process has one environment, and one second interpreter.
                LocalCluster(
                    n_workers=self._workers, threads_per_worker=1, dashboard_address=None, silence_logs=logging.CRITICAL
                )
            )
        try:
            self.client = self._open.enter_context(Client(where, timeout=_SECONDS_TO_CONNECT, set_as_default=False))
        except (OSError, ValueError) as error:
            self._open.close()
            raise SettingsError(
                f"no scheduler answers at '{self._scheduler}': start one there with 'dask scheduler', or give "
                "--workers to start workers here"
            ) from error
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """End what was started."""
        self._open.__exit__(kind, error, trace)

    def run(self, tasks: Sequence[Task], tell: TellOf) -> Iterator[Made]:
        """See `Engine.run`."""
        from distributed import as_completed

        self.client.subscribe_topic(_TOPIC, lambda event: tell(*event[1]))
        contents = {content.sha256: content for task in tasks for content in task.contents}
        sent = {
            sha256: self.client.submit(_bytes, content.read(), key=f"bytes-{sha256}", pure=True)
            for sha256, content in contents.items()
        }
        waiting = {
            self.client.submit(
                _at_a_worker, task, [sent[content.sha256] for content in task.contents], key=f"region-{task.key}"
            ): task
            for task in tasks
        }
        del sent
        for future in as_completed(list(waiting), loop=self.client.loop):
            yield self._made(future, waiting.pop(future))
            future.release()  # what was made is large, and the scheduler keeps it as long as somebody wants it

    @staticmethod
    def _made(future: Any, task: Task) -> Made:
        error = future.exception()
        if error is None:
            made: Made = future.result()
            return made
        said = f"{type(error).__name__}: {' '.join(str(error).split())}"
        return Made(key=task.key, code=FAILED, archive=None, said=said)


def _bytes(data: bytes) -> bytes:
    return data


def _at_a_worker(task: Task, contents: Sequence[bytes]) -> Made:
    """The same as everywhere, told to whoever listens."""
    from distributed import get_worker

    return work(task, contents, partial(_tell, get_worker(), task.name))


def _tell(worker: Any, *said: object) -> None:
    worker.log_event(_TOPIC, said)
