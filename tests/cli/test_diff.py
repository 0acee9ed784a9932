"""`cadpanel diff`: 0 where nothing differs, 1 where something does, 2 where there is nothing to compare."""

from __future__ import annotations

import csv
import io
import json
from pathlib import Path

from tests.cli.conftest import Run


def thicker(delivery: Path) -> None:
    report = json.loads((delivery / "report.json").read_text(encoding="utf-8"))
    report["settings"]["material"] = "steel"
    report["origin"]["offset"] = [0.0, 0.0, 2.0]
    (delivery / "report.json").write_text(json.dumps(report), encoding="utf-8")


def test_the_same_and_the_different(run: Run, delivered: Path, delivery: Path) -> None:
    same = run("diff", delivered, delivery)
    assert (same.code, same.err) == (0, "")
    assert "Nothing differs by more than 0.1 mm: 3 panels." in same.out
    thicker(delivery)
    other = run("diff", delivered, delivery)
    assert other.code == 1
    assert "material: not named before, steel now" in other.out
    assert "3 changed." in other.out
    assert "Blanks to cut again: N-01, N-02, N-03." in other.out
    as_json = run("diff", delivered, delivery, "--json")
    assert (as_json.code, as_json.err) == (1, "")
    found = json.loads(as_json.out)
    assert found["schema"] == "cadpanel.diff/1"
    assert [panel["moved"] for panel in found["panels"]] == [2.0, 2.0, 2.0]
    as_csv = run("diff", delivered, delivery, "--csv")
    rows = list(csv.DictReader(io.StringIO(as_csv.out.lstrip("\ufeff"))))
    assert [(row["panel"], row["cut again"], row["corners moved mm"]) for row in rows] == [
        ("N-01", "yes", "2.0"),
        ("N-02", "yes", "2.0"),
        ("N-03", "yes", "2.0"),
    ]


def test_what_is_refused_is_one_sentence(run: Run, delivered: Path, tmp_path: Path) -> None:
    for words in ((delivered, tmp_path / "none"), (delivered, delivered, "--json", "--csv")):
        answer = run("diff", *words)
        assert answer.code == 2
        assert answer.is_one_sentence()
