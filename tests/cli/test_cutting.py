import json
from itertools import pairwise
from pathlib import Path

import pytest
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeFace
from OCP.gp import gp_Pln, gp_Pnt

from cadpanel.brep.files.model import Label
from cadpanel.brep.kernel.shapes import compound_of
from cadpanel.studies import fewest_panels
from tests.cli.conftest import Run
from tests.model_files import Labelled, strip_faces, write_labelled, write_shape
from tests.reference_shapes import Lip
from tests.thorough import thorough

LIP = Lip(length=6000.0, twist=1.0, taper=0.02, flange=500.0, radius=300.0)


@pytest.fixture(scope="module")
def strip(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_shape(tmp_path_factory.mktemp("strip") / "strip.brep", compound_of(strip_faces(LIP)))


@pytest.mark.parametrize(
    "how", [("--divide", "3"), ("--stations", "2000,4000"), ("--divide", "3", "--faces", "1-3", "--lip", "1400")]
)
def test_fit_of_a_strip_that_is_cut_delivers_its_panels(
    run: Run, strip: Path, tmp_path: Path, how: tuple[str, ...]
) -> None:
    answer = run("fit", strip, "--unit", "mm", *how, "--out", tmp_path / "out", "--quiet")
    assert answer.code in (0, 1), answer.err
    report = json.loads((tmp_path / "out" / "report.json").read_text(encoding="utf-8"))
    assert [panel["name"] for panel in report["panels"]] == ["S1-01", "S1-02", "S1-03"]
    assert len(report["seams"]) == 2


def test_flat_panels_are_reported_without_a_bend(run: Run, strip: Path, tmp_path: Path) -> None:
    words = ("--faces", "1", "--divide", "2", "--feature", "planar-polygon", "--method", "local", "--unit", "mm")
    answer = run("fit", strip, *words, "--out", tmp_path / "out")
    assert answer.code in (0, 1), answer.err
    assert "Certificate: 2 solids valid (12 plane faces)" in answer.out
    assert "Taken for the bend" not in answer.out


def test_bricks_of_a_mesh_meet_part_by_part(run: Run, tmp_path: Path) -> None:
    """Two rows of flat bricks of 1 by 2 m over a plane, the upper one shifted by half a brick."""
    plate = write_shape(tmp_path / "plate.brep", BRepBuilderAPI_MakeFace(gp_Pln(), 0.0, 4000.0, 0.0, 2000.0).Face())
    mesh = tmp_path / "bricks.obj"
    rows = {0: (0, 2000, 4000), 1000: (0, 1000, 3000, 4000)}
    bricks = [(a, b, y) for y, joints in rows.items() for a, b in pairwise(joints)]
    corners = [f"v {x} {z} 0" for a, b, y in bricks for x, z in ((a, y), (b, y), (b, y + 1000), (a, y + 1000))]
    faces = [f"f {k} {k + 1} {k + 2} {k + 3}" for k in range(1, 4 * len(bricks), 4)]
    mesh.write_text("\n".join([*corners, *faces]))
    words = ("--unit", "mm", "--mesh", mesh, "--feature", "planar-polygon", "--junctions")
    answer = run("fit", plate, *words, "--out", tmp_path / "out", "--quiet")
    assert answer.code == 0, answer.err
    report = json.loads((tmp_path / "out" / "report.json").read_text(encoding="utf-8"))
    # One seam within the lower row, two within the upper, and four between them.
    assert (len(report["panels"]), len(report["seams"])) == (5, 7)
    assert run("verify", tmp_path / "out").code == 0


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (("--divide", "3", "--grid", "2x2"), "choose one of them"),
        (("--divide", "0"), "must be a whole number from 1"),
        (("--grid", "2"), "--grid is two numbers of panels like 20x10"),
        (("--grid", "2x2", "--network", "lines.step"), "choose one of them"),
        (("--stations", "a,b"), "--stations are lengths in mm"),
        (("--by", "parameter"), "give a grid, too"),
        (("--by", "length"), "give a grid, too"),
        (("--divide", "2", "--by", "length"), "give a grid, too"),
        (("--lip", "300"), "give the number of panels, too, or their length"),
        (("--divide", "3", "--panel-length", "900"), "divide and panel length are ways to cut the same surface"),
        (("--grid", "3x2", "--panel-size", "900x500"), "grid and panel size are ways to cut the same surface"),
        (("--divide", "three"), "--divide is a number of panels, auto or strips, not 'three'"),
        (("--divide", "strips", "--lip", "300"), "strips are cut square to the whole surface"),
        (("--panel-length", "0"), "the length of a panel must be a positive number of mm"),
        (("--panel-length", "1e-9"), "would be more than 1000000"),
        (("--panel-size", "900"), "--panel-size is two lengths in mm like 1500x800, not '900'"),
        (("--panel-size", "900x-5"), "the size of a panel is two positive lengths in mm"),
        (("--seams", "conjugate"), "give the number of panels, too, or their length"),
        (("--divide", "3", "--cut-turn", "5"), "how far a cut may be turned from square counts for conjugate seams"),
        (("--divide", "3", "--seams", "conjugate", "--cut-turn", "50"), "must be between 0 degrees and 45 degrees"),
        (("--divide", "3", "--seams", "level"), "rises by 0 degrees where it is flattest"),
        (("--unit", "ell"), "there is no unit 'ell'"),
        (("--divide", "2", "--faces", "9"), "has no face '9': it has faces 1 to 3"),
        (("--network", f"{300 * 'a'}.step"), "(File name too long): check its name"),
        (("--mesh", "D\udce4cher.obj"), r"the name of the mesh, 'D\udce4cher.obj', is not UTF-8: rename the file"),
        (("--mesh", "none.obj"), "'none.obj' does not exist"),
        (("--network", "none.step"), "'none.step' does not exist"),
        (("--stations", "1000", "--spine", "none.step"), "'none.step' does not exist"),
    ],
)
@pytest.mark.parametrize("command", ["fit", "compare"])
def test_options_that_contradict_each_other_or_the_file_are_refused(
    run: Run, strip: Path, tmp_path: Path, command: str, words: tuple[str, ...], sentence: str
) -> None:
    answer = run(command, strip, *words, "--out", tmp_path / "out")
    assert answer.code == 2
    assert answer.is_one_sentence(), answer.err
    assert sentence.lower() in answer.err.lower()
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("command", ["fit", "compare"])
def test_a_folder_without_a_name_is_refused(run: Run, strip: Path, command: str) -> None:
    answer = run(command, strip, "--out", "")
    assert answer.code == 2
    assert answer.is_one_sentence(), answer.err
    assert "--out is the name of the folder to write, not ''" in answer.err


def test_spine_of_another_file_carries_the_stations(run: Run, tmp_path: Path) -> None:
    line = BRepBuilderAPI_MakeEdge(gp_Pnt(0.0, 0.0, 0.0), gp_Pnt(6000.0, 0.0, 0.0)).Edge()
    spine = write_labelled(tmp_path / "spine.step", [(Label(name="spine"), line, [])])
    skin = write_labelled(
        tmp_path / "skin.step", [(Label(name=f"f{k}"), face, []) for k, face in enumerate(strip_faces(LIP))]
    )
    out = tmp_path / "out"
    answer = run("fit", skin, "--stations", "1500,4000", "--spine", spine, "--out", out, "--quiet", "--method", "local")
    assert answer.code in (0, 1), answer.err
    report = json.loads((out / "report.json").read_text(encoding="utf-8"))
    assert [panel["name"] for panel in report["panels"]] == ["S1-01", "S1-02", "S1-03"]


def test_name_and_layer_with_a_comma_choose_their_faces(run: Run, tmp_path: Path) -> None:
    labels = [Label(name="roof, north"), Label(layer="Skin, east"), Label(name="roof")]
    parts: list[Labelled] = [(label, face, []) for label, face in zip(labels, strip_faces(LIP), strict=True)]
    skin = write_labelled(tmp_path / "skin.step", parts)
    for words, numbers in (
        ('"roof, north"', [1]),
        ('layer="Skin, east",3', [2, 3]),
        ('name = "roof, *" , layer="Skin, *"', [1, 2]),
    ):
        answer = run("inspect", skin, "--faces", words, "--json")
        assert answer.code == 0, answer.err
        assert [face["number"] for face in json.loads(answer.out)["faces"]] == numbers
    answer = run("inspect", skin, "--faces", "roof, north")
    assert answer.code == 2
    assert """has no face 'north': it has faces 1 to 3; names roof, "roof, north"; layers "Skin, east".""" in answer.err


def test_as_few_panels_as_hold_everything_are_found_and_what_was_tried_is_told(
    run: Run, strip: Path, tmp_path: Path
) -> None:
    words = ("fit", strip, "--unit", "mm", "--divide", "auto", "--gap-tolerance", "3")
    answer = run(*words, "--max-deviation", "12", "--out", tmp_path / "out")
    assert answer.code == 0, answer.err
    report = json.loads((tmp_path / "out" / "report.json").read_text(encoding="utf-8"))
    assert report["reference"]["reading"]["divide"] == len(report["panels"])
    assert report["summary"]["max_deviation"] <= 12.0
    assert any("tried together:" in note for note in report["reference"]["notes"])
    assert run("verify", tmp_path / "out").code == 0


@thorough
def test_panels_each_as_wide_as_the_deviation_allows_are_delivered_with_the_cuts_that_make_them_again(
    run: Run, strip: Path, tmp_path: Path
) -> None:
    words = ("fit", strip, "--unit", "mm", "--divide", "strips", "--gap-tolerance", "5")
    answer = run(*words, "--max-deviation", "4", "--out", tmp_path / "out")
    assert answer.code == 0, answer.err
    report = json.loads((tmp_path / "out" / "report.json").read_text(encoding="utf-8"))
    stations = report["reference"]["reading"]["stations"]
    assert len(stations) == len(report["panels"]) - 1 > 0
    assert report["summary"]["max_deviation"] <= 4.0
    assert any("as wide as" in note for note in report["reference"]["notes"])
    assert run("verify", tmp_path / "out").code == 0


@thorough
def test_where_no_number_of_panels_holds_the_best_is_delivered_and_said(
    run: Run, strip: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(fewest_panels, "MOST_FITS", 2)
    words = ("fit", strip, "--unit", "mm", "--divide", "auto", "--gap-tolerance", "0.01", "--quiet")
    answer = run(*words, "--max-deviation", "0.5", "--out", tmp_path / "out")
    assert answer.code == 1
    assert answer.is_one_sentence(), answer.err
    assert answer.err.startswith("No number of panels along each strip from ")
    assert "the best of them" in answer.err
    assert (tmp_path / "out" / "panels.step").is_file()


def test_a_name_that_no_number_of_panels_gives_is_refused_before_any_fit(
    run: Run, strip: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(fewest_panels, "fit", None)
    words = ("fit", strip, "--unit", "mm", "--divide", "auto", "--max-deviation", "12", "--only", "S9-01")
    answer = run(*words, "--out", tmp_path / "out")
    assert (answer.code, answer.is_one_sentence()) == (2, True), answer.err
    assert "There is no panel 'S9-01' to deliver; there is 'S1-" in answer.err


def test_the_number_of_panels_is_chosen_by_the_largest_deviation(run: Run, strip: Path, tmp_path: Path) -> None:
    answer = run("fit", strip, "--divide", "auto", "--out", tmp_path / "out")
    assert answer.code == 2
    assert answer.is_one_sentence(), answer.err
    assert "give --max-deviation, too" in answer.err
    answer = run("fit", strip, "--divide", "strips", "--out", tmp_path / "out")
    assert "--divide strips is chosen by the largest deviation" in answer.err
    answer = run("compare", strip, "--unit", "mm", "--divide", "auto", "--out", tmp_path / "out")
    assert (answer.code, answer.is_one_sentence()) == (2, True)
    assert "is found by fits: ask 'cadpanel fit' or fewest_panels()" in answer.err
