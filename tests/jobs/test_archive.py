from __future__ import annotations

import os
from pathlib import Path

import pytest

from cadpanel.errors import DeliveryError
from cadpanel.jobs.archive import packed, unpacked


def test_a_folder_comes_out_as_it_went_in_and_any_changed_byte_is_found(tmp_path: Path) -> None:
    (tmp_path / "in" / "flat").mkdir(parents=True)
    (tmp_path / "in" / "report.json").write_bytes(b"{}" * 50)
    (tmp_path / "in" / "flat" / "ü.dxf").write_bytes(bytes(range(256)))
    archive = packed(tmp_path / "in", "The gap is missed.")
    assert unpacked(archive, tmp_path / "out") == "The gap is missed."
    assert (tmp_path / "out" / "flat" / "ü.dxf").read_bytes() == bytes(range(256))
    at = archive.index(bytes(range(200, 220)))
    with pytest.raises(DeliveryError, match="damaged"):
        unpacked(archive[:at] + b"\0" + archive[at + 1 :], tmp_path / "damaged")
    with pytest.raises(DeliveryError, match="damaged"):
        unpacked(archive[:-40], tmp_path / "cut")


def test_nothing_is_missed_where_nothing_is_said(tmp_path: Path) -> None:
    (tmp_path / "in").mkdir()
    assert unpacked(packed(tmp_path / "in", None), tmp_path / "out") is None


def test_files_of_a_clock_that_is_not_set_are_packed_all_the_same(tmp_path: Path) -> None:
    (tmp_path / "in").mkdir()
    (tmp_path / "in" / "report.json").write_bytes(b"{}")
    os.utime(tmp_path / "in" / "report.json", (0.0, 0.0))
    unpacked(packed(tmp_path / "in", None), tmp_path / "out")
    assert (tmp_path / "out" / "report.json").read_bytes() == b"{}"
