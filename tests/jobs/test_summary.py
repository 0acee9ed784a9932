from __future__ import annotations

import csv
import errno
import os
from pathlib import Path

import pytest

from cadpanel.delivery.records.report import read_report
from cadpanel.errors import DeliveryError
from cadpanel.jobs.summary import RowModel, SummaryModel, read_summary, write_summary


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


def test_a_full_disk_leaves_the_earlier_summary_as_it_was(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(_handle: int) -> None:
        raise OSError(errno.ENOSPC, "no space left")

    earlier = SummaryModel(code=0, rows=(RowModel(region="A", state="made"),), remarks=("a", "b"))
    write_summary(earlier, tmp_path)
    before = {path: path.read_bytes() for path in tmp_path.iterdir()}
    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(DeliveryError, match=r"summary\.json' cannot be written: no space left"):
        write_summary(earlier.model_copy(update={"code": 2}), tmp_path)
    assert {path: path.read_bytes() for path in tmp_path.iterdir()} == before
    assert read_summary(tmp_path / "summary.json") == earlier
