"""The assembly of a job's regions: there where two can be put together, and never older than they are."""

from __future__ import annotations

import shutil
from pathlib import Path

from cadpanel.brep.files.loading import load_model
from cadpanel.delivery.hung import Hung, hung_by
from cadpanel.delivery.records.report import read_report
from cadpanel.jobs.building import BUILDING, put_together
from cadpanel.jobs.summary import read_summary


def hung(out: Path, regions: str) -> dict[str, Hung]:
    return {name: hung_by(read_report(out / name / "report.json")) for name in regions}


def test_all_panels_of_a_run_hang_in_one_file_beside_the_summary(done: Path) -> None:
    assert read_summary(done / "summary.json").assembly == BUILDING
    assert (done / BUILDING).read_text(encoding="ascii").count("'B/panels.step'") >= 1
    delivered = sum(len(load_model(done / name / "panels.step").parts) for name in "ABC")
    assert len(load_model(done / BUILDING).parts) == delivered


def test_without_two_files_there_is_none_and_an_earlier_one_goes(done: Path, tmp_path: Path) -> None:
    shutil.copytree(done, tmp_path / "out")
    (tmp_path / "out" / "B" / "panels.step").unlink()
    assert put_together(tmp_path / "out", hung(tmp_path / "out", "AB")) == (False, None)
    assert not (tmp_path / "out" / BUILDING).exists()


def test_files_of_two_schemas_are_not_put_together_and_it_is_said_why(done: Path, tmp_path: Path) -> None:
    shutil.copytree(done, tmp_path / "out")
    report = tmp_path / "out" / "B" / "report.json"
    report.write_text(report.read_text(encoding="utf-8").replace('"step_schema": "AP242"', '"step_schema": "AP214"'))
    written, said = put_together(tmp_path / "out", hung(tmp_path / "out", "ABC"))
    assert not written
    assert said is not None
    assert "AP214" in said
