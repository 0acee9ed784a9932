from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from cadpanel.errors import SettingsError
from cadpanel.jobs.read import read_job
from cadpanel.jobs.region import Region
from cadpanel.jobs.task import located, program, task_of
from cadpanel.reference.settings import ReferenceSettings
from tests.jobs.jobs import job


def regions(folder: Path, strip: Path, text: str) -> list[Region]:
    folder.mkdir(exist_ok=True)
    (folder / "lip.step").write_bytes((strip / "lip.step").read_bytes())
    return list(read_job(job(folder, text)).regions)


def test_the_key_hangs_on_content_and_not_on_names_and_places(tmp_path: Path, strip: Path) -> None:
    a, b, c = regions(tmp_path / "a", strip, "A = {}\nB = {}\nC = {seed = 1}")
    (z,) = regions(tmp_path / "z", strip, 'Z = {outputs = ["step"], method = "local"}')
    assert task_of(a).key == task_of(b).key == task_of(z).key != task_of(c).key
    before = task_of(a)
    assert task_of(a, "1700000000").key != before.key
    a.reference.write_bytes(a.reference.read_bytes() + b"\n")
    assert task_of(a).key not in (before.key, task_of(c).key)
    with pytest.raises(SettingsError, match="has changed since the run began"):
        before.contents[0].read()


def test_another_reference_than_the_job_was_made_with_is_refused(tmp_path: Path, strip: Path) -> None:
    (a,) = regions(tmp_path, strip, "A = {}")
    own = task_of(a).contents[0].sha256
    assert task_of(replace(a, sha256=own)).key == task_of(a).key
    with pytest.raises(SettingsError, match="not the file that the job was made with"):
        task_of(replace(a, sha256="0" * 64))


def test_what_is_read_beside_the_reference_counts_by_its_content(tmp_path: Path, strip: Path) -> None:
    (tmp_path / "curves.step").write_bytes((strip / "lip.step").read_bytes() + b"\n")
    own, other, mesh = regions(
        tmp_path,
        strip,
        'A = {network = "lip.step"}\nB = {network = "curves.step"}\nC = {stations = [1], spine = "curves.step"}',
    )
    assert (task_of(own).beside, len(task_of(own).contents)) == (0, 1)
    assert (task_of(other).beside, len(task_of(other).contents)) == (1, 2)
    assert located(mesh.how, Path("x")).spine == Path("x")
    assert located(ReferenceSettings(), None) == ReferenceSettings()
    before = task_of(other).key
    (tmp_path / "curves.step").write_bytes((strip / "lip.step").read_bytes() + b"\n\n")
    assert task_of(other).key != before


def test_an_earlier_delivery_that_panels_are_locked_to_counts_by_its_report(
    tmp_path: Path, strip: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "earlier").mkdir()
    (tmp_path / "earlier" / "report.json").write_text("{}", encoding="utf-8")
    text = 'A = {method = "concurrent", rules = {lock = [{panels = ["N-01"], delivery = "earlier"}]}}'
    (a,) = regions(tmp_path, strip, text)
    task = task_of(a)
    assert task.locks == {"earlier": 1}
    (tmp_path / "earlier" / "report.json").write_text("{ }", encoding="utf-8")
    assert task_of(a).key != task.key


def test_the_program_is_told_by_its_text_and_what_it_computes_with() -> None:
    assert len(program()["text"]) == 64
    assert {"numpy", "scipy", "cadquery", "cadquery-ocp"} <= set(program()["packages"])
