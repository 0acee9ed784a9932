"""report.json and compare.json: what is written is read back; what does not belong is refused in one sentence."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pydantic import ValidationError

from cadpanel.delivery.records.comparison import read_comparison, write_comparison
from cadpanel.delivery.records.report import SummaryModel, read_report, write_report
from cadpanel.errors import DeliveryError
from tests.delivery.records.known_records import SUMMARY, a_comparison, a_report

# The contract with other programs: keys may be added but not renamed.
CONTRACT = {
    "": "schema units reference settings panels seams summary baselines certificate timing",
    "units": "length angle",
    "reference": "file panels seams",
    "settings": "feature method gap_tolerance thickness seed",
    "panels.0": "name feature rms_deviation max_deviation max_corner_drift patches",
    "panels.0.patches.0": "kind normal",
    "panels.0.patches.1": "kind apex axis half_angle radius_min radius_max sweep",
    "panels.0.patches.2": "kind axis radius_min radius_max sweep",
    "seams.0": "panels corner_gaps max_corner_gap max_seam_gap max_kink",
    "summary": "max_corner_gap max_seam_gap max_kink rms_deviation max_deviation hausdorff max_corner_drift "
    "tolerance_met",
    "baselines": "local two_stage",
    "certificate": "solids valid face_kinds max_tangency_error volume_error names_kept max_seam_gap",
    "timing": "read fit build write verify",
}


def at(content: Any, place: str) -> Any:
    for step in place.split(".") if place else []:
        content = content[int(step) if step.isdigit() else step]
    return content


def written_report(path: Path, change: Callable[[dict[str, Any]], None] | None = None) -> Path:
    """The sample report in a file, after a change."""
    write_report(a_report(), path)
    if change is not None:
        content = json.loads(path.read_text(encoding="utf-8"))
        change(content)
        path.write_text(json.dumps(content), encoding="utf-8")
    return path


def test_a_report_is_read_back_as_it_was_written(tmp_path: Path) -> None:
    assert read_report(written_report(tmp_path / "report.json")) == a_report()


def test_a_comparison_is_read_back_as_it_was_written(tmp_path: Path) -> None:
    write_comparison(a_comparison(), tmp_path / "compare.json")
    assert read_comparison(tmp_path / "compare.json") == a_comparison()


@pytest.mark.parametrize("place", CONTRACT)
def test_every_key_of_the_contract_is_there(tmp_path: Path, place: str) -> None:
    content = json.loads(written_report(tmp_path / "report.json").read_text(encoding="utf-8"))
    assert set(CONTRACT[place].split()) <= set(at(content, place))


REQUIRED = [
    (place, key)
    for place, keys in CONTRACT.items()
    for key in keys.split()
    if "units" not in (place, key)  # they have one value only and need not be repeated
]


@pytest.mark.parametrize(("place", "key"), REQUIRED)
def test_a_report_without_a_key_of_the_contract_is_refused(tmp_path: Path, place: str, key: str) -> None:
    def leave_out(content: dict[str, Any]) -> None:
        del at(content, place)[key]

    with pytest.raises(DeliveryError, match=key):
        read_report(written_report(tmp_path / "report.json", leave_out))


def test_a_comparison_has_the_keys_of_the_contract(tmp_path: Path) -> None:
    write_comparison(a_comparison(), tmp_path / "compare.json")
    content = json.loads((tmp_path / "compare.json").read_text(encoding="utf-8"))
    assert {"seams", "columns"} <= set(content)
    assert {"feature", "method", "max_corner_gap", "summary", "seconds"} <= set(content["columns"][0])


def test_the_same_report_gives_the_same_bytes_in_utf8(tmp_path: Path) -> None:
    first = written_report(tmp_path / "a.json").read_bytes()
    assert first == written_report(tmp_path / "b.json").read_bytes()
    assert "Süd 1".encode() in first
    assert first.endswith(b"}\n")


def test_keys_may_be_added_and_survive(tmp_path: Path) -> None:
    def add(content: dict[str, Any]) -> None:
        content["summary"]["colour"] = "bronze"

    report = read_report(written_report(tmp_path / "report.json", add))
    write_report(report, tmp_path / "again.json")
    assert json.loads((tmp_path / "again.json").read_text(encoding="utf-8"))["summary"]["colour"] == "bronze"


def test_numbers_of_numpy_are_taken_as_they_are() -> None:
    assert SummaryModel.model_validate(SUMMARY.model_dump() | {"hausdorff": np.float64(31.0)}) == SUMMARY


@pytest.mark.parametrize("number", [math.nan, math.inf, -1.0])
def test_a_measure_that_is_not_finite_or_negative_cannot_be_made(number: float) -> None:
    with pytest.raises(ValidationError, match="hausdorff"):
        SummaryModel.model_validate(SUMMARY.model_dump() | {"hausdorff": number})


def test_an_added_number_that_is_not_finite_is_not_written(tmp_path: Path) -> None:
    summary = SummaryModel.model_validate(SUMMARY.model_dump() | {"extra": math.nan})
    with pytest.raises(DeliveryError, match="is not written"):
        write_report(a_report().model_copy(update={"summary": summary}), tmp_path / "report.json")
    assert not (tmp_path / "report.json").exists()


def put(place: str, key: str, value: object) -> Callable[[dict[str, Any]], None]:
    def change(content: dict[str, Any]) -> None:
        at(content, place)[key] = value

    return change


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (put("", "schema", "cadpanel.report/2"), 'its "schema" is "cadpanel.report/2", and "cadpanel.report/1" is exp'),
        (put("summary", "max_corner_gap", -0.1), "summary.max_corner_gap"),
        (put("summary", "max_corner_gap", "0.1"), "summary.max_corner_gap"),
        (put("summary", "max_corner_gap", math.nan), "it holds NaN"),
        (put("summary", "added", math.inf), "it holds Infinity"),
        (put("summary", "tolerance_met", 1), "summary.tolerance_met"),
        (put("units", "length", "inch"), "units.length"),
        (put("panels.0.patches.0", "kind", "sphere"), "panels.0.patches.0"),
        (put("panels.0.patches.0", "normal", [0.0, 1.0]), "panels.0.patches.0"),
        (put("panels.0", "name", "Süd 2"), "two panels have the same name"),
        (put("reference", "panels", 3), "the reference counts 3 panels, the list 2"),
        (put("reference", "seams", 0), "the reference counts 0 seams, the list 1"),
        (put("seams.0", "panels", ["Süd 1", "Nord"]), "a seam names the panel 'Nord', which is not in the list"),
        (put("seams.0", "edges", ["end 0", "end 2"]), "seams.0.edges.1"),
    ],
)
def test_a_wrong_report_is_refused_in_one_sentence(
    tmp_path: Path, change: Callable[[dict[str, Any]], None], sentence: str
) -> None:
    path = written_report(tmp_path / "report.json", change)
    with pytest.raises(DeliveryError) as raised:
        read_report(path)
    message = str(raised.value)
    assert sentence in message
    assert "report.json" in message
    assert "\n" not in message


@pytest.mark.parametrize(
    "content", [b"", b"{", b"[]", b"{}", b"null", b"\xff\xfe", b"ISO-10303-21;", b"[" * 100_000, b'{"schema": [1]}']
)
def test_a_file_that_is_no_report_at_all_is_refused(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "report.json").write_bytes(content)
    with pytest.raises(DeliveryError, match="is not a cadpanel report"):
        read_report(tmp_path / "report.json")


def test_a_report_is_no_comparison(tmp_path: Path) -> None:
    with pytest.raises(DeliveryError, match="is not a cadpanel comparison"):
        read_comparison(written_report(tmp_path / "report.json"))


def test_a_column_with_too_few_gaps_is_refused(tmp_path: Path) -> None:
    write_comparison(a_comparison(), tmp_path / "compare.json")
    text = (tmp_path / "compare.json").read_text(encoding="utf-8")
    content = json.loads(text)
    content["columns"][3]["max_corner_gap"] = []
    (tmp_path / "compare.json").write_text(json.dumps(content), encoding="utf-8")
    with pytest.raises(DeliveryError, match="the column concurrent, plane-cone-plane has 0 gaps for 1 seams"):
        read_comparison(tmp_path / "compare.json")


def test_a_file_that_cannot_be_read_or_written_is_one_sentence(tmp_path: Path) -> None:
    with pytest.raises(DeliveryError, match="cannot be read: No such file"):
        read_report(tmp_path / "report.json")
    with pytest.raises(DeliveryError, match="cannot be read: Is a directory"):
        read_report(tmp_path)
    with pytest.raises(DeliveryError, match="cannot be written: No such file"):
        write_report(a_report(), tmp_path / "missing" / "report.json")
