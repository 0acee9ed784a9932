from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from cadpanel.delivery.outputs.catalogue import OUTPUTS
from cadpanel.delivery.outputs.output import Output
from cadpanel.errors import SettingsError
from cadpanel.jobs import task as module
from cadpanel.jobs.program import program, program_sum
from cadpanel.jobs.read import read_job
from cadpanel.jobs.region import Region
from cadpanel.jobs.task import Content, located, parts_of, task_of
from cadpanel.reference.settings import ReferenceSettings
from tests.jobs.jobs import job


def regions(folder: Path, strip: Path, text: str, *others: str) -> list[Region]:
    folder.mkdir(exist_ok=True)
    for name in ("lip.step", *others):
        (folder / name).write_bytes((strip / "lip.step").read_bytes())
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


def test_files_are_looked_at_once_a_run(tmp_path: Path, strip: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """So all regions of a run are about the same bytes, whoever writes them meanwhile."""
    seen, look = list[str](), module._content

    def looked(path: Path) -> Content:
        seen.append(path.name)
        found = look(path)
        path.write_bytes(path.read_bytes() + b"\n")
        return found

    asked = regions(tmp_path, strip, 'A = {}\nB = {network = "lip.step"}\nC = {network = "curves.step"}', "curves.step")
    monkeypatch.setattr(module, "_content", looked)
    tasks = [task for _, task in parts_of(asked)]
    assert seen == ["lip.step", "curves.step"]
    assert len({task.contents[0].sha256 for task in tasks}) == 1
    assert task_of(asked[0]).key != tasks[0].key


@pytest.mark.parametrize("output", [one for one in OUTPUTS if not one.always], ids=lambda one: str(one.name))
def test_a_task_needs_what_its_outputs_are_written_with(tmp_path: Path, strip: Path, output: Output) -> None:
    (a,) = regions(tmp_path, strip, f'A = {{outputs = ["{output.name}"]}}')
    assert task_of(a).needs == tuple(sorted(output.needs))
    assert task_of(a).program == program_sum(tuple(sorted(output.needs)))


def test_a_task_needs_what_its_files_are_read_with_whatever_they_are_called(tmp_path: Path, strip: Path) -> None:
    (tmp_path / "rhino.step").write_bytes(b"3D Geometry File Format ")
    own, other = regions(tmp_path, strip, 'A = {reference = "rhino.step"}\nB = {network = "rhino.step"}')
    assert task_of(own).needs == task_of(other).needs == ("rhino3dm",)


def test_the_key_hangs_on_the_program_with_what_the_task_needs(
    tmp_path: Path, strip: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    sheet, plain = regions(tmp_path, strip, 'A = {outputs = ["xlsx"]}\nB = {}')
    before = task_of(sheet).key, task_of(plain).key
    monkeypatch.setattr(module, "program", lambda needs: {**program(), **({"new": needs} if needs else {})})
    assert task_of(sheet).key != before[0]
    assert task_of(plain).key == before[1]
