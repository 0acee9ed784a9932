"""A delivered panels.FCStd in FreeCAD with default preferences: tree, numbers, shapes and colours."""

from __future__ import annotations

import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from OCP.BRep import BRep_Tool
from OCP.BRepMesh import BRepMesh_IncrementalMesh
from OCP.TopLoc import TopLoc_Location

import cadpanel as cp
from cadpanel.brep.building.shown import say_deflection
from cadpanel.brep.kernel.kept import kept_binary, kept_shape
from cadpanel.brep.kernel.shapes import faces_of
from cadpanel.delivery.deliver import deliver
from cadpanel.delivery.document.tree import panel_file
from cadpanel.delivery.outputs.freecad import DOCUMENT
from cadpanel.delivery.own_files import LOFT_DOCUMENT, REPORT
from cadpanel.delivery.records.report import ReportModel, read_report
from cadpanel.delivery.settings import SheetSettings
from cadpanel.delivery.shop_settings import ShopSettings
from tests.delivered import fitted
from tests.freecad.program import run_in_freecad
from tests.known_rails import CYLINDER, rails
from tests.thorough import thorough

pytestmark = pytest.mark.freecad


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("freecad") / "delivery"
    deliver(fitted(), out, SheetSettings(joint=8.0), ShopSettings(outputs=("freecad",)))
    return out


@pytest.fixture(scope="module")
def report(folder: Path) -> ReportModel:
    return read_report(folder / REPORT)


@pytest.fixture(scope="module")
def answers(folder: Path) -> dict[str, dict[str, Any]]:
    given = {"CADPANEL_DOCUMENT": str(folder / DOCUMENT)}
    return {
        name: run_in_freecad("document_driver.py", given, window=name == "window") for name in ("headless", "window")
    }


@pytest.fixture(scope="module", params=["headless", "window"])
def answer(request: pytest.FixtureRequest, answers: dict[str, dict[str, Any]]) -> dict[str, Any]:
    return answers[request.param]


@pytest.fixture(scope="module")
def objects(answer: dict[str, Any]) -> dict[str, dict[str, Any]]:
    found = {thing["label"]: thing for thing in answer["objects"]}
    assert len(found) == len(answer["objects"])
    return found


def test_panels_stand_in_a_tree_by_strip_and_feature_and_the_rest_beside(objects: dict[str, dict[str, Any]]) -> None:
    inside = {label: thing["inside"] for label, thing in objects.items()}
    names = ("N 1", "N 2", "N 3")
    assert all(inside[name] == ["plane-cone-plane"] for name in names)
    assert inside["plane-cone-plane"] == ["Panels"]
    assert all(inside[f"{name} skin"] == ["Skins"] and inside[f"{name} flat"] == ["Flat patterns"] for name in names)
    assert inside["N 1 | N 2"] == inside["N 2 | N 3"] == ["Seams"]
    assert [label for label, of in inside.items() if not of] == [
        "Panels",
        "Seams",
        "Skins",
        "Flat patterns",
        "Schedule",
    ]
    assert {label for label, thing in objects.items() if not thing["visible"]} == {
        *("Skins", "Flat patterns"),
        *(f"{name} {what}" for name in names for what in ("skin", "flat")),
    }


def test_properties_have_their_types_and_the_numbers_of_the_report(
    objects: dict[str, dict[str, Any]], report: ReportModel
) -> None:
    for panel in report.panels:
        own = objects[panel.name]["properties"]
        assert own["PanelName"] == ["App::PropertyString", panel.name]
        assert own["Feature"] == ["App::PropertyString", panel.feature]
        assert own["RmsDeviation"] == ["App::PropertyLength", panel.rms_deviation]
        assert own["SkinArea"] == ["App::PropertyArea", panel.area]
        assert own["MassKg"] == ["App::PropertyFloat", panel.mass]
        assert own["Bend1Sweep"] == ["App::PropertyAngle", abs(panel.patches[1].sweep)]  # type: ignore[union-attr]
        seam = next(seam for seam in report.seams if panel.name in seam.panels)
        assert seam.clear is not None
        assert own["Neighbour1JointLeast"] == ["App::PropertyDistance", seam.clear.least]
        assert own["Neighbour1Kink"] == ["App::PropertyAngle", seam.max_kink]
        assert set(own) - set(objects[panel.name]["fixed"]) == {"WantedFeature"}
        assert own["WantedFeature"] == ["App::PropertyEnumeration", panel.feature]
    assert objects["Panels"]["properties"]["Origin"] == ["App::PropertyVector", list(report.origin.offset)]
    assert objects["Schedule"]["cells"] == {"A1": "row", "B2": "N 1", "E2": 3}


def test_shapes_are_valid_and_those_of_the_report(objects: dict[str, dict[str, Any]], report: ReportModel) -> None:
    shapes = [thing for thing in objects.values() if "shape" in thing]
    assert len(shapes) == 3 * 3 + 2
    assert all(thing["valid"] for thing in shapes)
    for panel in report.panels:
        solid = objects[panel.name]
        assert solid["shape"] == "Solid"
        assert solid["volume"] == pytest.approx(panel.volume, rel=1e-9)
        corners = np.reshape([panel.corners, panel.other_face], (-1, 1, 3))
        assert np.linalg.norm(corners - np.array(solid["vertices"]), axis=-1).min(axis=1).max() < 1e-6
        assert objects[f"{panel.name} skin"]["area"] == pytest.approx(panel.area, rel=1e-9)
        assert panel.blank is not None
        assert objects[f"{panel.name} flat"]["area"] == pytest.approx(panel.blank.area, rel=1e-5)
    assert objects["N 1 | N 2"]["edges"] == 6


def test_there_is_nothing_to_recompute(answer: dict[str, Any]) -> None:
    assert answer["recomputed"] == 0
    assert not any(thing["touched"] for thing in answer["objects"])


def test_the_window_shows_panels_coloured_by_deviation_and_red_seams(
    answers: dict[str, dict[str, Any]], report: ReportModel
) -> None:
    screen = answers["window"]["screen"]
    ordered = sorted(report.panels, key=lambda panel: panel.max_deviation)
    least, most = (screen["colors"][panel.name] for panel in (ordered[0], ordered[-1]))
    assert least == pytest.approx([0.27, 0.0, 0.33], abs=0.01)
    assert most == pytest.approx([0.99, 0.91, 0.14], abs=0.01)
    assert screen["lines"]["N 1 | N 2"] == pytest.approx([0.8, 0.1, 0.1], abs=0.01)
    pixels = {tuple(shade): count for shade, count in screen["pixels"]}
    whole = sum(pixels.values())
    # As it opens, the camera sees panels: neither nothing nor only a corner of them.
    assert 0.3 * whole < pixels[7, 7, 7] < 0.98 * whole
    yellow = sum(count for (red, green, blue), count in pixels.items() if min(red, green) >= 4 and blue <= 2)
    violet = sum(count for (red, green, blue), count in pixels.items() if green <= 1 and min(red, blue) >= 1)
    red = sum(count for (red, green, blue), count in pixels.items() if red >= 5 and max(green, blue) <= 2)
    assert min(yellow, violet) > 0.005 * whole
    assert red > 20


@thorough
def test_the_window_shows_panels_by_the_triangles_that_come_with_them_and_makes_none_of_what_is_hidden(
    answers: dict[str, dict[str, Any]], folder: Path, tmp_path: Path
) -> None:
    kept = triangles_in(folder / DOCUMENT)
    shown = answers["window"]["screen"]["triangles"]
    assert [shown[f"N {place}"] for place in (1, 2, 3)] == kept
    assert all(not shown[f"N {place} {what}"] for place in (1, 2, 3) for what in ("skin", "flat"))
    # Made anew, there would be as many as before: the first panel brings many more, and says that they are as coarse.
    finer = tmp_path / DOCUMENT
    with zipfile.ZipFile(folder / DOCUMENT) as archive, zipfile.ZipFile(finer, "w") as written:
        for name in archive.namelist():
            data = archive.read(name)
            if name == panel_file(0):
                solid = kept_shape(data)
                wanted = BRep_Tool.Triangulation_s(faces_of(solid)[0], TopLoc_Location()).Deflection()
                BRepMesh_IncrementalMesh(solid, 0.02 * wanted)
                say_deflection(solid, wanted)
                data = kept_binary(solid, triangles=True)
            written.writestr(name, data)
    many = triangles_in(finer)
    assert many[0] > 2 * kept[0]
    again = run_in_freecad("document_driver.py", {"CADPANEL_DOCUMENT": str(finer)}, window=True)["screen"]["triangles"]
    assert [again[f"N {place}"] for place in (1, 2, 3)] == many


def triangles_in(document: Path) -> list[int]:
    """How many triangles come with each of the three solids."""
    with zipfile.ZipFile(document) as archive:
        solids = [kept_shape(archive.read(panel_file(place))) for place in range(3)]
    return [
        sum(BRep_Tool.Triangulation_s(face, TopLoc_Location()).NbTriangles() for face in faces_of(solid))
        for solid in solids
    ]


@thorough
def test_the_document_of_a_loft_holds_a_valid_surface_and_its_flat_pattern(tmp_path: Path) -> None:
    record = cp.deliver_loft(cp.loft(*rails(CYLINDER, second=(0.2, 1.5)), name="hood"), tmp_path / "loft")
    given = {"CADPANEL_DOCUMENT": str(tmp_path / "loft" / LOFT_DOCUMENT)}
    found = {one["label"]: one for one in run_in_freecad("document_driver.py", given, window=False)["objects"]}
    assert all(found[label]["valid"] for label in ("hood", "hood flat"))
    assert found["hood"]["area"] == pytest.approx(record.proof.area, rel=1e-5)
    assert found["hood flat"]["area"] == pytest.approx(record.proof.drawn_area, rel=1e-6)
