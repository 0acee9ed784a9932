"""`cadpanel fit`: what is delivered, and with which exit code."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from cadpanel.brep.step.properties import PartData
from cadpanel.delivery.outputs.step_files import Place, write_solids
from cadpanel.delivery.records.report import read_report
from cadpanel.delivery.settings import Schema
from cadpanel.delivery.sheets import PanelSheet
from tests.cli.conftest import Run
from tests.reference_shapes import Lip, kernel_lip, strip, write_products
from tests.thorough import thorough

PROGRAM = [sys.executable, "-m", "cadpanel.cli.main"]


# ------------------------------------------------------------------------------------------------------- it goes well
def test_a_delivery_holds_its_files_and_nothing_else(delivered: Path) -> None:
    assert sorted(path.name for path in delivered.iterdir()) == [
        "flat",
        "manifest.json",
        "panels.FCStd",
        "panels.glb",
        "panels.step",
        "report.html",
        "report.json",
        "schedule.csv",
        "setting_out.csv",
        "skins.step",
    ]
    assert list(delivered.parent.iterdir()) == [delivered]


def test_the_report_says_what_was_asked_and_what_came_of_it(delivered: Path) -> None:
    report = read_report(delivered / "report.json")
    assert [panel.name for panel in report.panels] == ["N-01", "N-02", "N-03"]
    assert [seam.panels for seam in report.seams] == [("N-01", "N-02"), ("N-02", "N-03")]
    assert report.reference.file == "lip.step"
    assert report.settings.gap_tolerance is None
    assert report.settings.gaps == {"width": 3.0, "step": 3.0, "shift": 3.0}
    assert report.summary.tolerance_met
    assert max(report.summary.max_width, report.summary.max_step, report.summary.max_shift) <= 3.0
    assert report.certificate.solids == report.certificate.skins == 3
    assert report.certificate.face_kinds == {"plane": 24, "cone": 6, "cylinder": 0, "other": 0}
    assert report.certificate.max_tangency_error < 1e-11
    assert report.certificate.volume_error < 1e-11
    assert all(getattr(report.timing, step) > 0.0 for step in ("read", "fit", "build", "write", "verify"))


def test_the_report_says_what_was_taken_for_what_and_the_user_may_override_it(
    run: Run, delivered: Path, lip_step: Path, tmp_path: Path
) -> None:
    (*_, panel) = read_report(delivered / "report.json").panels
    for end, corners in zip(panel.taken, panel.corners, strict=True):
        assert end[0] == 0.0
        assert np.diff(end).min() > 0.0
        # The panel follows its reference, so that both are about as wide.
        wide = sum(float(np.linalg.norm(np.subtract(*pair))) for pair in pairwise(corners))
        assert end[-1] == pytest.approx(wide, rel=0.06)
    own = [end[2] - end[1] for end in panel.taken]
    # The other panels are left alone.
    words = ("fit", lip_step, "--method", "local", "--outputs", "step")
    answer = run(*words, "--out", tmp_path / "out", "--blend", f"{panel.name}=20-80%")
    assert "Taken for the bend" in answer.out
    told = read_report(tmp_path / "out" / "report.json")
    assert told.settings.blend == (f"{panel.name}=20-80%",)
    assert all(end[2] - end[1] > wide for end, wide in zip(told.panels[-1].taken, own, strict=True))
    run(*words, "--out", tmp_path / "free", "--quiet")
    free = read_report(tmp_path / "free" / "report.json")
    assert [one.taken for one in told.panels[:-1]] == [one.taken for one in free.panels[:-1]]
    assert told.panels[-1].rms_deviation > free.panels[-1].rms_deviation


def test_the_console_shows_the_table_the_certificate_and_the_folder(run: Run, lip_step: Path, tmp_path: Path) -> None:
    answer = run("fit", lip_step, "--out", tmp_path / "out")
    assert answer.code == 0
    assert "two-stage" not in answer.out
    for words in (
        "Largest corner gap, mm",
        "Hausdorff",
        "one panel stands out",
        "Certificate: 3 solids valid",
        "tmp",
        "Written",
        "4 drawings",
        "Worst panel: '",
        "Worst seam: '",
        "Look at it: cadpanel view",
    ):
        assert words in answer.out
    # Only where a run takes its time there are lines of it.
    assert all(re.search(r": step \d+: worst gap|: at work for \d+ s$", line) for line in answer.err.splitlines())


def test_quiet_says_nothing(run: Run, lip_step: Path, tmp_path: Path) -> None:
    answer = run("fit", lip_step, "--out", tmp_path / "out", "--quiet", "--outputs", "schedule")
    assert (answer.code, answer.out, answer.err) == (0, "", "")


def test_every_option_arrives_in_the_report(run: Run, lip_step: Path, tmp_path: Path) -> None:
    options = "--gap-tolerance 3 --step 2 --seam-turn 5 --seam-level 2 --evenness 1 --max-kink 20"
    options += " --drift-along 4 --drift-across 1.5 --min-radius 25 --thickness 5 --joint 2 --ends square"
    options += (
        " --skin-side inner"
        " --schema AP214 --restarts 1 --seed 7 --seam-tolerance 0.5 --feature plane-cylinder-plane --method concurrent"
        " --blend 500-900 --blend N-02=45-62.5%"
        " --outputs step,flats --only N-01,*3 --origin keep --k-factor 0.4 --chord 0.02 --roll-pitch 80"
        " --dxf-entities lines --dxf-layers CUT=0,BEND=Folds --dxf-contour-only --dxf-name-length 20 --density 7850"
        " --stock 1500x3000,2500x4000 --facet-height 0.3 --fixings 8@350,25 --returns 45@6"
        " --mesh-chord 0.2 --mesh-colours deviation --material AlMg3 --author A.N. --organization O"
    )
    answer = run("fit", lip_step, "--out", tmp_path / "out", *options.split())
    assert answer.code in (0, 1), answer.err
    settings = json.loads((tmp_path / "out" / "report.json").read_text(encoding="utf-8"))["settings"]
    assert settings["cadpanel_version"]
    del settings["cadpanel_version"]
    assert settings == {
        "feature": "plane-cylinder-plane",
        "composition": None,
        "max_deviation": None,
        "tilt": "free",
        "method": "concurrent",
        "energy": None,
        "tau": 0.001,
        "rules": None,
        "gap_tolerance": 3.0,
        "joint_tolerance": None,
        "step": 2.0,
        "shift": None,
        "gaps": {"gap": 3.0, "step": 2.0},
        "seam_turn": 5.0,
        "seam_level": 2.0,
        "evenness": 0.01,
        "max_kink": 20.0,
        "drift_along": 0.04,
        "drift_across": 0.015,
        "drift_outline": 0.5,
        "min_radius": 25.0,
        "blend": ["500-900", "N-02=45-62.5%"],
        "weights": None,
        "restarts": 1,
        "seed": 7,
        "seam_tolerance": 0.5,
        "thickness": 5.0,
        "joint": 2.0,
        "ends": "square",
        "skin_side": "inner",
        "step_schema": "AP214",
        "outputs": ["step", "flats"],
        "only": ["N-01", "*3"],
        "origin": "keep",
        "k_factor": 0.4,
        "chord": 0.02,
        "roll_pitch": 80.0,
        "dxf_entities": "lines",
        "dxf_layers": [["CUT", "0"], ["BEND", "Folds"]],
        "dxf_contour_only": True,
        "dxf_name_length": 20,
        "density": 7850.0,
        "stock": [[1500.0, 3000.0], [2500.0, 4000.0]],
        "facet_height": 0.3,
        "mesh_chord": 0.2,
        "mesh_colours": "deviation",
        "material": "AlMg3",
        "author": "A.N.",
        "organization": "O",
        "fixings": [8.0, 350.0, 25.0],
        "returns": [45.0, 6.0],
    }
    assert "AUTOMOTIVE_DESIGN" in (tmp_path / "out" / "panels.step").read_text(encoding="ascii")[:2000]
    assert run("verify", tmp_path / "out").code == 0


def test_weights_take_the_place_of_a_tolerance(run: Run, lip_step: Path, tmp_path: Path) -> None:
    words = ("--weights", "drift=1e-3, gap=2", "--outputs", "step")
    answer = run("fit", lip_step, "--out", tmp_path / "out", *words)
    assert answer.code == 0, answer.err
    settings = read_report(tmp_path / "out" / "report.json").settings
    assert settings.gap_tolerance is None
    assert settings.weights is not None
    assert (settings.weights.gap, settings.weights.deviation, settings.weights.drift) == (2.0, 1.0, 1e-3)


def test_a_single_panel_has_no_seam_and_is_fine(run: Run, tmp_path: Path) -> None:
    path = write_products(tmp_path / "one.step", [("alone", kernel_lip(Lip()))])
    answer = run("fit", path, "--out", tmp_path / "out", "--outputs", "step,html")
    assert answer.code == 0, answer.err
    assert read_report(tmp_path / "out" / "report.json").summary.max_corner_gap == 0.0
    assert "1 panel, 0 seams" in answer.out


def test_panels_that_do_not_touch_have_no_seam_and_are_fine(run: Run, tmp_path: Path) -> None:
    lips = [("a", kernel_lip(Lip())), ("b", kernel_lip(Lip(start=5000.0)))]
    answer = run("fit", write_products(tmp_path / "two.step", lips), "--out", tmp_path / "out", "--quiet")
    assert answer.code == 0, answer.err
    assert read_report(tmp_path / "out" / "report.json").seams == ()


def test_overwrite_replaces_a_delivery(run: Run, lip_step: Path, delivery: Path) -> None:
    (delivery / "panels.step").write_text("my own")
    answer = run("fit", lip_step, "--out", delivery, "--overwrite", "--quiet")
    assert answer.code == 2
    assert "was changed since cadpanel wrote it" in answer.err
    (delivery / "panels.step").unlink()
    answer = run("fit", lip_step, "--out", delivery, "--overwrite", "--quiet", "--outputs", "step")
    assert answer.code == 0, answer.err
    assert (delivery / "panels.step").is_file()


@thorough
def test_what_goes_to_a_file_is_plain_text(lip_step: Path, tmp_path: Path) -> None:
    answer = subprocess.run(
        [*PROGRAM, "fit", str(lip_step), "--out", str(tmp_path / "out"), "--outputs", "step"],
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert answer.returncode == 0
    assert "\x1b" not in answer.stdout + answer.stderr
    assert all(line.startswith(("Fit ", "Read ", "Build ", "Write ")) for line in answer.stderr.splitlines())
    assert max(map(len, answer.stdout.splitlines())) <= 200


# ---------------------------------------------------------------------------------------------- it misses its promise
def test_a_missed_tolerance_is_delivered_marked_and_exits_with_1(run: Run, lip_step: Path, tmp_path: Path) -> None:
    answer = run("fit", lip_step, "--out", tmp_path / "out", "--method", "local", "--outputs", "step")
    assert answer.code == 1
    assert "not met" in answer.out
    assert "the seam between 'N-0" in answer.err
    assert answer.err.count("\n") == 1
    assert not read_report(tmp_path / "out" / "report.json").summary.tolerance_met
    again = run("verify", tmp_path / "out")
    assert again.code == 0
    assert "the report says that its tolerance is not met" in again.out


def test_a_proof_that_does_not_hold_exits_with_1_and_delivers_nothing(
    run: Run, lip_step: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def lose_one(
        path: Path, panels: tuple[PanelSheet, ...], title: str, schema: Schema, placed: Place, *said: Sequence[PartData]
    ) -> None:
        write_solids(path, panels[:-1], title, schema, placed, said[0][:-1])

    monkeypatch.setattr("cadpanel.delivery.outputs.step_files.write_solids", lose_one)
    answer = run("fit", lip_step, "--out", tmp_path / "out", "--outputs", "step")
    assert answer.code == 1
    assert "Panel 'N-03' is missing among the solids." in answer.err
    assert list(tmp_path.iterdir()) == []


def test_a_missed_tolerance_is_one_line_whatever_the_panels_are_called(run: Run, tmp_path: Path) -> None:
    lips = [(f"roof\nedge {index}", kernel_lip(lip)) for index, lip in enumerate(strip(2))]
    words = ("--out", tmp_path / "out", "--method", "local", "--outputs", "step")
    answer = run("fit", write_products(tmp_path / "two.step", lips), *words)
    assert answer.code == 1
    assert answer.err.count("\n") == 1
    assert "'roof edge 0'" in answer.err


def test_panels_that_fit_no_sheet_of_the_stock_are_named_and_everything_is_delivered(
    run: Run, lip_step: Path, tmp_path: Path
) -> None:
    words = ("fit", lip_step, "--out", tmp_path / "out", "--quiet", "--outputs", "flats")
    answer = run(*words, "--stock", "1000x2000")
    assert answer.code == 1
    assert answer.is_one_sentence()
    assert "3 of 3 blanks fit no sheet of 1000x2000 mm: 'N-01' (" in answer.err
    assert run("verify", tmp_path / "out").code == 0
    answer = run(*words, "--stock", "1000x2000,2500x3000", "--overwrite")
    assert (answer.code, answer.err) == (0, "")
    panels = read_report(tmp_path / "out" / "report.json").panels
    assert {panel.blank.stock for panel in panels if panel.blank is not None} == {"2500x3000"}
