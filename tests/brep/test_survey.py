import json
import math

import numpy as np
import pytest
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeFace
from OCP.BRepPrimAPI import BRepPrimAPI_MakeSphere
from OCP.Geom import Geom_ConicalSurface, Geom_CylindricalSurface, Geom_SphericalSurface
from OCP.gp import gp_Ax3, gp_Pln, gp_Pnt
from OCP.TopAbs import TopAbs_FACE

import cadpanel as cp
from cadpanel.brep.files.model import Label
from cadpanel.brep.kernel.shapes import compound_of, shapes_of
from cadpanel.brep.skin.lips import lips_of
from cadpanel.brep.survey import survey
from cadpanel.reference.settings import ReferenceSettings
from fixtures.lips import Lip as EdgeLip
from tests.model_files import Labelled, strip_faces, write_labelled, write_shape
from tests.reference_shapes import Lip, kernel_face
from tests.roof_edges import roof_edge

MM = ReferenceSettings(unit="mm")


def surveyed(tmp_path, *faces):
    return survey(write_shape(tmp_path / "model.brep", compound_of(faces)), MM)


def test_plane_cylinder_cone_and_sphere_are_told_apart_by_their_numbers(tmp_path):
    plane = BRepBuilderAPI_MakeFace(gp_Pln(), 0.0, 1000.0, 0.0, 500.0).Face()
    cylinder = BRepBuilderAPI_MakeFace(Geom_CylindricalSurface(gp_Ax3(), 400.0), 0.0, 1.0, 5e3, 6e3, 1e-6).Face()
    cone = BRepBuilderAPI_MakeFace(Geom_ConicalSurface(gp_Ax3(), 0.2, 300.0), 0.0, 1.0, 1e4, 1.1e4, 1e-6).Face()
    (sphere,) = shapes_of(BRepPrimAPI_MakeSphere(gp_Pnt(5e4, 0.0, 0.0), 700.0, 0.0, 0.5, 1.0).Face(), TopAbs_FACE)
    found = surveyed(tmp_path, plane, cylinder, cone, sphere)
    assert [face.kind for face in found.faces] == ["plane", "cylinder", "cone", "sphere"]
    measured = [face.curvature for face in found.faces]
    assert [curvature.kind for curvature in measured] == ["flat", "developable", "developable", "doubly curved"]
    assert math.isinf(measured[0].smallest_radius)
    assert measured[1].smallest_radius == pytest.approx(400.0)
    assert measured[3].smallest_radius == pytest.approx(700.0)
    # The Gaussian curvature's integral over a patch of a sphere is the solid angle that it spans.
    assert measured[3].total_gaussian == pytest.approx(math.sin(0.5) * 1.0, rel=1e-3)
    assert found.faces[0].size == pytest.approx((1000.0, 500.0))
    assert found.faces[1].area == pytest.approx(400.0 * 1000.0)


def test_lip_of_a_strip_is_found_with_its_turn_width_and_radius(tmp_path):
    lip = Lip(length=6000.0, twist=0.0, taper=0.0, flange=900.0, radius=200.0, fold=80.0)
    found = surveyed(tmp_path, *strip_faces(lip))
    (surface,) = found.surfaces
    assert surface.faces == (1, 2, 3)
    assert surface.strip == pytest.approx((6000.0, 1800.0 + math.radians(80.0) * 200.0), rel=1e-4)
    assert surface.lips is not None
    (one,) = surface.lips
    assert one.turn == pytest.approx(80.0, abs=0.5)
    assert one.radius == pytest.approx(200.0, rel=0.02)
    assert one.middle == pytest.approx(900.0 + 0.5 * math.radians(80.0) * 200.0, rel=0.01)


@pytest.mark.parametrize("latitude", [(-0.5, 0.5), (0.0, 0.5), (0.1, 0.5), (-0.5, 0.2)])
@pytest.mark.parametrize("turn", [0.5, 1.5, 2.0])
def test_a_sphere_has_no_lips_at_its_poles(tmp_path, latitude, turn):
    low, high = (part * math.pi for part in latitude)
    ball = BRepBuilderAPI_MakeFace(Geom_SphericalSurface(gp_Ax3(), 2000.0), 0.0, turn * math.pi, low, high, 1e-6)
    (surface,) = surveyed(tmp_path, ball.Face()).surfaces
    assert not surface.lips
    assert surface.strip is None or min(surface.strip) > 100.0


def test_a_cone_has_no_lip_at_its_apex(tmp_path):
    face = BRepBuilderAPI_MakeFace(Geom_ConicalSurface(gp_Ax3(), 0.3, 0.0), 0.0, 2.0, 0.0, 4000.0, 1e-6).Face()
    assert surveyed(tmp_path, face).surfaces[0].lips == ()


def test_flanges_that_twist_say_by_how_much_seams_would_lean_and_where(tmp_path):
    """The lean of a flange is the angle whose tangent is its twist over its bending along the strip."""
    (surface,) = surveyed(tmp_path, *roof_edge()).surfaces
    assert surface.seams is not None
    assert surface.seams.largest == pytest.approx(33.0, abs=1.5)
    assert 15.0 < surface.seams.mean < 25.0
    assert surface.strip is not None
    assert 0.0 <= surface.seams.at <= surface.strip[0]
    straight = Lip(length=6000.0, twist=0.0, taper=0.0)
    (square,) = surveyed(tmp_path, *strip_faces(straight)).surfaces
    assert square.seams is not None
    assert square.seams.largest < 0.1


def test_what_leans_most_is_found_along_the_strip(tmp_path):
    late = EdgeLip(panels=6, twist=(0.0, 0.0, 3.0), plan=(6.0, 6.0), rise=(3.0, 3.0))
    (surface,) = surveyed(tmp_path, *roof_edge(late)).surfaces
    assert surface.seams is not None
    assert surface.strip is not None
    assert surface.seams.at > 0.7 * surface.strip[0]


def test_even_bend_has_no_lip_and_two_bends_have_two():
    length = np.linspace(0.0, 1000.0, 401)
    assert lips_of(length, length * 1e-3) == ()
    twice = np.interp(length, [0, 200, 300, 700, 800, 1000], [0.0, 0.0, 1.0, 1.0, 2.0, 2.0])
    assert [lip.middle for lip in lips_of(length, twice)] == pytest.approx([250.0, 750.0], abs=3.0)
    assert lips_of(length, 0.05 * twice) == ()


def test_what_was_not_measured_is_not_said(tmp_path):
    corner = kernel_face(Lip(twist=0.0, taper=0.0))
    odd = kernel_face(lambda u, v: Lip(start=2000.0, twist=0.0, taper=0.0)(u * (0.5 + 0.5 * v), v))
    (surface,) = surveyed(tmp_path, corner, odd).surfaces[:1]
    found = surveyed(tmp_path, corner, odd)
    joined = [surface for surface in found.surfaces if len(surface.faces) == 2]
    assert all(surface.lips is None and surface.strip is None for surface in joined)
    assert surface.area > 0.0


def test_lips_of_different_surfaces_are_apart_at_a_crease(tmp_path):
    first = BRepBuilderAPI_MakeFace(gp_Pln(), 0.0, 1000.0, 0.0, 500.0).Face()
    upright = kernel_face(lambda u, v: np.stack([1000.0 * v, 0.0 * u, 500.0 * u], axis=-1), (0.0, 1.0))
    found = surveyed(tmp_path, first, upright)
    assert len(found.surfaces) == 2
    assert any("Two faces of 'model.brep' meet in a crease of more than 30 degrees" in n for n in found.notes)


def test_names_layers_colors_and_curves_are_listed(tmp_path):
    line = BRepBuilderAPI_MakeEdge(gp_Pnt(0.0, 0.0, 0.0), gp_Pnt(3000.0, 4000.0, 0.0)).Edge()
    skin = Label(name="roof", layer="Skin", color="#102030")
    parts: list[Labelled] = [(skin, kernel_face(Lip()), []), (Label(name="axis", layer="Lines"), line, [])]
    found = cp.inspect(write_labelled(tmp_path / "model.step", parts, "INCH"))
    assert (found.format, found.unit) == ("STEP", "inch")
    assert found.faces[0].label == skin
    assert [(curve.label.layer, round(curve.length, 3)) for curve in found.curves] == [("Lines", 5000.0)]


def test_command_prints_tables_or_json(tmp_path, capsys, monkeypatch):
    from cadpanel.cli.main import main

    monkeypatch.setenv("COLUMNS", "160")  # in a narrow window the words of a cell stand below each other

    path = write_shape(tmp_path / "model.brep", compound_of(strip_faces()))
    assert main(["inspect", str(path), "--unit", "mm"]) == 0
    said = capsys.readouterr().out
    assert "model.brep: BREP, unit none, read as 1 mm, 3 faces, 1 surface" in said
    assert "doubly curved" in said or "developable" in said
    assert "Seams lean: by how much a seam would have to lean from square" in said
    assert main(["inspect", str(path), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert [face["number"] for face in found["faces"]] == [1, 2, 3]
    assert "read as millimetres" in found["notes"][0]
    assert set(found["surfaces"][0]["seams"]) == {"mean", "largest", "at"}
    assert main(["inspect", str(tmp_path / "none.step")]) == 2
    assert capsys.readouterr().err.count("\n") == 1
