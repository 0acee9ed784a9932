from __future__ import annotations

import os
import signal
import threading
from pathlib import Path
from typing import Any

import pytest

from cadpanel.errors import SettingsError
from cadpanel.jobs.engine import cluster as module
from cadpanel.jobs.engine.cluster import Cluster
from cadpanel.jobs.task import Content
from tests.jobs.conftest import REGIONS
from tests.jobs.jobs import files, job, made, parts
from tests.thorough import thorough


def test_a_missing_package_and_a_missing_scheduler_are_sentences(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "_SECONDS_TO_CONNECT", 1)
    with pytest.raises(SettingsError, match=r"no scheduler answers at 'tcp://127\.0\.0\.1:9'"):
        Cluster(scheduler="tcp://127.0.0.1:9").__enter__()
    monkeypatch.setattr(module, "_NEEDED", "no_such_package")
    with pytest.raises(SettingsError, match=r"pip install 'cadpanel\[cluster\]'"):
        Cluster(workers=2)


class _Client:
    """Remembers what it is to send."""

    def __init__(self) -> None:
        self.sent: list[str] = []

    def submit(self, function: Any, data: bytes, *, key: str, pure: bool) -> str:
        assert pure
        assert function(data) == data
        self.sent.append(key)
        return key


def test_bytes_go_once_to_workers_elsewhere_and_stay_as_long_as_a_task_needs_them(strip: Path) -> None:
    first, second = (task for _, task in parts(job(strip, "A = {}\nB = {thickness = 2}")))
    client: Any = _Client()
    contents = module._Contents(client, [first, second], here=False)
    for task in (first, second):
        assert contents.of(task) == [f"bytes-{first.contents[0].sha256}"]
    contents.done(first)
    assert contents.of(second)
    assert len(client.sent) == 1
    contents.done(second)
    contents.of(second)
    assert len(client.sent) == 2


def test_workers_here_read_the_files_themselves(strip: Path) -> None:
    ((_, task),) = parts(job(strip, "A = {}"))
    client: Any = None
    (found,) = module._Contents(client, [task], here=True).of(task)
    assert isinstance(found, Content)
    assert found.path.is_absolute()
    assert found.read() == task.contents[0].read()


def test_every_step_is_told_and_how_far_it_is_now_and_then(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = iter([0.0, 0.1, 0.2, 0.9, 1.0])
    monkeypatch.setattr(module, "monotonic", lambda: next(clock))
    told: list[tuple[object, ...]] = []

    class Worker:
        def log_event(self, _topic: str, said: tuple[object, ...]) -> None:
            told.append(said[1:4])

    telling = module._Telling(Worker(), "A")
    for step, done in (("fit", 0), ("build", 0), ("build", 1), ("build", 2), ("build", 3)):
        telling(step, done, 3, "")
    assert told == [("fit", 0, 3), ("build", 0, 3), ("build", 2, 3)]


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
