from __future__ import annotations

import errno
import os
import tempfile
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from cadpanel.brep.isolation.client import Died
from cadpanel.delivery.source_date import VARIABLE
from cadpanel.delivery.work_folders import work_folder
from cadpanel.errors import DeliveryError, OutlineError, PanelError, ProofError, ReferenceFileError
from cadpanel.jobs import work as module
from cadpanel.jobs.archive import unpacked
from cadpanel.jobs.task import Task
from cadpanel.jobs.work import FAILED, MET, MISSED, REFUSED, RETRIES, RETRIES_OF_A_CRASH, work
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


def caused(error: Exception, cause: BaseException) -> Exception:
    error.__cause__ = cause
    return error


@pytest.mark.parametrize(
    ("error", "tries"),
    [
        (DeliveryError("there is a file of that name"), 1),
        (caused(DeliveryError("it cannot be written"), PermissionError(errno.EACCES, "in use")), RETRIES + 1),
        (caused(ReferenceFileError("the kernel crashed"), Died()), RETRIES_OF_A_CRASH + 1),
        (caused(DeliveryError("the kernel crashed"), Died()), RETRIES_OF_A_CRASH + 1),
        (caused(caused(OutlineError("N", "x.step", "it has none", "cut it"), DeliveryError()), Died()), 2),
    ],
    ids=["never another time", "a disk in use", "a crash", "a crash over a delivery", "a crash behind it"],
)
def test_what_may_be_another_time_is_tried_again_and_then_told_as_it_is(
    task: Task, failing: Callable[..., Errors], error: Exception, tries: int
) -> None:
    failing(*[error] * tries)
    found = run(task)
    assert (found.code, found.said, found.tries) == (REFUSED, str(error), tries)
    left = failing(*[error] * (tries - 1))
    assert (run(task).code, left) == (MET, [])


@pytest.mark.parametrize(
    "error",
    [
        OSError(errno.ENOSPC, "No space left on device"),
        caused(DeliveryError("'step' cannot be written"), OSError(errno.EDQUOT, "Quota exceeded")),
    ],
)
def test_a_full_disk_is_refused_with_what_helps(task: Task, failing: Callable[..., Errors], error: Exception) -> None:
    failing(*[error] * (RETRIES + 1))
    found = run(task)
    assert found.code == REFUSED
    assert "TMPDIR" in str(found.said)


@pytest.mark.parametrize("stop", [KeyboardInterrupt(), SystemExit(143)])
def test_an_end_that_comes_out_as_another_error_ends_it(
    task: Task, failing: Callable[..., Errors], stop: BaseException
) -> None:
    left = failing(caused(ImportError("initialization failed"), stop), OSError("a second try"))
    with pytest.raises(type(stop)) as raised:
        run(task)
    assert raised.value is stop
    assert len(left) == 1


NOBODY = 2**30
"""No process has such a number."""


@pytest.mark.parametrize("error", [None, OSError("busy"), KeyboardInterrupt()])
def test_nothing_stays_where_it_was_made_nor_what_others_left_who_were_killed(
    task: Task, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, error: BaseException | None
) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    (stays := tmp_path / "of another program").mkdir()
    for pid, who in ((NOBODY, "killed"), (os.getppid(), "at work")):
        with monkeypatch.context() as patched:
            patched.setattr("cadpanel.delivery.work_folders.os.getpid", lambda pid=pid: pid)
            (work_folder(tmp_path / who) / "0").mkdir(parents=True)
    seen: list[int] = []

    def make(asked: Any, folder: Path, _shown: object) -> tuple[None, None]:
        own = folder.parent
        assert own == asked.file.parents[1]
        assert os.name == "nt" or own.stat().st_mode & 0o077 == 0
        others = set(tmp_path.iterdir()) - {own, stays}
        assert [str(os.getppid()) in path.name for path in others] == [True]
        seen.append(len(others))
        if error is not None:
            raise error
        return None, None

    monkeypatch.setattr(module, "make_delivery", make)
    with suppress(KeyboardInterrupt):
        assert "AssertionError" not in run(task).details
    assert seen
    assert len(list(tmp_path.iterdir())) == 2


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
