from __future__ import annotations

from pathlib import Path

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
