"""`cadpanel compare`: the paper's Table 1 for one reference."""

from __future__ import annotations

from pathlib import Path

import pytest

from cadpanel.delivery.records.comparison import read_comparison
from tests.cli.conftest import Run


def test_four_columns_are_written_and_printed(run: Run, lip_step: Path, tmp_path: Path) -> None:
    answer = run("compare", lip_step, "--out", tmp_path / "out", "--gap-tolerance", "2")
    assert answer.code == 0, answer.err
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == ["compare.json", "manifest.json"]
    comparison = read_comparison(tmp_path / "out" / "compare.json")
    assert comparison.seams == (("N-01", "N-02"), ("N-02", "N-03"))
    assert [(column.method, column.feature) for column in comparison.columns] == [
        ("two_stage", "plane-cylinder-plane"),
        ("two_stage", "plane-cone-plane"),
        ("concurrent", "plane-cylinder-plane"),
        ("concurrent", "plane-cone-plane"),
    ]
    for column in comparison.columns:
        assert max(column.max_corner_gap) == column.summary.max_corner_gap
        if column.method == "concurrent":
            assert column.summary.tolerance_met
            assert column.summary.max_seam_gap <= 2.0
    for words in ("N-01 - N-02", "RMS deviation, mm", "not met", "Time of the fit"):
        assert words in answer.out


def test_an_existing_folder_is_refused_before_the_reference_is_read(run: Run, tmp_path: Path) -> None:
    answer = run("compare", "no such file.step", "--out", tmp_path)
    assert answer.code == 2
    assert answer.is_one_sentence()
    assert "exists already" in answer.err


@pytest.mark.parametrize("options", ["--gap-tolerance nan", "--weights gap=1 --gap-tolerance 1", "--drift-along -1"])
def test_a_setting_that_is_none_is_refused_and_leaves_nothing(
    run: Run, lip_step: Path, tmp_path: Path, options: str
) -> None:
    answer = run("compare", lip_step, "--out", tmp_path / "out", *options.split())
    assert answer.code == 2
    assert answer.is_one_sentence()
    assert list(tmp_path.iterdir()) == []


def test_a_reference_that_is_none_is_refused_and_leaves_nothing(run: Run, tmp_path: Path) -> None:
    answer = run("compare", tmp_path / "missing.step", "--out", tmp_path / "a" / "out")
    assert answer.code == 2
    assert answer.is_one_sentence()
    assert list(tmp_path.iterdir()) == []
