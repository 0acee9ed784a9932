"""What comes of a job: the law that regions do not know of each other, and what stops, stays and is made again."""

from __future__ import annotations

import shutil
from collections.abc import Iterator, Sequence
from pathlib import Path

import pytest

from cadpanel.errors import DeliveryError
from cadpanel.jobs.archive import packed
from cadpanel.jobs.engine.engine import TellOf
from cadpanel.jobs.engine.serial import Serial
from cadpanel.jobs.results import Results
from cadpanel.jobs.run import Place, make_regions
from cadpanel.jobs.summary import read_summary
from cadpanel.jobs.task import Task
from cadpanel.jobs.work import FAILED, MET, Made
from tests.jobs.jobs import files, job, made, parts


class Counting:
    """An engine that counts, and gives copies of one delivery; it is interrupted before the task of a key."""

    def __init__(self, delivery: Path, stops_at: str = "", fails_at: str = "") -> None:
        self.archive = packed(delivery, None)
        self.worked, self.stops_at, self.fails_at = list[str](), stops_at, fails_at

    def run(self, tasks: Sequence[Task], tell: TellOf) -> Iterator[Made]:
        for task in tasks:
            if task.name == self.stops_at:
                raise KeyboardInterrupt
            tell(task.name, "Read reference", 0, 1, "")
            self.worked.append(task.name)
            if task.name == self.fails_at:
                yield Made(key=task.key, code=FAILED, archive=None, said="ValueError: no", details="line 1", tries=3)
            else:
                yield Made(key=task.key, code=MET, archive=self.archive, said=None)


@pytest.fixture
def source(done: Path, tmp_path: Path) -> Path:
    """A delivery as engines give it."""
    folder = Path(shutil.copytree(done / "A", tmp_path / "source"))
    (folder / "job.toml").unlink()
    return folder


THREE = "A = {}\nB = {seed = 1}\nC = {seed = 2}"


def test_a_region_alone_is_as_among_others_in_any_order(done: Path, strip: Path, tmp_path: Path) -> None:
    made(job(strip, "C = {divide = 2}\nOther = {thickness = 4}\nA = {}"), tmp_path / "out")
    made(job(strip, "A = {}"), tmp_path / "alone")
    alone = files(tmp_path / "alone" / "A")
    assert {"panels.step", "skins.step", "job.toml"} <= set(alone)
    assert files(done / "A") == files(tmp_path / "out" / "A")
    assert {**alone, "job.toml": b""} == {**files(done / "A"), "job.toml": b""}
    assert files(done / "C") == files(tmp_path / "out" / "C")
    assert files(done / "A")["panels.step"] != files(done / "B")["panels.step"]


def test_every_delivery_holds_the_job_that_gives_it_again(done: Path, tmp_path: Path) -> None:
    engine = Counting(done / "A")
    with Results(done.parent / "cache") as results:
        again = made(done / "C" / "job.toml", tmp_path / "again", results, engine)
        whole = made(done / "job.toml", tmp_path / "whole", results, engine)
    assert engine.worked == []
    assert [row.state for row in (*again.rows, *whole.rows)] == ["kept"] * 4
    for name in ("A", "B", "C"):
        assert {**files(done / name), "job.toml": b""} == {**files(tmp_path / "whole" / name), "job.toml": b""}
    assert (tmp_path / "again" / "C" / "panels.step").read_bytes() == (done / "C" / "panels.step").read_bytes()


def test_an_interrupted_run_leaves_what_is_done_and_goes_on(strip: Path, source: Path, tmp_path: Path) -> None:
    path, out = job(strip, THREE), tmp_path / "out"
    with Results(tmp_path / "cache") as results:
        with pytest.raises(KeyboardInterrupt):
            made(path, out, results, Counting(source, stops_at="C"))
        assert [row.state for row in read_summary(out / "summary.json").rows] == ["made", "made", "waiting"]
        assert {entry.name for entry in out.iterdir()} == {
            "A",
            "B",
            "building.step",
            "job.toml",
            "summary.csv",
            "summary.json",
        }
        engine = Counting(source)
        rest = made(path, out, results, engine)
    assert (engine.worked, [row.state for row in rest.rows]) == (["C"], ["there", "there", "made"])


def test_changing_one_region_makes_that_one_again(strip: Path, source: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    made(job(strip, THREE), out, None, Counting(source))
    changed = parts(job(strip, THREE.replace("seed = 1", "seed = 9")))
    engine = Counting(source)
    with pytest.raises(DeliveryError, match=r"B' exists already"):
        make_regions(changed, Place(out=out), lambda: engine, None, lambda *_: None)
    summary = make_regions(changed, Place(out=out, overwrite=True), lambda: engine, None, lambda *_: None)
    assert (engine.worked, [row.state for row in summary.rows]) == (["B"], ["there", "made", "there"])


def test_a_region_that_fails_is_named_and_the_others_go_on(strip: Path, source: Path, tmp_path: Path) -> None:
    summary = made(job(strip, THREE), tmp_path / "out", None, Counting(source, fails_at="B"))
    assert summary.code == FAILED
    assert [row.state for row in summary.rows] == ["made", "none", "made"]
    assert (summary.rows[1].said, summary.rows[1].details, summary.rows[1].tries) == ("ValueError: no", "line 1", 3)
    assert not (tmp_path / "out" / "B").exists()


def test_regions_of_the_same_content_are_made_once(strip: Path, source: Path, tmp_path: Path) -> None:
    engine = Counting(source)
    summary = made(job(strip, "A = {}\nB = {}"), tmp_path / "out", None, engine)
    assert (engine.worked, [row.state for row in summary.rows]) == (["A"], ["made", "made"])


def test_fresh_ignores_what_was_made_before_and_asks_before_it_replaces(
    strip: Path, source: Path, tmp_path: Path
) -> None:
    path, engine = job(strip, "A = {}"), Counting(source)
    with Results(tmp_path / "cache") as results:
        made(path, tmp_path / "out", results, engine)
        place = Place(out=tmp_path / "out", fresh=True)
        with pytest.raises(DeliveryError, match="exists already"):
            make_regions(parts(path), place, lambda: engine, results, lambda *_: None)
        place = Place(out=tmp_path / "out", fresh=True, overwrite=True)
        make_regions(parts(path), place, lambda: engine, results, lambda *_: None)
        made(path, tmp_path / "kept", results, engine)
    assert engine.worked == ["A", "A"]


def test_a_changed_file_is_nothing_that_stands_there_and_is_not_replaced(
    strip: Path, source: Path, tmp_path: Path
) -> None:
    path, out = job(strip, "A = {}"), tmp_path / "out"
    made(path, out, None, Counting(source))
    (out / "A" / "panels.step").write_bytes(b"mine")
    with pytest.raises(DeliveryError, match="exists already"):
        made(path, out, None, Counting(source))
    with pytest.raises(DeliveryError, match="was changed since"):
        make_regions(parts(path), Place(out=out, overwrite=True), Serial, None, lambda *_: None)


def test_a_folder_of_something_else_is_left_alone(strip: Path, done: Path, tmp_path: Path) -> None:
    (tmp_path / "job.toml").write_text("[regions]", encoding="utf-8")
    for out in (tmp_path, done / "A" / "flat", done.parent):
        if out.is_dir():
            with pytest.raises(DeliveryError, match=r"holds files but no job\.toml that cadpanel wrote"):
                made(job(strip, "A = {}"), out, None, Serial())
