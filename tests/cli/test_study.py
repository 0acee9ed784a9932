import csv
import json
from pathlib import Path

import pytest

import cadpanel as cp
from cadpanel.delivery import study_files
from cadpanel.delivery.records.study import read_study
from cadpanel.delivery.study_plot import MISSING, can_plot, plot_study
from tests.cli.conftest import Run

PLOTS = {"study.png", "study.svg"} if can_plot() else set[str]()


@pytest.fixture(scope="module")
def written(lip_step: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("study") / "out"
    cp.study(
        lip_step, gaps=[0.5, 2.0, 8.0, 20.0], features=["plane-cone-plane", "cylinder"], out=out, max_deviation=90.0
    )
    return out


def test_the_folder_holds_the_same_rows_as_json_and_as_a_table(written: Path) -> None:
    assert {path.name for path in written.iterdir()} == {"study.json", "study.csv", "manifest.json"} | PLOTS
    study = read_study(written / "study.json")
    assert [(row.feature, row.gap_tolerance) for row in study.rows] == [
        (feature, gap) for feature in ("plane-cone-plane", "cylinder") for gap in (0.5, 2.0, 8.0, 20.0)
    ]
    lines = list(csv.DictReader((written / "study.csv").read_text(encoding="utf-8").splitlines()))
    for row, line in zip(study.rows, lines, strict=True):
        assert (line["feature"], float(line["gap_tolerance"])) == (row.feature, row.gap_tolerance)
        assert row.summary is None or float(line["rms_deviation"]) == row.summary.rms_deviation
    assert study.max_deviation == 90.0
    assert study.settings.gap_tolerance is None


def test_a_row_is_at_least_as_good_as_the_fit_of_its_own(written: Path, lip_step: Path) -> None:
    row = next(row for row in read_study(written / "study.json").rows if row.gap_tolerance == 2.0)
    alone = cp.fit(cp.read(lip_step), gap_tolerance=2.0, max_deviation=90.0)
    assert row.summary is not None
    assert row.summary.tolerance_met
    assert row.summary.rms_deviation <= alone.measures.overall_rms * (1.0 + 1e-5)


def test_a_feature_that_cannot_follow_has_rows_that_say_why(written: Path) -> None:
    rows = [row for row in read_study(written / "study.json").rows if row.feature == "cylinder"]
    for row in rows:
        assert (row.refused is None) == (row.summary is not None)


@pytest.mark.skipif(not can_plot(), reason="matplotlib is not installed")
def test_the_plot_is_drawn_and_the_same_for_the_same_study(written: Path, tmp_path: Path) -> None:
    assert (written / "study.png").read_bytes().startswith(b"\x89PNG")
    plot_study(read_study(written / "study.json"), [tmp_path / "study.png", tmp_path / "study.svg"])
    for name in ("study.png", "study.svg"):
        assert (tmp_path / name).read_bytes() == (written / name).read_bytes()


def test_without_the_library_that_draws_the_rest_is_written_and_it_is_said(
    run: Run, lip_step: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(study_files, "can_plot", lambda: False)
    out = tmp_path / "out"
    answer = run("study", lip_step, "--gap", "2", "--out", out)
    assert answer.code == 0, answer.err
    assert {path.name for path in out.iterdir()} == {"study.json", "study.csv", "manifest.json"}
    assert MISSING in answer.out


def test_the_command_cuts_fits_prints_and_writes(run: Run, lip_step: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    words = ("--gap", "4,1,4", "--feature", "plane-cone-plane", "--divide", "2,3", "--seams", "conjugate")
    answer = run("study", lip_step, *words, "--out", out)
    assert answer.code == 0, answer.err
    study = json.loads((out / "study.json").read_text(encoding="utf-8"))
    assert [(row["divide"], row["panels"], row["gap_tolerance"]) for row in study["rows"]] == [
        (count, count, gap) for count in (2, 3) for gap in (1.0, 4.0)
    ]
    assert study["reference"]["reading"]["seams"] == "conjugate"
    assert "plane-cone-plane, 2 panels" in answer.out
    assert f"Written: {out}" in answer.out
    again = run("study", lip_step, "--gap", "1", "--out", out)
    assert (again.code, again.is_one_sentence()) == (2, True)
    assert run("study", lip_step, "--gap", "1", "--out", out, "--overwrite", "--quiet").code == 0


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (("--gap", "1,x"), "--gap is a list of numbers like 1,2,5, not 'x'"),
        (("--gap", "1,-2"), "the gap tolerance must be at least 0.001 mm"),
        (("--feature", "plane-cone-plane,blob"), "there is no feature 'blob'"),
        (("--feature", "auto,cone"), "is chosen by a largest deviation"),
        (("--divide", "3,0"), "must be a whole number from 1"),
        (("--divide", "auto"), "how many panels"),
        (("--divide", "3,4", "--grid", "2x2"), "choose one of them"),
        (("--weights", "gap=1"), "no such option"),
    ],
)
def test_what_makes_no_study_is_refused(
    run: Run, lip_step: Path, tmp_path: Path, words: tuple[str, ...], sentence: str
) -> None:
    answer = run("study", lip_step, *words, "--out", tmp_path / "out")
    assert answer.code == 2
    assert answer.is_one_sentence(), answer.err
    assert sentence.lower() in answer.err.lower()
    assert not (tmp_path / "out").exists()
