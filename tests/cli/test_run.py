"""`cadpanel run`: what it writes, says and refuses, with which exit code."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import cadpanel as cp
from tests.cli.conftest import Run

JOB = """
out = "out"
[defaults]
reference = "lip.step"
outputs = ["step"]
method = "local"
[regions.A]
only = ["N-01"]
[regions.B]
only = ["none"]
"""


@pytest.fixture
def job(tmp_path: Path, lip_step: Path) -> Path:
    (tmp_path / "lip.step").write_bytes(lip_step.read_bytes())
    path = tmp_path / "job.toml"
    path.write_text(JOB, encoding="utf-8")
    return path


def test_a_job_is_run_told_and_summed_up_and_its_worst_region_is_the_exit_code(
    run: Run, job: Path, tmp_path: Path
) -> None:
    words = ("run", job, "--cache", tmp_path / "cache")
    answer = run(*words)
    assert answer.code == 2
    assert "1 of 2: A: 3 panels, RMS" in answer.err
    assert "2 of 2: B: no delivery: there is no panel 'none' to deliver" in answer.err
    assert "B: there is no panel 'none'" in answer.out
    assert "1 region of 2 with 3 panels, 1 made now" in answer.out
    assert {path.name for path in (tmp_path / "out").iterdir()} == {"A", "job.toml", "summary.csv", "summary.json"}

    verified = run("verify", tmp_path / "out")
    assert verified.code == 2
    assert "Deliveries that hold: 1 of 2, with 3 panels." in verified.out
    assert verified.err.endswith("B: job.toml has the region, and it is not delivered: run the job.\n")

    job.write_text(JOB.partition("[regions.B]")[0], encoding="utf-8")
    told = run(*words, "--tell-steps", "--quiet")
    assert (told.code, told.out) == (1, "")
    (line,) = map(json.loads, told.err.splitlines())
    assert (line["region"], line["state"], line["met"]) == ("A", "there", False)
    kept = run(*words, "--out", tmp_path / "other", "--quiet")
    assert (kept.code, kept.out) == (1, "")
    assert kept.err.startswith("A: The step of 3 mm is not met")
    assert kept.err.count("\n") == 1
    assert (tmp_path / "other" / "A" / "job.toml").is_file()
    assert run("verify", tmp_path / "other" / "A", "--quiet").code == 0
    verified = run("verify", tmp_path / "other")
    assert (verified.code, verified.err) == (0, "")
    assert "Deliveries that hold: 1 of 1, with 3 panels.\nEverything holds.\n" in verified.out
    assert run("verify", tmp_path / "other", "--quiet").out == ""
    refused = run("verify", tmp_path / "other", "--reference", job)
    assert (refused.code, refused.is_one_sentence()) == (2, True)
    assert "name that of a region" in refused.err


def test_variants_that_do_not_hang_and_deliveries_that_are_no_region_are_named(
    run: Run, job: Path, tmp_path: Path
) -> None:
    words = ("run", job, "--cache", tmp_path / "cache")
    job.write_text(JOB.replace("method", "matrix = {joint = [5, 8]}\nmethod"), encoding="utf-8")
    answer = run(*words)
    assert "only the first of each hangs there, not 'A-joint=8'." in answer.out
    job.write_text(JOB.replace("regions.A", "regions.Other"), encoding="utf-8")
    refused = run(*words)
    assert (refused.code, refused.is_one_sentence()) == (2, True)
    assert "lacks ('A-joint=5', 'A-joint=8'): name another folder" in refused.err
    for quiet in ((), ("--quiet",)):
        answer = run(*words, "--overwrite", *quiet)
        assert "by an earlier job and no region of this one: 'A-joint=5', 'A-joint=8'" in answer.out + answer.err


def test_python_runs_a_job_as_the_command_does(job: Path, tmp_path: Path) -> None:
    rows: list[str] = []
    summary = cp.run_job(job, tmp_path / "here", cache=tmp_path / "cache", tell=lambda row: rows.append(row.region))
    assert rows == ["A", "B"]
    assert [(row.region, row.state, row.panels) for row in summary.rows] == [("A", "made", 3), ("B", "none", None)]
    assert summary.code == 2
    assert {path.name for path in (tmp_path / "here").iterdir()} == {"A", "job.toml", "summary.csv", "summary.json"}
    with pytest.raises(cp.SettingsError, match="at least 1 worker"):
        cp.run_job(job, tmp_path / "here", workers=0)
    with pytest.raises(cp.SettingsError, match="give one of the two"):
        cp.run_job(job, tmp_path / "here", workers=2, scheduler="tcp://127.0.0.1:1")


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--workers", "2", "--scheduler", "tcp://127.0.0.1:1"], "give one of the two"),
        (["--workers", "0"], "--workers"),
    ],
)
def test_options_that_mean_nothing_are_refused(run: Run, job: Path, words: list[str], said: str) -> None:
    answer = run("run", job, *words)
    assert answer.code == 2
    assert answer.is_one_sentence()
    assert said in answer.err


def test_a_job_that_is_wrong_or_goes_nowhere_is_refused_before_anything_is_written(
    run: Run, job: Path, tmp_path: Path
) -> None:
    job.write_text(JOB.replace('out = "out"', ""), encoding="utf-8")
    assert "names no folder to write into" in run("run", job).err
    job.write_text(JOB.replace("method", "methd"), encoding="utf-8")
    answer = run("run", job)
    assert (answer.code, answer.is_one_sentence()) == (2, True)
    assert "line 6: there is no setting 'methd' of a region; perhaps 'method'" in answer.err
    assert {path.name for path in tmp_path.iterdir()} == {"job.toml", "lip.step"}
