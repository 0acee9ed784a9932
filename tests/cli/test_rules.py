"""`cadpanel fit --rules`: what is delivered, what is said, and with which exit code."""

from __future__ import annotations

import json
from pathlib import Path

from cadpanel.delivery.records.certified import ClearModel
from cadpanel.delivery.records.consistency import check_report
from cadpanel.delivery.records.report import read_report
from cadpanel.delivery.records.to_shape import recorded_shapes
from cadpanel.fitting.rules.book import rules_of
from tests.cli.conftest import Run


def test_rules_are_measured_told_and_kept_in_the_report(
    run: Run, lip_step: Path, delivered: Path, tmp_path: Path
) -> None:
    rules = tmp_path / "rules.toml"
    rules.write_text(
        f"[shop]\nradii = [430, 450, 480]\n[[seam]]\nbetween = ['N-01', 'N-0*']\nstep = 4.5\njoint = 6\n"
        f"[[lock]]\npanels = 'N-03'\ndelivery = '{delivered}'\n[[feature]]\npanels = 'N-01'\n"
        "feature = 'plane-cylinder-plane'\n",
        encoding="utf-8",
    )
    answer = run("fit", lip_step, "--rules", rules, "--out", tmp_path / "out")
    report = read_report(tmp_path / "out" / "report.json")
    assert answer.code == 1  # a panel that stays as it was has no tool's radius
    assert "Rule NOT held: radii of the shop's tools" in answer.out
    assert "Rule held: seam N-01|N-0*; largest step" in answer.out
    assert {rule.kept for rule in report.rules} == {True, False}
    assert report.features == {"plane-cylinder-plane": 1, "plane-cone-plane": 2}
    assert run("verify", tmp_path / "out").code == 0
    assert [(seam.joint, seam.clear) for seam in report.seams] == [
        (6.0, ClearModel(least=6.0, largest=6.0)),
        (None, ClearModel(least=0.0, largest=0.0)),
    ]
    assert report.settings.rules is not None
    assert len(report.settings.rules["lock"][0]["made"][0]) == 14
    broken = report.model_copy(
        update={
            "rules": tuple(rule.model_copy(update={"kept": True}) for rule in report.rules),
            "seams": tuple(seam.model_copy(update={"joint": 5.0}) for seam in report.seams),
        }
    )
    faults = check_report(broken, recorded_shapes(broken), report.certificate)
    assert any("is called kept" in fault for fault in faults)
    assert any("its own joint of 5.0 mm is not the one of 6.0 mm" in fault for fault in faults)
    again = rules_of(json.loads(report.model_dump_json())["settings"]["rules"])
    assert again is not None
    assert not again.unread


def test_a_rule_for_a_panel_that_is_not_there_is_refused(run: Run, lip_step: Path, tmp_path: Path) -> None:
    (tmp_path / "rules.toml").write_text("[[lock]]\npanels = 'N-3'\n", encoding="utf-8")
    answer = run("fit", lip_step, "--rules", tmp_path / "rules.toml", "--out", tmp_path / "out", "--quiet")
    assert answer.code == 2
    assert answer.is_one_sentence()
    assert "'N-03'" in answer.err
    assert not (tmp_path / "out").exists()
