"""What comes of a job: the law that regions do not know of each other, and what stops, stays and is made again."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import NoReturn

import pytest

from cadpanel.delivery import folder as delivery
from cadpanel.errors import DeliveryError, SettingsError
from cadpanel.jobs import run as running
from cadpanel.jobs.archive import packed
from cadpanel.jobs.engine.engine import TellOf
from cadpanel.jobs.engine.serial import Serial
from cadpanel.jobs.results import Results
from cadpanel.jobs.run import Place, make_regions
from cadpanel.jobs.summary import SummaryModel, read_summary
from cadpanel.jobs.task import Task
from cadpanel.jobs.work import FAILED, MET, REFUSED, Made
from tests.jobs.jobs import DATE, files, job, made, parts


class Counting:
    """An engine that counts, and gives copies of one delivery; it is interrupted before the task of a key.

    Whatever happens besides while it works at a task is `meanwhile`, which is told its name.
    """

    def __init__(
        self, delivery: Path, stops_at: str = "", fails_at: str = "", meanwhile: Callable[[str], None] = lambda _: None
    ) -> None:
        self.archive = packed(delivery, None)
        self.worked, self.stops_at, self.fails_at, self.meanwhile = list[str](), stops_at, fails_at, meanwhile

    def run(self, tasks: Sequence[Task], tell: TellOf) -> Iterator[Made]:
        for task in tasks:
            self.meanwhile(task.name)
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


class Full(Results):
    """A cache on a disk that is full, from the beginning or once something is to be kept."""

    def __init__(self, folder: Path, *, hits: bool) -> None:
        super().__init__(folder)
        self.asked, self.hits = list[str](), hits

    def get(self, key: str) -> bytes | None:
        self.asked.append("get")
        return super().get(key) if self.hits else self._refuse(key)

    def put(self, key: str, made: bytes) -> None:
        self.asked.append("put")
        self._refuse(f"{key} of {len(made)} bytes")

    def _refuse(self, what: str) -> NoReturn:
        raise SettingsError(f"results cannot be kept in 'cache' (full, {what}): delete that folder")


@pytest.mark.parametrize(("hits", "asked"), [(True, ["get"] * 3 + ["put"]), (False, ["get"])])
def test_a_cache_that_is_full_costs_no_delivery_and_is_told_of_once(
    strip: Path, source: Path, tmp_path: Path, hits: bool, asked: list[str]
) -> None:
    with Full(tmp_path / "cache", hits=hits) as results:
        summary = made(job(strip, THREE), tmp_path / "out", results, Counting(source))
    assert (summary.code, [row.state for row in summary.rows]) == (MET, ["made"] * 3)
    assert results.asked == asked
    (remark,) = summary.remarks
    assert "results cannot be kept in 'cache' (full, " in remark


def test_a_region_that_finds_no_place_ends_nothing_and_is_not_made_again(
    strip: Path, source: Path, tmp_path: Path
) -> None:
    path, out = job(strip, THREE), tmp_path / "out"
    engine = Counting(source, meanwhile=lambda name: (out / name).touch() if name == "B" else None)
    with Results(tmp_path / "cache") as results:
        summary = made(path, out, results, engine)
        assert (summary.code, [row.state for row in summary.rows]) == (REFUSED, ["made", "none", "made"])
        assert "B' is a file: name a folder" in (summary.rows[1].said or "")
        assert summary.assembly == "building.step"
        (out / "B").unlink()
        rest = made(path, out, results, engine)
    assert ([row.state for row in rest.rows], engine.worked) == (["there", "kept", "there"], ["A", "B", "C"])


def test_what_stands_there_in_the_end_is_no_refusal_whoever_has_put_it_there(
    strip: Path, source: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path, out = job(strip, "A = {}"), tmp_path / "out"
    made(path, tmp_path / "other", None, Counting(source))
    engine = Counting(source, meanwhile=lambda name: _copied(tmp_path / "other" / name, out / name))
    assert [row.state for row in made(path, out, None, engine).rows] == ["there"]

    def undeleted(aside: Path, target: Path) -> None:
        raise DeliveryError(f"'{target}' is written, but what stood there before could not be deleted from '{aside}'")

    monkeypatch.setattr(delivery, "_delete", undeleted)
    again = anew(path, out, Counting(source))
    assert [(row.state, row.panels) for row in again.rows] == [("there", 2)]
    assert "could not be deleted" in again.remarks[0]


def _copied(source: Path, target: Path) -> None:
    shutil.copytree(source, target)


def anew(path: Path, out: Path, engine: Counting) -> SummaryModel:
    """Run a job for which all is made again and may be replaced."""
    place = Place(out=out, fresh=True, overwrite=True)
    return make_regions(parts(path), place, lambda: engine, None, lambda *_: None)


def test_two_runs_do_not_write_into_one_folder_and_the_summary_is_of_the_one_at_it(
    strip: Path, source: Path, tmp_path: Path
) -> None:
    path, out = job(strip, THREE), tmp_path / "out"
    states = list[list[str]]()

    def meanwhile(_name: str) -> None:
        with pytest.raises(DeliveryError, match="another run writes into"):
            made(path, out, None, Counting(source))
        states.append([row.state for row in read_summary(out / "summary.json").rows])

    made(path, out, None, Counting(source, meanwhile=meanwhile))
    anew(path, out, Counting(source, meanwhile=meanwhile))
    # Of the run that is killed then the summary says that nothing is known yet, and not what an earlier one did.
    assert states == [["waiting"] * 3] * 6
    assert [row.state for row in read_summary(out / "summary.json").rows] == ["made"] * 3


def test_what_was_to_be_made_anew_and_was_not_still_hangs_in_the_building(
    strip: Path, source: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", DATE)
    path, out = job(strip, THREE), tmp_path / "out"
    made(path, out, None, Counting(source))
    building = (out / "building.step").read_bytes()
    with pytest.raises(KeyboardInterrupt):
        anew(path, out, Counting(source, stops_at="A"))
    summary = read_summary(out / "summary.json")
    assert [row.state for row in summary.rows] == ["waiting"] * 3
    assert (summary.assembly, summary.remarks) == ("building.step", ())
    assert (out / "building.step").read_bytes() == building


@pytest.mark.parametrize("stops_at", ["", "B"])
def test_the_summary_is_written_whatever_comes_of_the_building(
    strip: Path, source: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, stops_at: str
) -> None:
    """A kernel that was interrupted while it loaded fails to load again, which is not what stopped the run."""

    def fail(*_: object) -> None:
        raise ImportError("generic_type: type is already defined")

    monkeypatch.setattr(running, "put_together", fail)
    with pytest.raises(KeyboardInterrupt if stops_at else ImportError):
        made(job(strip, THREE), tmp_path / "out", None, Counting(source, stops_at=stops_at))
    states = ["made", "waiting", "waiting"] if stops_at else ["made"] * 3
    assert [row.state for row in read_summary(tmp_path / "out" / "summary.json").rows] == states


def test_a_job_of_other_regions_asks_before_it_takes_a_folder_and_names_what_it_leaves(
    strip: Path, source: Path, tmp_path: Path
) -> None:
    out = tmp_path / "out"
    made(job(strip, THREE), out, None, Counting(source))
    before = {path: path.read_bytes() for path in out.iterdir() if path.is_file()}
    fewer = parts(job(strip, "A = {}\nD = {seed = 3}"))
    with pytest.raises(DeliveryError, match=r"regions that this job lacks \('B', 'C'\): name another .* --overwrite"):
        make_regions(fewer, Place(out=out), lambda: Counting(source), None, lambda *_: None)
    assert {path: path.read_bytes() for path in out.iterdir() if path.is_file()} == before
    for place in (Place(out=out, overwrite=True), Place(out=out)):
        summary = make_regions(fewer, place, lambda: Counting(source), None, lambda *_: None)
        (remark,) = summary.remarks
        assert "no region of this one: 'B', 'C'" in remark


def test_an_earlier_delivery_of_a_region_that_fails_now_is_named(strip: Path, source: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    made(job(strip, THREE), out, None, Counting(source))
    changed = parts(job(strip, THREE.replace("seed = 1", "seed = 9")))
    engine = Counting(source, fails_at="B")
    summary = make_regions(changed, Place(out=out, overwrite=True), lambda: engine, None, lambda *_: None)
    assert [row.state for row in summary.rows] == ["there", "none", "there"]
    assert summary.remarks == ("Still there as an earlier run delivered it, not as this job asks: 'B'.",)


def test_a_folder_of_something_else_is_left_alone(strip: Path, done: Path, tmp_path: Path) -> None:
    (tmp_path / "job.toml").write_text("[regions]", encoding="utf-8")
    for out in (tmp_path, done.parent):
        with pytest.raises(DeliveryError, match=r"holds files but no job\.toml that cadpanel wrote"):
            made(job(strip, "A = {}"), out, None, Serial())
    before = files(done / "A")
    with pytest.raises(DeliveryError, match="A' is a delivery, and regions do not go into one: name another folder"):
        made(done / "A" / "job.toml", done / "A", None, Serial())
    assert files(done / "A") == before
