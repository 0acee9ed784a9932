from __future__ import annotations

from pathlib import Path

import pytest

from cadpanel.jobs.read import read_job
from cadpanel.jobs.resolved import is_a_job, job_text
from tests.jobs.jobs import job, parts

RULES = '{shop = {radii = [250.5, 300]}, lock = [{panels = "N-*", corners = [0, 1]}]}'


def test_a_resolved_job_asks_for_the_same_from_any_folder(strip: Path, tmp_path: Path) -> None:
    values = f'method = "concurrent", drift_along = 0.7, fixings = "8@350,25", rules = {RULES}, network = "lip.step"'
    asked = parts(job(strip, f"A = {{{values}}}"))
    for folder in (tmp_path / "a", tmp_path / "b" / "c"):
        folder.mkdir(parents=True)
        path = folder / "job.toml"
        path.write_text(job_text(asked, folder), encoding="utf-8")
        assert is_a_job(path)
        again = parts(path)
        assert [task.key for _, task in again] == [task.key for _, task in asked]
        assert read_job(path).regions[0].settings == asked[0][0].settings
    assert not is_a_job(strip / "job.toml")


def test_a_resolved_job_means_the_same_wherever_it_is_run(
    strip: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Earlier deliveries are found from where a program runs, and what looks like a variable is none."""
    earlier = tmp_path / "run" / "build" / "$${nw}"
    earlier.mkdir(parents=True)
    (earlier / "report.json").write_text("{}", encoding="utf-8")
    monkeypatch.chdir(tmp_path / "run")
    rules = '{lock = [{panels = "N-01", delivery = "build/$$${nw}"}]}'
    asked = parts(job(strip, f'A = {{method = "concurrent", material = "$$${{x}}", rules = {rules}}}'))
    assert (asked[0][0].shop.material, *asked[0][1].locks) == ("$${x}", "build/$${nw}")
    path = tmp_path / "out" / "job.toml"
    path.parent.mkdir()
    path.write_text(job_text(asked, path.parent), encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    again = parts(path)
    assert [(task.key, task.contents) for _, task in again] == [(task.key, task.contents) for _, task in asked]
    assert job_text(again, path.parent) == path.read_text(encoding="utf-8")


def test_a_job_is_known_again_after_an_editor_has_marked_it(tmp_path: Path) -> None:
    path = tmp_path / "job.toml"
    path.write_text(job_text([], tmp_path), encoding="utf-8-sig")
    assert is_a_job(path)
