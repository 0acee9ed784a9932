"""The assembly of a job's regions: there where two can be put together, and never older than they are."""

from __future__ import annotations

import errno
import os
import shutil
from collections.abc import Sequence
from pathlib import Path

import pytest

from cadpanel.brep.files.loading import load_model
from cadpanel.brep.step.hung_files import hung_files
from cadpanel.delivery.hung import Hung, hung_by
from cadpanel.delivery.records.report import read_report
from cadpanel.jobs.building import BUILDING, put_together
from cadpanel.jobs.read import read_job
from cadpanel.jobs.region import Region
from cadpanel.jobs.resolved import job_text
from cadpanel.jobs.summary import read_summary
from tests.jobs.jobs import job, parts

Hanging = list[tuple[Region, Hung]]


@pytest.fixture
def out(done: Path, tmp_path: Path) -> Path:
    """A copy of the run's folder."""
    return Path(shutil.copytree(done, tmp_path / "out"))


def hung(done: Path, out: Path, names: str) -> Hanging:
    """Some regions of the run, as their reports say in a folder."""
    regions = {region.name: region for region in read_job(done / "job.toml").regions}
    return [(regions[name], hung_by(read_report(out / name / "report.json"))) for name in names]


def delivered(done: Path, out: Path, regions: Sequence[Region]) -> Hanging:
    """Regions for each of which there is the same delivery in a folder."""
    told = hung_by(read_report(done / "A" / "report.json"))
    for region in regions:
        shutil.copytree(done / "A", out / region.name, dirs_exist_ok=True)
    return [(region, told) for region in regions]


def names_in(out: Path) -> list[str]:
    return [file.path.partition("/")[0] for file in hung_files(out / BUILDING)]


def test_all_panels_of_a_run_hang_in_one_file_beside_the_summary(done: Path) -> None:
    assert read_summary(done / "summary.json").assembly == BUILDING
    assert names_in(done) == ["A", "B", "C"]
    panels = sum(len(load_model(done / name / "panels.step").parts) for name in "ABC")
    assert len(load_model(done / BUILDING).parts) == panels


def test_without_two_files_there_is_none_and_an_earlier_one_goes(done: Path, out: Path) -> None:
    (out / "B" / "panels.step").unlink()
    assert put_together(out, hung(done, out, "AB")) == (False, None)
    assert not (out / BUILDING).exists()


def test_files_of_two_schemas_are_not_put_together_and_it_is_said_why(done: Path, out: Path) -> None:
    report = out / "B" / "report.json"
    report.write_text(report.read_text(encoding="utf-8").replace('"step_schema": "AP242"', '"step_schema": "AP214"'))
    written, said = put_together(out, hung(done, out, "ABC"))
    assert not written
    assert said is not None
    assert "AP214" in said
    assert not (out / BUILDING).exists()


@pytest.mark.parametrize(
    ("matrix", "all_hang"),
    [
        ("thickness = [2, 3], joint = [5, 8]", False),
        ('only = [["N-01"], ["N-02"]]', True),
        ('reference = ["lip.step", "other.step"]', True),
        ('faces = [["1"], ["2"]]', True),
    ],
)
def test_of_variants_that_lie_in_one_place_the_first_hangs_and_the_others_are_named(
    done: Path, strip: Path, tmp_path: Path, matrix: str, all_hang: bool
) -> None:
    for name in ("lip.step", "other.step"):
        shutil.copy(strip / "lip.step", tmp_path / name)
    asked = parts(job(tmp_path, f"S-W = {{matrix = {{{matrix}}}}}\nN = {{thickness = 2}}\nN-2 = {{thickness = 3}}"))
    out = tmp_path / "out"
    out.mkdir()
    (tmp_path / "resolved.toml").write_text(job_text(asked, tmp_path), encoding="utf-8")
    again = read_job(tmp_path / "resolved.toml").regions  # which knows no matrix any more
    for regions in ([region for region, _ in asked], again):
        names = [region.name for region in regions]
        written, said = put_together(out, delivered(done, out, regions))
        assert written
        assert names_in(out) == (names if all_hang else [names[0], "N", "N-2"])
        assert (said is None) is all_hang
        assert all((f"'{name}'" in (said or "")) is not all_hang for name in names[1:-2])


def test_a_name_that_readers_do_not_find_leaves_out_that_region_alone(done: Path, strip: Path, tmp_path: Path) -> None:
    (tmp_path / "out").mkdir()
    regions = [region for region, _ in parts(job(strip, 'A = {}\n"Süd" = {}\nB = {}'))]
    written, said = put_together(tmp_path / "out", delivered(done, tmp_path / "out", regions))
    assert (written, names_in(tmp_path / "out")) == (True, ["A", "B"])
    assert said is not None
    assert "'Süd'" in said
    assert "rename" in said


@pytest.mark.parametrize("regions", ["A", "ABC"])
def test_what_is_not_as_it_was_written_here_is_left_alone(done: Path, out: Path, regions: str) -> None:
    place = out / BUILDING
    saved = place.read_bytes().replace(b"'cadpanel','cadpanel',''", b"'OCCT','FreeCAD',''")
    place.write_bytes(saved)
    for replace in (False, True):
        if replace:
            place.unlink()
            place.mkdir()
        written, said = put_together(out, hung(done, out, regions))
        assert not written
        assert (said is None) == (regions == "A")  # of which none would have been written
        assert said is None or "is left alone: move it elsewhere" in said
        assert place.is_dir() if replace else place.read_bytes() == saved


def test_an_assembly_that_cannot_be_deleted_is_told_of(done: Path, out: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(_self: Path, missing_ok: bool = False) -> None:
        raise PermissionError(errno.EACCES, f"in use {missing_ok}")

    monkeypatch.setattr(Path, "unlink", refuse)
    written, said = put_together(out, hung(done, out, "A"))
    assert not written
    assert "of an earlier run cannot be deleted: in use" in (said or "")


def test_a_full_disk_leaves_the_earlier_assembly(done: Path, out: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(_handle: int) -> None:
        raise OSError(errno.ENOSPC, "no space left")

    before = (out / BUILDING).read_bytes()
    monkeypatch.setattr(os, "fsync", full)
    written, said = put_together(out, hung(done, out, "AB"))
    assert not written
    assert "no space left" in (said or "")
    assert "is of an earlier run" in (said or "")
    assert (out / BUILDING).read_bytes() == before
