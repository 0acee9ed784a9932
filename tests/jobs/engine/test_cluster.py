from __future__ import annotations

import os
import signal
import threading
from pathlib import Path

import pytest

from cadpanel.errors import SettingsError
from cadpanel.jobs.engine import cluster as module
from cadpanel.jobs.engine.cluster import Cluster
from tests.jobs.conftest import REGIONS
from tests.jobs.jobs import files, job, made
from tests.thorough import thorough


def test_a_missing_package_and_a_missing_scheduler_are_sentences(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "_SECONDS_TO_CONNECT", 1)
    with pytest.raises(SettingsError, match=r"no scheduler answers at 'tcp://127\.0\.0\.1:9'"):
        Cluster(scheduler="tcp://127.0.0.1:9").__enter__()
    monkeypatch.setattr(module, "_NEEDED", "no_such_package")
    with pytest.raises(SettingsError, match=r"pip install 'cadpanel\[cluster\]'"):
        Cluster(workers=2)


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
