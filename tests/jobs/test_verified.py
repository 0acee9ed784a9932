"""A job's folder is proved delivery by delivery, and the assembly on top of them by what their reports say."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from cadpanel.delivery.assemble import assemble
from cadpanel.delivery.hung import hung_by
from cadpanel.delivery.records.report import read_report
from cadpanel.delivery.sheets import say_nothing
from cadpanel.jobs.summary import read_summary, write_summary
from cadpanel.jobs.verified import assembly_faults, delivered_regions, is_folder_of_a_job, verified_region


@pytest.fixture
def out(done: Path, tmp_path: Path) -> Path:
    """A copy of the run's folder."""
    return Path(shutil.copytree(done, tmp_path / "out"))


def test_a_delivery_with_the_job_that_made_it_is_no_folder_of_a_job(done: Path, tmp_path: Path) -> None:
    assert is_folder_of_a_job(done)
    assert not is_folder_of_a_job(done / "A")
    assert not is_folder_of_a_job(done.parent)
    (tmp_path / "job.toml").write_text("[regions]", encoding="utf-8")
    assert not is_folder_of_a_job(tmp_path)


def test_every_delivery_is_verified_in_the_order_of_the_job_and_others_after_them(out: Path) -> None:
    assert delivered_regions(out) == ("A", "B", "C")
    shutil.copytree(out / "A", out / "0 left")
    shutil.rmtree(out / "B")
    (out / "C" / "panels.step").write_bytes((out / "C" / "panels.step").read_bytes() + b" ")
    assert delivered_regions(out) == ("A", "B", "C", "0 left")
    found = {name: verified_region(out / name, say_nothing) for name in ("A", "B", "C")}
    assert [found[name].holds for name in "ABC"] == [True, False, False]
    assert found["A"].panels == 2
    assert "it is not delivered: run the job" in found["B"].refused
    assert any("'panels.step' is not the file that was delivered" in said for said in found["C"].failures)


def test_what_the_assembly_says_otherwise_than_the_reports_is_named(out: Path) -> None:
    hung = {name: hung_by(read_report(out / name / "report.json")) for name in "ABC"}
    assert list(assembly_faults(out, hung)) == []
    moved = {name: type(one)(one.schema, (1.0, 2.5, 0.0)) if name == "B" else one for name, one in hung.items()}
    (fault,) = assembly_faults(out, moved)
    assert fault.startswith("building.step hangs 'B' at (")
    assert "its report at (1, 2.5, 0) mm: run the job again" in fault
    (out / "C" / "panels.step").unlink()
    (fault,) = assembly_faults(out, hung)
    assert "names 'C/panels.step', and there is no such file" in fault
    (out / "building.step").write_bytes(b"ISO-10303-21;")
    (fault,) = assembly_faults(out, hung)
    assert "is not as cadpanel wrote it: move it elsewhere" in fault
    (out / "building.step").unlink()
    (out / "building.step").mkdir()
    (fault,) = assembly_faults(out, hung)
    assert "building.step' cannot be read: Is a directory." in fault
    (out / "building.step").rmdir()
    assert list(assembly_faults(out, hung)) == []


@pytest.mark.parametrize(
    ("written", "other", "said"),
    [
        ("'B/panels.step'", "'A/panels.step'", ["hangs 'A' 2 times", "'B' does not hang in building.step"]),
        ("CARTESIAN_POINT('',(0.0,0.0,0.0))", "CARTESIAN_POINT('',(5.0,0.0,0.0))", ["hangs", "hangs", "hangs"]),
        ("DIRECTION('',(1.,0.,0.))", "DIRECTION('',(0.,1.,0.))", ["says otherwise than the deliveries"]),
        ("_ASSIGNMENT('B/panels.step'", "_ASSIGNMENT('A/panels.step'", ["says otherwise than the deliveries"]),
        ("PRODUCT('building/B'", "PRODUCT('building/A'", ["says otherwise than the deliveries"]),
        (".MILLI.", "$", ["says otherwise than the deliveries"]),
        ("DATA;", "DATA;\n#999=DIRECTION('',(0.,1.,0.));", ["says otherwise than the deliveries"]),
    ],
)
def test_every_word_of_the_assembly_is_proved(out: Path, written: str, other: str, said: list[str]) -> None:
    hung = {name: hung_by(read_report(out / name / "report.json")) for name in "ABC"}
    path = out / "building.step"
    text = path.read_text(encoding="ascii")
    assert written in text
    path.write_text(text.replace(written, other), encoding="ascii")
    faults = list(assembly_faults(out, hung))
    assert len(faults) == len(said)
    assert all(word in fault for word, fault in zip(said, faults, strict=True))


def test_what_the_summary_says_does_not_hang_there_need_not(out: Path) -> None:
    hung = {name: hung_by(read_report(out / name / "report.json")) for name in "ABC"}
    summary = read_summary(out / "summary.json")
    write_summary(summary.model_copy(update={"unassembled": "Not 'C'."}), out)
    assemble([out / "A", out / "B"], out / "building.step")
    assert list(assembly_faults(out, hung)) == []
    write_summary(summary, out)
    (fault,) = assembly_faults(out, hung)
    assert fault == "'C' does not hang in building.step: run the job again."
