from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from cadpanel.delivery.source_date import VARIABLE
from cadpanel.errors import DeliveryError, PanelError, ProofError
from cadpanel.jobs import work as module
from cadpanel.jobs.archive import unpacked
from cadpanel.jobs.task import Task
from cadpanel.jobs.work import FAILED, MET, MISSED, REFUSED, RETRIES, work
from tests.jobs.jobs import job, parts

Errors = list[Exception]


@pytest.fixture
def task(strip: Path) -> Task:
    return parts(job(strip, "A = {}"))[0][1]


@pytest.fixture
def failing(monkeypatch: pytest.MonkeyPatch) -> Callable[..., Errors]:
    """Let the next deliveries fail with these errors; the rest is a file with the date and threads that it saw."""

    def fail(*errors: Exception, missed: str | None = None) -> Errors:
        left = list(errors)

        def make(asked: Any, folder: Path, shown: Any) -> tuple[None, str | None]:
            shown.begin("Read reference", asked.file.name)
            if left:
                raise left.pop(0)
            (folder / "seen").write_text(f"{os.environ.get(VARIABLE)} {os.environ['OMP_NUM_THREADS']}")
            return None, missed

        monkeypatch.setattr(module, "make_delivery", make)
        return left

    return fail


def test_a_worker_with_other_packages_than_the_task_needs_is_refused(task: Task) -> None:
    found = run(replace(task, needs=("openpyxl",)))
    assert (found.code, found.archive) == (REFUSED, None)
    assert "other packages" in (found.said or "")


def run(task: Task) -> module.Made:
    return work(task, [content.read() for content in task.contents], lambda *_: None)


def test_what_fails_is_tried_again_so_often_and_no_oftener(task: Task, failing: Callable[..., Errors]) -> None:
    failing(*[OSError("busy")] * RETRIES)
    assert (run(task).code, run(task).tries) == (MET, 1)
    failing(*[OSError("busy")] * RETRIES)
    assert run(task).tries == RETRIES + 1
    left = failing(*[MemoryError("no room")] * (RETRIES + 5))
    found = run(task)
    assert (found.code, found.said, len(left)) == (FAILED, "MemoryError: no room", 4)
    assert "MemoryError" in found.details


def test_what_is_refused_is_not_tried_again(task: Task, failing: Callable[..., Errors]) -> None:
    left = failing(PanelError("N-01", "is none"), ProofError(["One.", "Two."]))
    assert (run(task).code, len(left)) == (REFUSED, 1)
    found = run(task)
    assert (found.code, found.said, found.archive) == (MISSED, "the proof does not hold: One. Two.", None)
    failing(*[DeliveryError("the disk is full")] * (RETRIES + 1))
    assert (run(task).code, run(task).code) == (REFUSED, MET)


def test_a_worker_with_another_program_makes_nothing(task: Task) -> None:
    found = run(replace(task, program="0" * 64))
    assert (found.code, found.archive) == (REFUSED, None)
    assert "another cadpanel" in str(found.said)


def test_the_date_and_one_thread_hold_for_as_long_as_it_works(
    task: Task, failing: Callable[..., Errors], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv(VARIABLE, raising=False)
    monkeypatch.setenv("OMP_NUM_THREADS", "7")
    failing(missed="Too wide.")
    found = run(task)
    assert found.archive is not None
    assert (found.code, unpacked(found.archive, tmp_path)) == (MISSED, "Too wide.")
    assert (tmp_path / "seen").read_text() == "1700000000 1"
    assert VARIABLE not in os.environ
    assert os.environ["OMP_NUM_THREADS"] == "7"
