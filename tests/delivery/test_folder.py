"""A delivery folder is there whole or not at all, and nothing else is ever touched."""

from __future__ import annotations

import errno
import os
import re
import shutil
import subprocess
import sys
import time
from pathlib import Path

import pytest

from cadpanel.delivery import folder as folder_module
from cadpanel.delivery.folder import delivery_folder
from cadpanel.delivery.manifest import changed_files
from cadpanel.delivery.own_files import MARKS_OF_A_DELIVERY
from cadpanel.delivery.records.jsonfile import Record, write_json
from cadpanel.delivery.work_folders import clear_left_behind
from cadpanel.errors import DeliveryError, PanelError
from tests.thorough import cases

MARK = '{\n  "schema": "cadpanel.report/1"\n}\n'


def deliver(target: Path, content: str = "new", *, overwrite: bool = False) -> None:
    with delivery_folder(target, overwrite=overwrite) as folder:
        (folder / "report.json").write_text(MARK)
        (folder / "panels.step").write_text(content)


def everything_below(folder: Path) -> list[str]:
    return sorted(str(path.relative_to(folder)) for path in folder.rglob("*"))


WHOLE = ["manifest.json", "panels.step", "report.json"]


def test_a_finished_folder_stands_in_its_place_and_alone(tmp_path: Path) -> None:
    deliver(tmp_path / "out")
    assert everything_below(tmp_path) == sorted(["out", *(f"out/{name}" for name in WHOLE)])


def test_the_folder_has_the_permissions_of_any_other_folder(tmp_path: Path) -> None:
    (tmp_path / "plain").mkdir()
    deliver(tmp_path / "out")
    assert (tmp_path / "out").stat().st_mode == (tmp_path / "plain").stat().st_mode


def test_missing_parents_are_made(tmp_path: Path) -> None:
    deliver(tmp_path / "a" / "b" / "out")
    assert (tmp_path / "a" / "b" / "out" / "panels.step").read_text() == "new"


def test_a_target_relative_to_the_working_directory_is_fine(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    deliver(Path("out"))
    assert (tmp_path / "out" / "report.json").is_file()


def test_a_link_to_a_folder_keeps_pointing_at_it(tmp_path: Path) -> None:
    deliver(tmp_path / "real", "old")
    (tmp_path / "link").symlink_to(tmp_path / "real")
    deliver(tmp_path / "link", overwrite=True)
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "real" / "panels.step").read_text() == "new"


# ------------------------------------------------------------------------------------------------- an existing target
@pytest.mark.parametrize("holds_a_delivery", [True, False])
def test_an_existing_folder_is_refused_before_any_work_is_done(tmp_path: Path, *, holds_a_delivery: bool) -> None:
    target = tmp_path / "out"
    if holds_a_delivery:
        deliver(target, "old")
    else:
        target.mkdir()
    before = everything_below(tmp_path)
    with pytest.raises(DeliveryError, match="exists already"):
        deliver(target)
    assert everything_below(tmp_path) == before


@pytest.mark.parametrize("mark", MARKS_OF_A_DELIVERY)
def test_overwrite_replaces_a_delivery_whole(tmp_path: Path, mark: str) -> None:
    target = tmp_path / "out"
    target.mkdir()
    (target / mark).write_text(MARK)
    (target / "skins.step").write_text("old")
    (target / ".DS_Store").write_text("litter")
    deliver(target, overwrite=True)
    assert everything_below(target) == sorted(WHOLE)
    assert everything_below(tmp_path) == sorted(["out", *(f"out/{name}" for name in WHOLE)])


def test_overwrite_fills_an_empty_folder(tmp_path: Path) -> None:
    (tmp_path / "out").mkdir()
    deliver(tmp_path / "out", overwrite=True)
    assert (tmp_path / "out" / "report.json").is_file()


def test_overwrite_never_replaces_a_folder_that_is_not_a_delivery(tmp_path: Path) -> None:
    target = tmp_path / "photographs"
    target.mkdir()
    (target / "family.jpg").write_text("precious")
    with pytest.raises(DeliveryError, match="is not a delivery"):
        deliver(target, overwrite=True)
    assert everything_below(tmp_path) == ["photographs", "photographs/family.jpg"]


def test_overwrite_never_deletes_a_file_that_cadpanel_did_not_write(tmp_path: Path) -> None:
    target = tmp_path / "out"
    deliver(target, "old")
    (target / "details.FCStd").write_text("a day's work")
    with pytest.raises(DeliveryError, match=r"also holds 'details\.FCStd'"):
        deliver(target, overwrite=True)
    assert everything_below(target) == ["details.FCStd", *WHOLE]
    assert (target / "panels.step").read_text() == "old"


@pytest.mark.parametrize("content", ["", "[]", '{"schema": "survey/2"}', "\xff\xfe"])
def test_a_report_of_another_program_does_not_make_a_folder_ours(tmp_path: Path, content: str) -> None:
    target = tmp_path / "survey"
    target.mkdir()
    (target / "report.json").write_text(content)
    with pytest.raises(DeliveryError, match="is not a delivery"):
        deliver(target, overwrite=True)
    assert (target / "report.json").read_text() == content


def test_a_file_that_comes_into_being_during_the_work_is_not_deleted_either(tmp_path: Path) -> None:
    target = tmp_path / "out"
    deliver(target, "old")

    def save_something_meanwhile() -> None:
        with delivery_folder(target, overwrite=True) as folder:
            (folder / "report.json").write_text(MARK)
            (target / "notes.txt").write_text("mine")

    with pytest.raises(DeliveryError, match=r"also holds 'notes\.txt'"):
        save_something_meanwhile()
    assert everything_below(tmp_path) == sorted(["out", "out/notes.txt", *(f"out/{name}" for name in WHOLE)])


def test_a_folder_that_came_into_being_during_the_work_is_not_replaced(tmp_path: Path) -> None:
    target = tmp_path / "out"

    def lose_the_race() -> None:
        with delivery_folder(target) as folder:
            (folder / "report.json").write_text("second")
            deliver(target, "first")

    with pytest.raises(DeliveryError, match="exists already"):
        lose_the_race()
    assert (target / "panels.step").read_text() == "first"
    assert everything_below(tmp_path) == sorted(["out", *(f"out/{name}" for name in WHOLE)])


@pytest.mark.parametrize("overwrite", [True, False])
def test_a_file_in_the_targets_place_is_refused(tmp_path: Path, *, overwrite: bool) -> None:
    (tmp_path / "out").write_text("a file")
    with pytest.raises(DeliveryError, match="is a file"):
        deliver(tmp_path / "out", overwrite=overwrite)
    assert (tmp_path / "out").read_text() == "a file"


@pytest.mark.parametrize("below", ["out", "deeper/out"])
def test_a_file_in_a_parents_place_is_refused(tmp_path: Path, below: str) -> None:
    (tmp_path / "parent").write_text("a file")
    with pytest.raises(DeliveryError, match="is a file, not a folder"):
        deliver(tmp_path / "parent" / below)
    assert everything_below(tmp_path) == ["parent"]


# ------------------------------------------------------------------------------------------------------ it goes wrong
@pytest.mark.parametrize("error", [KeyboardInterrupt(), SystemExit(143), PanelError("P1", "folds over."), KeyError(1)])
@pytest.mark.parametrize("overwrite", [True, False])
def test_whatever_stops_the_work_leaves_nothing_and_keeps_the_old(
    tmp_path: Path, error: BaseException, *, overwrite: bool
) -> None:
    target = tmp_path / "a" / "out"
    if overwrite:
        deliver(target, "old")
    before = everything_below(tmp_path)

    def stop_half_way() -> None:
        with delivery_folder(target, overwrite=overwrite) as folder:
            (folder / "report.json").write_text("half")
            raise error

    with pytest.raises(type(error)) as raised:
        stop_half_way()
    assert raised.value is error
    assert everything_below(tmp_path) == before
    if overwrite:
        assert (target / "panels.step").read_text() == "old"


def test_a_disk_that_is_full_is_one_sentence_about_the_target(tmp_path: Path) -> None:
    def fill_the_disk() -> None:
        with delivery_folder(tmp_path / "out") as folder:
            (folder / "panels.step").symlink_to("/dev/full")
            (folder / "panels.step").write_text("x" * 100)

    with pytest.raises(DeliveryError, match=r"out' cannot be written: the disk is full; nothing was written\.$"):
        fill_the_disk()
    assert everything_below(tmp_path) == []


def test_a_writers_own_complaint_does_not_show_the_hidden_folder(tmp_path: Path) -> None:
    def fill_the_disk() -> None:
        with delivery_folder(tmp_path / "out") as folder:
            (folder / "report.json").symlink_to("/dev/full")
            write_json(Record(), folder / "report.json")

    with pytest.raises(DeliveryError, match="the disk is full") as raised:
        fill_the_disk()
    assert ".cadpanel-" not in str(raised.value)
    assert everything_below(tmp_path) == []


def test_a_fault_of_another_file_is_not_blamed_on_the_target(tmp_path: Path) -> None:
    def read_what_is_missing() -> None:
        with delivery_folder(tmp_path / "out"):
            (tmp_path / "missing.step").read_text()

    with pytest.raises(FileNotFoundError, match=re.escape("missing.step")):
        read_what_is_missing()
    assert everything_below(tmp_path) == []


def refuse(code: int, below: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Let the operating system refuse to make any folder directly in `below`, as root is refused nothing."""
    make = Path.mkdir

    def mkdir(self: Path, mode: int = 0o777, parents: bool = False, exist_ok: bool = False) -> None:
        if self.parent == below:
            raise OSError(code, os.strerror(code), str(self))
        make(self, mode, parents, exist_ok)

    monkeypatch.setattr(Path, "mkdir", mkdir)


@pytest.mark.parametrize(
    ("code", "reason"),
    [
        (errno.EROFS, "the disk is read-only"),
        (errno.EACCES, "not permitted"),
        (errno.ENOSPC, "the disk is full"),
        (errno.EMLINK, "Too many links"),
    ],
)
@pytest.mark.parametrize("below", ["out", "a/out", "a/b/out"])
def test_a_place_that_cannot_be_written_to_is_refused_at_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, code: int, reason: str, below: str
) -> None:
    refuse(code, (tmp_path / below).parent, monkeypatch)
    began = []

    def begin() -> None:
        with delivery_folder(tmp_path / below):
            began.append(True)

    with pytest.raises(DeliveryError, match=reason):
        begin()
    assert not began
    assert everything_below(tmp_path) == []


def test_a_name_that_is_too_long_is_one_sentence(tmp_path: Path) -> None:
    with pytest.raises(DeliveryError, match="the name is too long"):
        deliver(tmp_path / ("x" * 300))
    assert everything_below(tmp_path) == []


@pytest.mark.parametrize("error", [OSError(errno.EBUSY, "Device or resource busy"), KeyboardInterrupt()])
@pytest.mark.parametrize("exchanges", [True, False])
def test_the_old_delivery_stays_when_the_new_one_cannot_take_its_place(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, error: BaseException, *, exchanges: bool
) -> None:
    target = tmp_path / "out"
    deliver(target, "old")
    rename = Path.rename

    def fail_for_the_new_one(self: Path, destination: Path) -> Path:
        if self.suffix == ".part":
            raise error
        return rename(self, destination)

    def fail(_one: Path, _other: Path) -> bool:
        if exchanges:
            raise error
        return False

    monkeypatch.setattr(folder_module, "exchanged", fail)
    monkeypatch.setattr(Path, "rename", fail_for_the_new_one)
    with pytest.raises((DeliveryError, KeyboardInterrupt)):
        deliver(target, overwrite=True)
    assert (target / "panels.step").read_text() == "old"
    assert everything_below(tmp_path) == sorted(["out", *(f"out/{name}" for name in WHOLE)])


def test_where_nothing_is_exchanged_two_renames_do(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(folder_module, "exchanged", lambda *_: False)
    deliver(tmp_path / "out", "old")
    deliver(tmp_path / "out", overwrite=True)
    assert (tmp_path / "out" / "panels.step").read_text() == "new"
    assert everything_below(tmp_path) == sorted(["out", *(f"out/{name}" for name in WHOLE)])


def clear_from_elsewhere(parent: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Do what another machine does that begins a delivery beside one that is being written."""
    with monkeypatch.context() as there:
        there.setattr("cadpanel.delivery.work_folders._host", lambda: "00000000")
        clear_left_behind(parent)


@pytest.mark.parametrize("exchanges", [True, False])
@pytest.mark.parametrize("when", ["put in place", "deleted"])
def test_an_old_delivery_that_is_being_replaced_is_not_left_behind_to_another_machine(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, when: str, *, exchanges: bool
) -> None:
    target, long_ago = tmp_path / "out", time.time() - 30 * 86_400.0
    deliver(target, "old")
    os.utime(target, (long_ago, long_ago))
    if not exchanges:
        monkeypatch.setattr(folder_module, "exchanged", lambda *_: False)
    rename, remove, seen = Path.rename, shutil.rmtree, list[Path]()

    def rename_while_another_clears(self: Path, destination: Path) -> Path:
        if when == "put in place" and self.suffix == ".part":
            clear_from_elsewhere(tmp_path, monkeypatch)
        return rename(self, destination)

    def remove_after_another_has_cleared(path: Path, ignore_errors: bool = False) -> None:
        if not ignore_errors:
            clear_from_elsewhere(tmp_path, monkeypatch)
            seen.extend(path.iterdir())
        remove(path, ignore_errors=ignore_errors)

    monkeypatch.setattr(Path, "rename", rename_while_another_clears)
    monkeypatch.setattr(shutil, "rmtree", remove_after_another_has_cleared)
    deliver(target, overwrite=True)
    assert (target / "panels.step").read_text() == "new"
    assert sorted(path.name for path in seen) == WHOLE
    assert everything_below(tmp_path) == sorted(["out", *(f"out/{name}" for name in WHOLE)])


def test_an_old_delivery_that_another_machine_has_deleted_is_not_missed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    target, remove = tmp_path / "out", shutil.rmtree
    deliver(target, "old")

    def remove_after_another(path: Path, ignore_errors: bool = False) -> None:
        remove(path)
        remove(path, ignore_errors=ignore_errors)

    monkeypatch.setattr(shutil, "rmtree", remove_after_another)
    deliver(target, overwrite=True)
    assert (target / "panels.step").read_text() == "new"


@pytest.mark.parametrize("name", ["panels.step", "Thumbs.db", "flat/note.dxf"])
def test_a_folder_under_the_name_of_a_file_is_nobodys_to_delete(tmp_path: Path, name: str) -> None:
    deliver(tmp_path / "out", "old")
    if (tmp_path / "out" / name).is_file():
        (tmp_path / "out" / name).unlink()
    (tmp_path / "out" / name).mkdir(parents=True)
    (tmp_path / "out" / name / "work.txt").write_text("a day's work")
    with pytest.raises(DeliveryError, match=f"also holds '{name}'"):
        deliver(tmp_path / "out", overwrite=True)
    assert (tmp_path / "out" / name / "work.txt").is_file()


def test_a_file_that_somebody_changed_is_not_deleted(tmp_path: Path) -> None:
    deliver(tmp_path / "out", "old")
    (tmp_path / "out" / "panels.step").write_text("with my notes")
    with pytest.raises(DeliveryError, match=r"'panels\.step' in .* was changed since cadpanel wrote it"):
        deliver(tmp_path / "out", overwrite=True)
    (tmp_path / "out" / "panels.step").unlink()
    deliver(tmp_path / "out", overwrite=True)
    assert (tmp_path / "out" / "panels.step").read_text() == "new"


REPLACE = """
import sys, pathlib
from cadpanel.delivery.folder import delivery_folder
sys.stdout.write("ready"); sys.stdout.flush()
for count in range(100_000):
    with delivery_folder(pathlib.Path(sys.argv[1]), overwrite=True) as folder:
        (folder / "report.json").write_text('{"schema": "cadpanel.report/1"}')
        (folder / "panels.step").write_text(f"{count}")
"""


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="elsewhere two renames have to do")
def test_whoever_is_killed_leaves_a_whole_delivery_and_the_next_run_clears_the_rest(tmp_path: Path) -> None:
    target = tmp_path / "out"
    deliver(target, "first")
    for number in range(cases(4, 60)):
        process = subprocess.Popen([sys.executable, "-c", REPLACE, str(target)], stdout=subprocess.PIPE)
        assert process.stdout is not None
        process.stdout.read(5)
        end = time.monotonic() + 0.05 + 0.005 * number
        while time.monotonic() < end:
            assert target.is_dir()  # whoever looks sees one
        process.kill()
        process.communicate()
        assert changed_files(target) == ()
    deliver(target, "last", overwrite=True)
    assert everything_below(tmp_path) == sorted(["out", *(f"out/{name}" for name in WHOLE)])


def test_an_old_delivery_that_cannot_be_deleted_is_told_and_the_new_one_stands(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    target = tmp_path / "out"
    deliver(target, "old")

    def fail(path: Path, ignore_errors: bool = False) -> None:
        if not ignore_errors:
            raise OSError(errno.EIO, "Input/output error", str(path))

    monkeypatch.setattr(shutil, "rmtree", fail)
    with pytest.raises(DeliveryError, match="is written, but what stood there before could not be deleted"):
        deliver(target, overwrite=True)
    assert (target / "panels.step").read_text() == "new"
