from __future__ import annotations

import csv
from pathlib import Path

from cadpanel.delivery.records.report import read_report
from cadpanel.jobs.summary import read_summary


def test_a_row_a_region_tells_what_its_report_does(done: Path) -> None:
    summary = read_summary(done / "summary.json")
    lines = list(csv.DictReader((done / "summary.csv").read_text(encoding="utf-8-sig").splitlines()))
    assert [row.region for row in summary.rows] == [line["region"] for line in lines] == ["A", "B", "C"]
    for row, line in zip(summary.rows, lines, strict=True):
        report = read_report(done / row.region / "report.json")
        assert row.panels == len(report.panels) == int(line["panels"])
        assert row.rms_deviation == report.summary.rms_deviation == float(line["rms_deviation"])
        assert row.max_seam_gap == report.summary.max_seam_gap
        assert row.met is report.summary.tolerance_met
        assert line["met"] == ("yes" if row.met else "no")
        assert (row.said is None) is row.met
    assert summary.code == (0 if all(row.met for row in summary.rows) else 1)
