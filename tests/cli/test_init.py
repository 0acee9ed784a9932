from __future__ import annotations

from pathlib import Path

from tests.cli.conftest import Run


def test_what_init_writes_runs_and_is_not_replaced(run: Run, lip_step: Path, tmp_path: Path) -> None:
    path = tmp_path / "jobs" / "lip.toml"
    answer = run("init", lip_step, "--output", path)
    assert answer.code == 0, answer.err
    assert f"cadpanel run {path}" in answer.out
    assert "# 3 panels as they are drawn, 2 seams" in path.read_text(encoding="utf-8")
    assert run("run", path, "--out", tmp_path / "out", "--cache", tmp_path / "cache", "--quiet").code == 0
    assert (tmp_path / "out" / "lip" / "panels.step").is_file()
    again = run("init", lip_step, "-o", path)
    assert (again.code, again.is_one_sentence()) == (2, True)
    assert "exists already" in again.err
