"""What a killed run leaves beside a delivery is cleared by the next one, and nothing else is."""

import os
import subprocess
import sys
import time

import pytest

from cadpanel.delivery.work_folders import aside_of, clear_left_behind, work_folder


@pytest.fixture
def nobody():
    """The number of a process that has ended."""
    process = subprocess.Popen([sys.executable, "-c", ""])
    process.wait()
    return process.pid


def names(folder):
    return sorted(path.name for path in folder.iterdir())


def left_by(pid, place, monkeypatch):
    with monkeypatch.context() as patched:
        patched.setattr("cadpanel.delivery.work_folders.os.getpid", lambda: pid)
        work = work_folder(place)
    work.mkdir()
    (work / "panels.step").write_text("half")
    return work


def test_what_a_dead_writer_left_is_removed(tmp_path, monkeypatch, nobody):
    left_by(nobody, tmp_path / "out", monkeypatch)
    clear_left_behind(tmp_path)
    assert names(tmp_path) == []


def test_what_is_being_written_stays(tmp_path, monkeypatch):
    mine = work_folder(tmp_path / "out")
    mine.mkdir()
    other = left_by(os.getppid(), tmp_path / "out", monkeypatch)
    clear_left_behind(tmp_path)
    assert names(tmp_path) == sorted([mine.name, other.name])


def test_a_delivery_that_stood_aside_returns_where_nothing_is_and_goes_where_something_is(
    tmp_path, monkeypatch, nobody
):
    work = left_by(nobody, tmp_path / "out", monkeypatch)
    work.rename(aside_of(work, tmp_path / "out"))
    clear_left_behind(tmp_path)
    assert (tmp_path / "out" / "panels.step").read_text() == "half"
    again = left_by(nobody, tmp_path / "out", monkeypatch)
    again.rename(aside_of(again, tmp_path / "out"))
    clear_left_behind(tmp_path)
    assert names(tmp_path) == ["out"]


@pytest.mark.parametrize(("aside", "days", "is_kept"), [(False, 6, True), (False, 8, False), (True, 2, False)])
def test_folders_of_another_machine_stay_for_longer_than_they_are_worked_at(
    tmp_path, monkeypatch, nobody, aside, days, is_kept
):
    with monkeypatch.context() as patched:
        patched.setattr("cadpanel.delivery.work_folders.socket.gethostname", lambda: "elsewhere")
        left = left_by(nobody, tmp_path / "out", patched)
    if aside:
        (tmp_path / "out").mkdir()
        left = left.rename(aside_of(left, tmp_path / "out"))
    clear_left_behind(tmp_path)
    assert left.is_dir()
    then = time.time() - 86_400.0 * days
    os.utime(left, (then, then))
    clear_left_behind(tmp_path)
    assert left.exists() is is_kept


@pytest.mark.parametrize(
    "name", [".cadpanel-1.part", "cadpanel-00000000-1-00000000.part", ".cadpanel-notes", "out.part"]
)
def test_other_names_are_somebodys(tmp_path, name):
    (tmp_path / name).mkdir()
    clear_left_behind(tmp_path)
    assert names(tmp_path) == [name]


def test_a_folder_that_is_not_there_holds_nothing(tmp_path):
    clear_left_behind(tmp_path / "none")
