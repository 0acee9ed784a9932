"""Triangles that solids bring with them show their faces, and whatever is changed in them is noticed."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.GeomAbs import GeomAbs_Cone
from OCP.gp import gp_Pnt, gp_Pnt2d
from OCP.Poly import Poly_Polygon3D, Poly_PolygonOnTriangulation, Poly_Triangle, Poly_Triangulation
from OCP.TColgp import TColgp_Array1OfPnt
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS_Face, TopoDS_Shape

from cadpanel.brep.building import shown as building
from cadpanel.brep.building.sheet import build_solid, volume_of
from cadpanel.brep.building.shown import shown_binary
from cadpanel.brep.kernel.kept import kept_binary, kept_shape
from cadpanel.brep.kernel.shapes import edges_of, faces_of
from cadpanel.brep.proof.shown import has_triangles, shown_fault
from cadpanel.features.catalogue import feature
from cadpanel.geometry.triangles import shown_deflection
from tests.instances import NAMES, random_polygon, random_shapes

Change = Callable[[TopoDS_Face, Poly_Triangulation], object]


@pytest.mark.parametrize("name", NAMES)
def test_triangles_of_every_feature_show_its_sheets(name: str) -> None:
    for shape in random_shapes(feature(name), 3, 3):
        solid = build_solid(shape, 3.0)
        again = kept_shape(shown_binary(solid))
        assert shown_fault(again) == ""
        assert has_triangles(again)
        assert not has_triangles(solid)
        assert volume_of(again) == pytest.approx(volume_of(solid), rel=1e-12)


@pytest.mark.parametrize("corners", [3, 4, 6])
def test_triangles_of_polygons_show_their_sheets(corners: int) -> None:
    assert shown_fault(kept_shape(shown_binary(build_solid(random_polygon(2, corners), 4.0)))) == ""


def solid() -> TopoDS_Shape:
    """A sheet that came with its triangles."""
    return kept_shape(shown_binary(build_solid(random_shapes(feature("plane-cone-plane"), 4, 1)[0], 3.0)))


def cone_of(shape: TopoDS_Shape) -> tuple[TopoDS_Face, Poly_Triangulation]:
    """One of its cones, with its triangles."""
    face = next(face for face in faces_of(shape) if BRepAdaptor_Surface(face).GetType() == GeomAbs_Cone)
    return face, BRep_Tool.Triangulation_s(face, TopLoc_Location())


def polygon_of(face: TopoDS_Face, mesh: Poly_Triangulation) -> Poly_PolygonOnTriangulation:
    """The longest polygon of its edges."""
    found = [BRep_Tool.PolygonOnTriangulation_s(edge, mesh, TopLoc_Location()) for edge in edges_of(face)]
    return max(found, key=lambda polygon: polygon.NbNodes())


def moved_corner(_face: TopoDS_Face, mesh: Poly_Triangulation) -> None:
    place = mesh.Node(3)
    mesh.SetNode(3, gp_Pnt(place.X() + 2e-6, place.Y(), place.Z()))


def moved_parameters(_face: TopoDS_Face, mesh: Poly_Triangulation) -> None:
    place = mesh.UVNode(3)
    mesh.SetUVNode(3, gp_Pnt2d(place.X(), place.Y() + 1e-5))


def turned_over(_face: TopoDS_Face, mesh: Poly_Triangulation) -> None:
    first, second, third = mesh.Triangle(1).Get()
    mesh.SetTriangle(1, Poly_Triangle(second, first, third))


def left_out(_face: TopoDS_Face, mesh: Poly_Triangulation) -> None:
    mesh.SetTriangle(1, mesh.Triangle(2))


def named_wrongly(_face: TopoDS_Face, mesh: Poly_Triangulation) -> None:
    mesh.SetTriangle(1, Poly_Triangle(1, 2, 10_000))


def says_more(_face: TopoDS_Face, mesh: Poly_Triangulation) -> None:
    mesh.Deflection(1.01 * mesh.Deflection())


def edge_says_less(face: TopoDS_Face, mesh: Poly_Triangulation) -> None:
    polygon = polygon_of(face, mesh)
    polygon.Deflection(0.99 * polygon.Deflection())


def edge_by_others(face: TopoDS_Face, mesh: Poly_Triangulation) -> None:
    polygon = polygon_of(face, mesh)
    polygon.SetNode(2, polygon.Node(3))


def edge_at_others(face: TopoDS_Face, mesh: Poly_Triangulation) -> None:
    polygon = polygon_of(face, mesh)
    polygon.SetParameter(2, 0.9 * polygon.Parameter(2) + 0.1 * polygon.Parameter(3))


def edge_begins_late(face: TopoDS_Face, mesh: Poly_Triangulation) -> None:
    polygon = polygon_of(face, mesh)
    polygon.SetParameter(1, 0.9 * polygon.Parameter(1) + 0.1 * polygon.Parameter(2))


def without_parameters(_face: TopoDS_Face, mesh: Poly_Triangulation) -> None:
    mesh.RemoveUVNodes()


def without_triangles(face: TopoDS_Face, _mesh: Poly_Triangulation) -> None:
    BRep_Builder().UpdateFace(face, None)


def line_of_its_own(face: TopoDS_Face, _mesh: Poly_Triangulation) -> None:
    ends = TColgp_Array1OfPnt(1, 2)
    ends.SetValue(1, gp_Pnt(0.0, 0.0, 0.0))
    ends.SetValue(2, gp_Pnt(1.0, 0.0, 0.0))
    BRep_Builder().UpdateEdge(edges_of(face)[0], Poly_Polygon3D(ends), TopLoc_Location())


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (moved_corner, "do not lie on their face"),
        (moved_parameters, "do not lie on their face"),
        (turned_over, "are turned over"),
        (left_out, "do not fill their face"),
        (named_wrongly, "have corners that there are not"),
        (says_more, "say another distance than FreeCAD asks for"),
        (edge_says_less, "say another distance than FreeCAD asks for"),
        (edge_by_others, "do not follow an edge"),
        (edge_at_others, "do not follow an edge"),
        (edge_begins_late, "do not follow an edge"),
        (without_parameters, "have no place on their face"),
        (without_triangles, "leave out a face"),
        (line_of_its_own, "come with lines of their own"),
    ],
)
def test_whatever_is_changed_in_triangles_is_told(change: Change, told: str) -> None:
    shape = solid()
    change(*cone_of(shape))
    assert shown_fault(shape) == told


def test_triangles_that_lie_too_far_from_a_cone_are_told_whatever_they_say(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    shape = build_solid(random_shapes(feature("plane-cone-plane"), 4, 1)[0], 3.0)
    monkeypatch.setattr(building, "_WIDEST_ANGLE", math.pi)
    monkeypatch.setattr(building, "shown_deflection", lambda points: 50.0 * shown_deflection(points))
    coarse = kept_shape(building.shown_binary(shape))
    wanted = shown_deflection(building.corners_of(coarse))
    assert shown_fault(coarse) == "say another distance than FreeCAD asks for"
    building.say_deflection(coarse, wanted)
    assert shown_fault(coarse).startswith("lie farther from ")


def test_how_far_triangles_may_lie_is_a_share_of_the_size() -> None:
    assert shown_deflection(np.array([[0.0, 1.0, 2.0], [100.0, 201.0, 2.0]]), 2.0) == pytest.approx(2.0)


def test_what_is_kept_without_triangles_has_none() -> None:
    shape = solid()
    assert not has_triangles(kept_shape(kept_binary(shape)))
    assert shown_fault(kept_shape(kept_binary(shape))) == "leave out a face"
