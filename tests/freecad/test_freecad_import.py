"""What FreeCAD, a program that knows nothing of cadpanel, makes of STEP files."""

from __future__ import annotations

from math import pi
from pathlib import Path

import cadquery as cq
import pytest

from tests.freecad import program
from tests.freecad.program import import_with_freecad

pytestmark = pytest.mark.freecad


def truncated_cone(low: float, high: float, height: float) -> cq.Solid:
    return cq.Solid.makeCone(low, high, height)


@pytest.fixture(scope="module")
def assembly(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two boxes, two truncated cones and a cylinder: named, and three of them placed away from the origin."""
    path = tmp_path_factory.mktemp("freecad") / "named solids.step"
    parts = cq.Assembly(name="facade")
    parts.add(cq.Solid.makeBox(10, 20, 30), name="Box 1")
    parts.add(cq.Solid.makeBox(1, 2, 3), name="Box 2", loc=cq.Location(cq.Vector(100, 0, 0)))
    parts.add(truncated_cone(5, 3, 10), name="Kegel-Sued")
    parts.add(truncated_cone(50, 49.9, 10), name="N.01", loc=cq.Location(cq.Vector(0, 0, 1000)))
    parts.add(cq.Solid.makeCylinder(5, 10), name="Rohr", loc=cq.Location(cq.Vector(0, 500, 0)))
    parts.export(str(path))
    # cadquery writes names beyond ASCII in the wrong encoding; STEP itself has no trouble with them.
    path.write_bytes(path.read_bytes().replace(b"Kegel-Sued", "Kegel-Süd".encode()))
    return path


@pytest.fixture(scope="module")
def objects(assembly: Path) -> dict[str, dict[str, object]]:
    found = import_with_freecad(assembly)
    assert len(found) == 5
    return {thing["label"]: thing for thing in found}


def test_every_solid_is_found_under_its_name(objects: dict[str, dict[str, object]]) -> None:
    assert set(objects) == {"Box 1", "Box 2", "Kegel-Süd", "N.01", "Rohr"}
    assert {thing["solids"] for thing in objects.values()} == {1}


def test_every_solid_is_valid_and_closed(objects: dict[str, dict[str, object]]) -> None:
    assert all(thing["valid"] and thing["closed"] for thing in objects.values())


@pytest.mark.parametrize(
    ("label", "volume"),
    [
        ("Box 1", 6000.0),
        ("Box 2", 6.0),
        ("Kegel-Süd", pi * 10 / 3 * (5**2 + 5 * 3 + 3**2)),
        ("N.01", pi * 10 / 3 * (50**2 + 50 * 49.9 + 49.9**2)),
        ("Rohr", pi * 250.0),
    ],
)
def test_volumes_are_in_cubic_millimetres(objects: dict[str, dict[str, object]], label: str, volume: float) -> None:
    assert objects[label]["volume"] == pytest.approx(volume, rel=1e-9)


@pytest.mark.parametrize(
    ("label", "kinds"),
    [
        ("Box 1", ["Plane"] * 6),
        ("Kegel-Süd", ["Cone", "Plane", "Plane"]),
        ("N.01", ["Cone", "Plane", "Plane"]),
        ("Rohr", ["Cylinder", "Plane", "Plane"]),
    ],
)
def test_faces_keep_their_kind(objects: dict[str, dict[str, object]], label: str, kinds: list[str]) -> None:
    faces = objects[label]["face_types"]
    assert isinstance(faces, list)
    assert sorted(faces) == kinds


def test_solids_stand_where_they_were_put(objects: dict[str, dict[str, object]]) -> None:
    box = objects["Box 2"]["bounding_box"]
    assert box == [pytest.approx([100.0, 0.0, 0.0], abs=1e-6), pytest.approx([101.0, 2.0, 3.0], abs=1e-6)]


def test_a_file_that_is_not_step_is_an_error_and_not_an_empty_answer(tmp_path: Path) -> None:
    (tmp_path / "no.step").write_text("this is not STEP")
    with pytest.raises(RuntimeError, match="FreeCAD could not run import_driver"):
        import_with_freecad(tmp_path / "no.step")


@pytest.mark.parametrize(("required", "outcome"), [("0", pytest.skip.Exception), ("1", pytest.fail.Exception)])
def test_a_missing_freecad_is_a_skip_unless_it_is_required(
    monkeypatch: pytest.MonkeyPatch, required: str, outcome: type[BaseException]
) -> None:
    monkeypatch.setattr(program, "PROGRAMS", ("a-program-that-is-not-there",))
    monkeypatch.setenv(program.REQUIRED, required)
    with pytest.raises(outcome, match="not installed"):
        import_with_freecad(Path("any.step"))
