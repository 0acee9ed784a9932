"""`cadpanel fit`: what it refuses, in one sentence, before anything is written."""

from __future__ import annotations

import resource
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace, BRepBuilderAPI_MakePolygon
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox, BRepPrimAPI_MakeSphere
from OCP.gp import gp_Pln, gp_Pnt
from OCP.TopAbs import TopAbs_FACE
from OCP.TopExp import TopExp_Explorer
from OCP.TopoDS import TopoDS_Shape

from cadpanel.arrays import Array
from tests.cli.conftest import Run
from tests.reference_shapes import Lip, kernel_face, kernel_lip, write_products
from tests.thorough import thorough

PROGRAM = [sys.executable, "-m", "cadpanel.cli.main"]


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ("--gap-tolerance nan", "gap tolerance"),
        ("--gap-tolerance -1", "gap tolerance"),
        ("--gap-tolerance inf", "gap tolerance"),
        ("--gap-tolerance some", "--gap-tolerance"),
        ("--thickness nan", "sheet thickness"),
        ("--thickness 0", "sheet thickness"),
        ("--thickness -3", "sheet thickness"),
        ("--thickness 1e-9", "between 0.01 mm and 10000 mm"),
        ("--thickness 1e308", "sheet thickness"),
        ("--drift-along nan", "--drift-along"),
        ("--drift-across -1", "--drift-across"),
        ("--drift-along 80", "between 0.01 and 50 percent"),
        ("--restarts -1", "restarts"),
        ("--seed -1", "seed"),
        ("--seam-tolerance nan", "seam tolerance"),
        ("--seam-tolerance 0", "seam tolerance"),
        ("--feature cube", "plane-cone-plane"),
        ("--method magic", "'local', 'two_stage', 'concurrent'"),
        ("--tilt half", "'free', 'fixed'"),
        ("--skin-side left", "'outer', 'inner'"),
        ("--schema AP203", "'AP242', 'AP214'"),
        ("--weights gap=1 --gap-tolerance 1", "either --weights or --gap-tolerance"),
        ("--weights gap=1 --method local", "local method"),
        ("--weights gap", "gap"),
        ("--weights gap=1,gap=2", "at most once"),
        ("--weights gap=x", "a number for gap"),
        ("--weights gap=nan", "gap weight"),
        ("--weights drift=0", "must be above 0"),
        ("--weights gap=1e300", "gap weight"),
        ("--weights speed=1", "speed=1"),
    ],
)
def test_a_setting_that_is_none_is_refused_in_one_sentence(
    run: Run, lip_step: Path, tmp_path: Path, options: str, words: str
) -> None:
    answer = run("fit", lip_step, "--out", tmp_path / "out", *options.split())
    assert answer.code == 2
    assert answer.is_one_sentence(), answer.err
    assert words in answer.err
    assert list(tmp_path.iterdir()) == []


def test_an_existing_folder_is_refused_before_the_reference_is_read(run: Run, tmp_path: Path) -> None:
    (tmp_path / "out").mkdir()
    answer = run("fit", "no such file.step", "--out", tmp_path / "out")
    assert answer.code == 2
    assert answer.is_one_sentence()
    assert "exists already" in answer.err


def test_overwrite_does_not_delete_the_reference_that_lies_in_the_delivery(
    run: Run, lip_step: Path, delivery: Path
) -> None:
    reference = delivery / "lip.step"
    reference.write_bytes(lip_step.read_bytes())
    answer = run("fit", reference, "--out", delivery, "--overwrite")
    assert answer.code == 2
    assert answer.is_one_sentence(), answer.err
    assert "'lip.step'" in answer.err
    assert reference.read_bytes() == lip_step.read_bytes()


def saddle(u: Array, v: Array) -> Array:
    x, y = 500.0 * (u - 1.5), 2000.0 * (v - 0.5)
    return np.stack([x, y, 1e-3 * (x**2 - y**2)], axis=-1)


def flat(u: Array, v: Array) -> Array:
    return np.stack([500.0 * u, 2000.0 * v, 0.0 * u], axis=-1)


def three_corners() -> TopoDS_Shape:
    outline = BRepBuilderAPI_MakePolygon(gp_Pnt(), gp_Pnt(900.0, 0.0, 0.0), gp_Pnt(0.0, 300.0, 0.0), True)
    return BRepBuilderAPI_MakeFace(gp_Pln(), outline.Wire()).Face()


def bad_files(folder: Path, good: Path) -> dict[str, tuple[Path, str]]:
    text = good.read_text(encoding="utf-8")
    ball = BRepPrimAPI_MakeSphere(1000.0)
    sphere = TopExp_Explorer(ball.Shape(), TopAbs_FACE).Current()

    files = {
        "missing": (folder / "missing.step", "missing.step"),
        "folder": (folder, "is a folder"),
        "not STEP": (folder / "photo.step", "photo.step"),
        "empty": (folder / "empty.step", "empty.step"),
        "truncated": (folder / "cut.step", "cut.step"),
        "solid": (write_products(folder / "s.step", [("block", BRepPrimAPI_MakeBox(1.0, 2.0, 3.0).Shape())]), "block"),
        "sphere": (write_products(folder / "b.step", [("ball", sphere)]), "ball"),
        "saddle": (write_products(folder / "h.step", [("horse", kernel_face(saddle))]), "horse"),
        "flat": (write_products(folder / "f.step", [("pane", kernel_face(flat))]), "pane"),
        "three corners": (write_products(folder / "t.step", [("gore", three_corners())]), "3 corners"),
        "twice": (write_products(folder / "d.step", [("one", kernel_lip(Lip())), ("two", kernel_lip(Lip()))]), "two"),
        "thick": (good, "N-0"),
    }
    (folder / "photo.step").write_bytes(b"\x89PNG\r\n")
    (folder / "empty.step").write_text("")
    (folder / "cut.step").write_text(text[: len(text) // 2])
    return files


@pytest.mark.parametrize(
    "what",
    [
        *("missing", "folder", "not STEP", "empty", "truncated", "solid", "sphere", "saddle", "flat", "three corners"),
        *("twice", "thick"),
    ],
)
def test_a_reference_that_is_none_is_refused_in_one_sentence_and_leaves_nothing(
    run: Run, lip_step: Path, tmp_path: Path, what: str
) -> None:
    (tmp_path / "in").mkdir()
    path, words = bad_files(tmp_path / "in", lip_step)[what]
    answer = run(
        "fit",
        path,
        "--out",
        tmp_path / "deep" / "out",
        *(["--thickness", "2000", "--quiet"] if what == "thick" else []),
    )
    assert answer.code == 2, answer.err
    assert answer.is_one_sentence(), answer.err
    assert words in answer.err
    assert [path.name for path in tmp_path.iterdir()] == ["in"]


@thorough
def test_a_full_disk_is_one_sentence_and_leaves_nothing(lip_step: Path, tmp_path: Path) -> None:
    """A limit on the size of a file stands for the full disk: the operating system refuses the write alike."""
    answer = subprocess.run(
        [*PROGRAM, "fit", str(lip_step), "--out", str(tmp_path / "out"), "--quiet", "--outputs", "step"],
        capture_output=True,
        text=True,
        timeout=120,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (10_000, 10_000)),
    )
    assert answer.returncode == 2
    assert answer.stderr.count("\n") == 1
    assert "out' cannot be written" in answer.stderr
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (
            "--outputs flat",
            "There is no output 'flat'; choose from step, flats, schedule, setting-out, glb, html, xlsx, pdf, ifc, "
            "freecad.",
        ),
        ("--only N-04", "There is no panel 'N-04' to deliver; there is 'N-03', for example."),
        ("--stock 1500", "Sheets of the stock are written like 1500x3000,2000x4000, not '1500'."),
        ("--dxf-layers CUTS=0", "There is no layer 'CUTS' to name; the layers are CUT, BEND, ROLL, MARK, INFO."),
        (
            "--fixings 6.5@400",
            "Fixing holes are written like 6.5@400,20 (diameter, pitch, distance from edges), not '6.5@400'.",
        ),
        ("--returns 30", "Returns are written like 30@3, length and inner radius, not '30'."),
        ("--k-factor 2", "The K-factor must be between 0 and 1, not 2."),
    ],
)
def test_what_cannot_be_delivered_is_refused_before_the_fit(
    run: Run, lip_step: Path, tmp_path: Path, words: str, said: str
) -> None:
    answer = run("fit", lip_step, "--out", tmp_path / "out", *words.split())
    assert (answer.code, answer.err) == (2, f"{said}\n")
    assert list(tmp_path.iterdir()) == []


def test_a_date_that_is_none_is_refused_before_the_fit(
    run: Run, lip_step: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "today")
    answer = run("fit", lip_step, "--out", tmp_path / "out")
    assert (answer.code, answer.err) == (
        2,
        "SOURCE_DATE_EPOCH must be a number of seconds since 1970, not 'today'.\n",
    )
    assert list(tmp_path.iterdir()) == []
