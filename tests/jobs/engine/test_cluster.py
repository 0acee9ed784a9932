from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import dask
import pytest
from distributed.client import ClosedClientError, FutureCancelledError

from cadpanel.errors import SettingsError
from cadpanel.jobs.engine import cluster as module
from cadpanel.jobs.engine import ended
from cadpanel.jobs.engine.cluster import Cluster
from cadpanel.jobs.task import Task
from cadpanel.jobs.work import FAILED, MET, Made
from tests.jobs.conftest import REGIONS
from tests.jobs.jobs import files, job, made, parts
from tests.thorough import thorough
from tests.waiting import until


def test_a_missing_package_and_a_missing_scheduler_are_sentences(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "_SECONDS_TO_CONNECT", 1)
    with pytest.raises(SettingsError, match=r"no scheduler answers at 'tcp://127\.0\.0\.1:9'"):
        Cluster(scheduler="tcp://127.0.0.1:9").__enter__()
    monkeypatch.setattr(module, "_NEEDED", "no_such_package")
    with pytest.raises(SettingsError, match=r"pip install 'cadpanel\[cluster\]'"):
        Cluster(workers=2)


class _Future:
    """What a worker does at once."""

    def __init__(self, outcome: object) -> None:
        self._outcome = outcome

    def add_done_callback(self, heard: Callable[[Any], None]) -> None:
        heard(self)

    def exception(self) -> object:
        return self._outcome if type(self._outcome).__name__ == "KilledWorker" else None

    def result(self) -> object:
        if isinstance(self._outcome, Exception):
            raise self._outcome
        return self._outcome

    def release(self) -> None:
        pass


class _Client:
    """Of a scheduler whose workers answer as they are told."""

    id = "Client-1"
    loop = None

    def __init__(self, answer: Callable[[str], object]) -> None:
        self._answer = answer
        self.keys: list[str] = []
        self.topics: list[object] = []

    def subscribe_topic(self, topic: str, _heard: object) -> None:
        self.topics.append(topic)

    def nthreads(self) -> dict[str, int]:
        return {"tcp://10.0.0.1:4001": 1}

    def submit(self, _function: object, *given: Any, key: str, pure: bool = True) -> _Future:
        assert pure
        if key.startswith("bytes-"):
            return _Future(None)
        self.topics.append(given[-1])
        self.keys.append(key.removeprefix("region-"))
        return _Future(self._answer(key))


def working(answer: Callable[[str], object]) -> tuple[Cluster, _Client]:
    """An engine whose workers answer so for the key of a task."""
    engine, client = Cluster(scheduler="tcp://10.0.0.1:8786"), _Client(answer)
    engine.client = client
    return engine, client


def named(task: Task) -> Made:
    return Made(key=task.key, code=MET, archive=b"", said=task.name)


@pytest.fixture
def tasks(strip: Path) -> list[Task]:
    return [task for _, task in parts(job(strip, "A = {}\nB = {thickness = 2}\nC = {thickness = 3}"))]


class KilledWorker(Exception):
    """As distributed says that workers were lost over a task."""


def test_what_workers_were_lost_over_is_tried_once_more_when_nothing_else_is(tasks: list[Task]) -> None:
    first, second, third = tasks
    by_key = {f"region-{task.key}": named(task) for task in tasks}

    def answer(key: str) -> object:
        return KilledWorker() if first.key in key else by_key[key]

    engine, client = working(answer)
    found = list(engine.run(tasks, lambda *_: None))
    assert [made.said for made in found[:2]] == ["B", "C"]
    assert (found[2].key, found[2].code) == (first.key, FAILED)
    assert "smaller regions" in str(found[2].said)
    assert client.keys == [first.key, second.key, third.key, f"{first.key}-alone"]

    engine, _ = working(lambda key: named(first) if key.endswith("-alone") else answer(key))
    assert [made.said for made in engine.run(tasks, lambda *_: None)] == ["B", "C", "A"]


def test_every_run_tells_on_a_topic_of_its_own(tasks: list[Task]) -> None:
    topics = []
    for number in "12":
        engine, client = working(lambda _: named(tasks[0]))
        client.id = number
        list(engine.run(tasks[:1], lambda *_: None))
        assert client.topics[0] == client.topics[1]
        topics += client.topics[:1]
    assert topics[0] != topics[1]


def raising(error: Exception) -> Callable[..., None]:
    def fail(*_: object, **__: object) -> None:
        raise error

    return fail


@pytest.mark.parametrize(
    ("asked", "error"),
    [
        ("nthreads", OSError("refused")),
        ("submit", ClosedClientError("closed")),
        ("subscribe_topic", ClosedClientError("closed")),
        (None, FutureCancelledError("region-A", "scheduler-connection-lost")),
    ],
)
def test_a_scheduler_that_is_gone_is_one_sentence_however_that_shows(
    tasks: list[Task], monkeypatch: pytest.MonkeyPatch, asked: str | None, error: Exception
) -> None:
    engine, client = working(lambda _: error)
    if asked is not None:
        monkeypatch.setattr(client, asked, raising(error))
    with pytest.raises(SettingsError, match=r"scheduler at tcp://10\.0\.0\.1:8786 is gone.* run the same again"):
        list(engine.run(tasks, lambda *_: None))


@pytest.mark.skipif(sys.platform == "win32", reason="there a process that is sent a signal ends")
def test_an_interrupt_while_workers_start_is_heeded_and_ends_what_has_started(monkeypatch: pytest.MonkeyPatch) -> None:
    begins, closed = threading.Event(), list[bool]()

    class Started:
        def close(self) -> None:
            closed.append(True)

    def start(**how: object) -> Started:
        assert how["memory_limit"] == 0  # none
        os.kill(os.getpid(), signal.SIGINT)
        begins.wait(60)
        return Started()

    def interrupted(*_: object) -> None:
        begins.set()
        raise KeyboardInterrupt

    monkeypatch.setattr("distributed.LocalCluster", start)
    before = signal.signal(signal.SIGINT, interrupted)
    try:
        with pytest.raises(KeyboardInterrupt):
            Cluster(workers=1).__enter__()
    finally:
        signal.signal(signal.SIGINT, before)
    assert closed == [True]


def test_nothing_stays_open_where_workers_do_not_start(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("distributed.LocalCluster", raising(RuntimeError("bootstrapping phase")))
    before = dask.config.get("distributed.scheduler.allowed-failures"), dask.config.get("distributed.worker.preload")
    with pytest.raises(SettingsError, match=r"if __name__ == .*bootstrapping phase"):
        Cluster(workers=1).__enter__()
    assert before == (
        dask.config.get("distributed.scheduler.allowed-failures"),
        dask.config.get("distributed.worker.preload"),
    )


@pytest.fixture
def scheduler(tmp_path: Path) -> Iterator[tuple[str, subprocess.Popen[bytes]]]:
    """One without workers, in a process of its own, and where it listens."""
    told = tmp_path / "scheduler.json"
    words = ["--host", "127.0.0.1", "--port", "0", "--no-dashboard", "--scheduler-file", str(told)]
    with subprocess.Popen(
        [sys.executable, "-m", "distributed.cli.dask_scheduler", *words],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    ) as process:
        try:
            until(told.exists)
            yield json.loads(told.read_text())["address"], process
        finally:
            process.kill()


@thorough
def test_a_scheduler_without_workers_is_waited_for_and_one_that_dies_is_told(
    tasks: list[Task], scheduler: tuple[str, subprocess.Popen[bytes]], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(ended, "SECONDS_WITHOUT", 0.5)
    address, process = scheduler
    told: list[tuple[object, ...]] = []

    def tell(*step: object) -> None:
        told.append(step)
        threading.Timer(2.0, process.kill).start()

    began = time.monotonic()
    with pytest.raises(SettingsError, match="run the same again"), Cluster(scheduler=address) as engine:
        list(engine.run(tasks, tell))
    assert told == [("A", f"no worker at {address} yet", 0, 1, "")]
    assert time.monotonic() - began < 60.0


@thorough
def test_a_worker_that_is_killed_loses_nothing_and_nothing_differs(done: Path, strip: Path, tmp_path: Path) -> None:
    begun, told = threading.Event(), list[str]()
    killed: list[int] = []

    class Watched(Cluster):
        def kill_one(self) -> None:
            begun.wait(120)
            at = self.client.run(os.getpid)
            busy = next(worker for worker, tasks in self.client.processing().items() if tasks)
            os.kill(at[busy], signal.SIGKILL)
            killed.append(at[busy])

    with Watched(workers=2) as engine:
        killer = threading.Thread(target=engine.kill_one)
        killer.start()

        class Telling:
            def run(self, tasks, tell):
                def heard(region, step, *more):
                    told.append(step)
                    begun.set()
                    tell(region, step, *more)

                return engine.run(tasks, heard)

        summary = made(job(strip, REGIONS), tmp_path / "out", None, Telling())
        killer.join()
    assert len(killed) == 1
    assert "Read reference" in told
    assert [row.state for row in summary.rows] == ["made"] * 3
    for name in ("A", "B", "C"):
        assert files(tmp_path / "out" / name) == files(done / name)
