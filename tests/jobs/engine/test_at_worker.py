from __future__ import annotations

from typing import Any

import pytest

from cadpanel.jobs.engine import at_worker as module


def test_every_step_is_told_and_how_far_it_is_now_and_then(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = iter([0.0, 0.1, 0.2, 0.9, 1.0])
    monkeypatch.setattr(module, "monotonic", lambda: next(clock))
    told: list[tuple[object, ...]] = []

    class Worker:
        def log_event(self, topic: str, said: tuple[object, ...]) -> None:
            told.append((topic, *said[:4]))

    telling = module._Telling(Worker(), "this run", "A")
    for step, done in (("fit", 0), ("build", 0), ("build", 1), ("build", 2), ("build", 3)):
        telling(step, done, 3, "")
    assert told == [("this run", "A", *step) for step in (("fit", 0, 3), ("build", 0, 3), ("build", 2, 3))]


def test_what_a_worker_holds_is_its_own(monkeypatch: pytest.MonkeyPatch) -> None:
    class Worker:
        address = "tcp://10.0.0.1:4001"

    said: list[object] = []
    monkeypatch.setattr("distributed.get_worker", Worker)
    monkeypatch.setattr(module, "own_process", lambda: said.append("own"))
    monkeypatch.setattr(module, "work", lambda *_, side_by_side: said.append(side_by_side))

    class Task:
        name = "A"

    task: Any = Task()
    module.work_told(task, [], {"10.0.0.1": 3}, "this run")
    assert said == ["own", 3]


def test_workers_of_one_machine_share_its_processors() -> None:
    class Client:
        def nthreads(self) -> dict[str, int]:
            return {"tcp://10.0.0.1:4001": 1, "tcp://10.0.0.1:4002": 8, "tcp://10.0.0.2:4001": 1}

    client: object = Client()
    assert module.workers_by_host(client) == {"10.0.0.1": 2, "10.0.0.2": 1}
