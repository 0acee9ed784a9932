"""`cadpanel verify`: a delivery proves itself from its files, and tampering is found out and named."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from cadpanel.brep.step.file import read_step_shapes
from cadpanel.delivery.manifest import write_manifest
from tests.cli.conftest import Run
from tests.thorough import cases


def test_an_untouched_delivery_holds(run: Run, delivered: Path) -> None:
    answer = run("verify", delivered)
    assert (answer.code, answer.err) == (0, "")
    assert "Everything holds." in answer.out
    assert run("verify", delivered, "--quiet").out == ""


def test_what_is_not_proved_is_listed_and_the_reference_proves_deviation_and_drift(
    run: Run, delivered: Path, delivery: Path, lip_step: Path
) -> None:
    assert "Not proved: deviation, Hausdorff distance, drift" in run("verify", delivered).out
    answer = run("verify", delivered, "--reference", lip_step)
    assert answer.code == 0
    assert "Not proved: what other methods reach" in answer.out
    edit(delivery, put("panels", 0, "max_drift_along", value=lambda v: v - 0.01))  # stands in the report alone
    assert run("verify", delivery).code == 0
    answer = run("verify", delivery, "--reference", lip_step)
    assert answer.code == 1
    assert "Panel 'N-01': the report's max_drift_along is" in answer.err


def edit(folder: Path, change: Callable[[dict[str, Any]], None]) -> None:
    path = folder / "report.json"
    report = json.loads(path.read_text(encoding="utf-8"))
    change(report)
    path.write_text(json.dumps(report), encoding="utf-8")
    write_manifest(folder)  # as whoever changes a report can


def put(*steps: str | int, value: Any) -> Callable[[dict[str, Any]], None]:
    def change(report: Any) -> None:
        for step in steps[:-1]:
            report = report[step]
        report[steps[-1]] = value(report[steps[-1]]) if callable(value) else value

    return change


CHANGES = [
    (put("panels", 1, "volume", value=lambda v: v * 1.0001), "Panel 'N-02': its solid has a volume"),
    (put("panels", 0, "corners", 0, 0, 0, value=lambda v: v + 1.0), "Panel 'N-01'"),
    (put("panels", 2, "patches", 1, "apex", 0, value=lambda v: v + 1.0), "Panel 'N-03': the report's cone"),
    (put("panels", 2, "patches", 1, "half_angle", value=lambda v: v * 1.01), "Panel 'N-03': the report's cone"),
    (put("panels", 2, "patches", 1, "radius_max", value=lambda v: v - 1.0), "Panel 'N-03': the report's cone"),
    (put("panels", 0, "patches", 2, "normal", value=[0.0, 0.0, 1.0]), "Panel 'N-01': the report's plane"),
    (put("panels", 0, "name", value="N-09"), "names the panel 'N-01'"),
    (put("seams", 0, "corner_gaps", 0, value=0.0), "Seam 'N-01' to 'N-02': the corner gaps"),
    (put("seams", 1, "max_corner_gap", value=0.5), "Seam 'N-02' to 'N-03': the largest corner gap"),
    (put("seams", 1, "max_seam_gap", value=0.01), "Seam 'N-02' to 'N-03': the gap is"),
    (put("seams", 0, "edges", 0, value="end 0"), "Seam 'N-01' to 'N-02': the corner gaps"),
    (put("seams", 0, "edges", 1, value="side 0"), "Seam 'N-01' to 'N-02'"),
    (put("seams", 0, "edges", 1, value="edge 7"), "Seam 'N-01' to 'N-02'"),
    (put("seams", 0, "edges", 1, value="end 2"), "seams.0.edges.1"),
    (put("seams", 0, "reversed", value=True), "Seam 'N-01' to 'N-02': the corner gaps"),
    (put("panels", 0, "volume", value=0.0), "panels.0.volume"),
    (put("panels", 0, "corners", value=[[], []]), "corners in rows of [0, 0] do not fit 3 patches"),
    (put("panels", 0, "patches", value=[]), "corners in rows of [4, 4] do not fit 0 patches"),
    (put("panels", 2, "patches", 1, "sweep", value=lambda v: v * 0.9), "Panel 'N-03': the report's cone"),
    (put("panels", 1, "patches", 0, "normal", value=lambda v: [-x for x in v]), "Panel 'N-02': the far face"),
    (put("panels", 1, "feature", value="plane-cylinder-plane"), "Panel 'N-02': the report calls it"),
    (put("settings", "thickness", value=2.99), "Panel 'N-01': the far face"),
    (put("settings", "skin_side", value="inner"), "Panel 'N-01': the far face"),
    (put("settings", "drift_along", value=1e-4), "% for the drift along the strip, where 0.01 %"),
    (
        put("settings", "drift_across", value=1e-4),
        "% for the drift across the free edges, where",
    ),
    (put("settings", "min_radius", value=1e4), "mm for the least radius, where 10000 mm are allowed"),
    (put("summary", "least_radius", value=5.0), "states 5 mm for the least radius, where 10 mm are allowed"),
    (put("summary", "least_radius", value=-5.0), "states -5 mm for the least radius"),
    (put("summary", "least_flange_width", value=0.5), "states 0.5 mm for the least width of a flange, where 1 mm"),
    (put("summary", "least_radius", value="tight"), "summary.least_radius"),
    (put("summary", "tolerance_met", value=False), "calls its tolerance not met"),
    (put("summary", "rms_deviation", value=lambda v: v / 9.0), "rms_deviation"),
    (put("summary", "local_rms_multiple", value=1.0), "local_rms_multiple"),
    (put("baselines", "local", "rms_deviation", value=lambda v: v * 2.0), "local_rms_multiple"),
    (put("summary", "max_corner_gap", value=0.5), "max_corner_gap"),
    (put("summary", "max_deviation", value=0.5), "max_deviation"),
    (put("summary", "hausdorff", value=0.5), "hausdorff"),
    (put("settings", "gaps", value={"step": 0.1}), "calls the step of 0.1 mm held"),
    (put("settings", "gaps", value={"gap": 0.1}), "calls the gap of 0.1 mm held"),
    (put("seams", 0, "step", value=9.0), "max_step"),
    (put("settings", "seam_turn", value=0.01), "degrees for the turn of seams, where 0.01 degrees are allowed"),
    (put("certificate", "solids", value=4), "solids = 4"),
    (put("panels", value=[]), "it tells of no panel"),
    (put("panels", 0, "corners", 0, 0, 0, value=1e300), "panels.0.corners.0.0.0"),
    (put("certificate", "overlap", value=1.0), "overlap = 1"),
    (put("certificate", "outputs", "flats", "drawings", value=7.0), "flats.drawings = 7"),
    (put("features", value={"plane-cone-plane": 4}), "counts {'plane-cone-plane': 4} panels by feature"),
    (put("seams", 0, "recut", value=9.0), "corners lie up to 9 mm from the joint's plane"),
    (put("seams", 0, "plane", "normal", 0, value=0.1), "is not of length 1"),
    (put("panels", 0, "patches", 0, "normal", value=[0.0, 0.0, 0.0]), "is not of length 1"),
    (put("panels", 0, "area", value=lambda v: v * 10.0), "Panel 'N-01': the report's area is"),
    (put("panels", 0, "moved", value=1.0), "Panel 'N-01': the report says that a slender cone was straightened"),
    (put("summary", "least_radius", value=lambda v: v + 1.0), "The summary's least_radius is"),
    (put("summary", "max_unevenness", value=lambda v: v + 1.0), "max_unevenness"),
    (put("settings", "k_factor", value=2.0), "holds a setting that is none"),
    (put("settings", "method", value="magic"), "settings.method"),
    (put("certificate", "valid", value=False), "valid"),
    (put("certificate", "max_seam_gap", value=0.1), "max_seam_gap"),
    (put("certificate", "failures", value=["Panel 'N-02' is bent."]), "Panel 'N-02' is bent."),
]


@pytest.mark.parametrize(("change", "words"), cases(CHANGES[::2], CHANGES))
def test_a_number_that_was_changed_is_named(
    run: Run, delivery: Path, change: Callable[[dict[str, Any]], None], words: str
) -> None:
    edit(delivery, change)
    answer = run("verify", delivery)
    assert answer.code in (1, 2), answer.out
    assert words in answer.err
    assert "Everything holds." not in answer.out


@pytest.mark.parametrize("name", ["panels.step", "setting_out.csv", "flat/N-02.dxf"])
def test_a_file_that_was_changed_in_any_byte_is_named(run: Run, delivery: Path, name: str) -> None:
    data = (delivery / name).read_bytes()
    (delivery / name).write_bytes(data + b" ")
    answer = run("verify", delivery)
    assert answer.code == 1
    assert f"'{name}' is not the file that was delivered" in answer.err


def test_a_key_that_stands_twice_is_refused(run: Run, delivery: Path) -> None:
    text = (delivery / "report.json").read_text(encoding="utf-8")
    (delivery / "report.json").write_text(text.replace('"thickness"', '"thickness": 9.0, "thickness"', 1))
    answer = run("verify", delivery)
    assert answer.code == 2
    assert 'the key "thickness" stands in it twice' in answer.err


def test_a_step_file_of_another_delivery_is_found_out(run: Run, delivery: Path) -> None:
    text = (delivery / "panels.step").read_text(encoding="ascii")
    assert "'N-02'" in text
    (delivery / "panels.step").write_text(text.replace("'N-02'", "'N-07'"), encoding="ascii")
    answer = run("verify", delivery)
    assert answer.code == 1
    assert "Panel 'N-02' is missing among the solids." in answer.err
    assert "Panel 'N-07'" in answer.err


def test_skins_in_the_place_of_panels_are_found_out(run: Run, delivery: Path) -> None:
    (delivery / "panels.step").write_bytes((delivery / "skins.step").read_bytes())
    assert len(read_step_shapes(delivery / "panels.step")) == 3
    answer = run("verify", delivery)
    assert answer.code == 1
    assert "Panel 'N-01': its solid holds 0 solids" in answer.err


@pytest.mark.parametrize("name", ["panels.step", "skins.step"])
def test_a_panel_without_a_shape_is_found_out(run: Run, delivery: Path, name: str) -> None:
    path = delivery / name
    kind = "MANIFOLD_SOLID_BREP" if name == "panels.step" else "SHELL_BASED_SURFACE_MODEL"
    text = path.read_text(encoding="ascii")
    shape = re.search(rf"#(\d+)={kind}\(", text)
    assert shape is not None
    text, count = re.subn(rf"(SHAPE_REPRESENTATION\([^;]*),#{shape[1]}\b", r"\1", text, count=1)
    assert count == 1
    path.write_text(text, encoding="ascii")
    answer = run("verify", delivery)
    assert answer.code == 1
    assert "Panel 'N-01'" in answer.err


@pytest.mark.parametrize("name", ["panels.step", "skins.step"])
@pytest.mark.parametrize(
    ("whole", "damaged"),
    [
        (r"LINE\('',(#\d+),#\d+\)", r"LINE('',\1,\1)"),
        (r"=LINE\(", "=LANE("),
        (r"#\d+=B_SPLINE_CURVE_WITH_KNOTS[^;]*;\n", ""),
    ],
)
def test_a_step_file_over_which_the_kernel_would_crash_is_one_sentence(
    run: Run, delivery: Path, name: str, whole: str, damaged: str
) -> None:
    text, count = re.subn(whole, damaged, (delivery / name).read_text(encoding="ascii"), count=1)
    assert count == 1
    (delivery / name).write_text(text, encoding="ascii")
    answer = run("verify", delivery)
    assert answer.code == 2
    assert answer.is_one_sentence(), answer.err
    assert "it is damaged (" in answer.err


@pytest.mark.parametrize("name", ["report.json", "panels.step", "skins.step"])
@pytest.mark.parametrize("fault", ["missing", "empty", "cut", "binary"])
def test_a_file_that_cannot_be_read_is_one_sentence(run: Run, delivery: Path, name: str, fault: str) -> None:
    path = delivery / name
    content = path.read_bytes()
    path.unlink()
    if fault != "missing":
        path.write_bytes({"empty": b"", "cut": content[: len(content) // 2], "binary": b"\x00\xff" * 100}[fault])
    answer = run("verify", delivery)
    assert answer.code == 2
    assert answer.is_one_sentence(), answer.err
    assert name in answer.err


def test_a_file_that_came_back_is_held_against_its_delivery(run: Run, delivered: Path) -> None:
    answer = run("verify", delivered / "panels.step", "--reference-delivery", delivered)
    assert (answer.code, answer.err) == (0, "")
    assert "All 3 solids of the delivery are there." in answer.out
    refused = run("verify", delivered, "--reference", "x.step", "--reference-delivery", delivered)
    assert refused.code == 2
    assert refused.is_one_sentence()


def test_a_folder_that_is_none_is_one_sentence(run: Run, tmp_path: Path) -> None:
    for folder in (tmp_path / "nowhere", tmp_path):
        answer = run("verify", folder)
        assert answer.code == 2
        assert answer.is_one_sentence()
