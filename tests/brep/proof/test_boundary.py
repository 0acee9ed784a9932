"""Two boundaries are one where every vertex, edge and face is, whatever their order and direction."""

from dataclasses import replace

import numpy as np
import pytest
from OCP.BRep import BRep_Builder
from OCP.BRepBuilderAPI import BRepBuilderAPI_GTransform, BRepBuilderAPI_Transform
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox, BRepPrimAPI_MakeCone
from OCP.gp import gp_GTrsf, gp_Mat, gp_Trsf, gp_Vec

from cadpanel.brep.building.sheet import build_panel
from cadpanel.brep.kernel.shapes import compound_of
from cadpanel.brep.proof.boundary import SAME_PLACE, difference
from cadpanel.brep.proof.inspection import boundary_of
from tests.boundaries import SHAPES, shuffled
from tests.drawn import curve


def solid(name, thickness=3.0, side="outer"):
    return build_panel(SHAPES[name], thickness, side).solid


def skin(name):
    return build_panel(SHAPES[name], 3.0).skin


@pytest.mark.parametrize("name", SHAPES)
@pytest.mark.parametrize("made", [solid, skin])
def test_a_shape_is_itself_in_whatever_order(made, name):
    own = boundary_of(made(name))
    assert difference(own, own) is None
    assert difference(shuffled(own), own) is None
    assert difference(own, shuffled(own)) is None


@pytest.mark.parametrize("name", SHAPES)
def test_a_shape_that_moves_by_more_than_two_points_that_are_one_is_another(name):
    own = boundary_of(solid(name))
    for way in np.eye(3):
        for length, same in ((0.1 * SAME_PLACE, True), (10.0 * SAME_PLACE, False)):
            step = gp_Trsf()
            step.SetTranslation(gp_Vec(*(length * way)))
            found = difference(boundary_of(BRepBuilderAPI_Transform(solid(name), step, True).Shape()), own)
            assert (found is None) is same


@pytest.mark.parametrize("name", SHAPES)
@pytest.mark.parametrize("other", [lambda name: solid(name, 4.0), lambda name: solid(name, 3.0, "inner"), skin])
def test_another_thickness_another_side_and_a_skin_are_other_shapes(name, other):
    assert difference(boundary_of(other(name)), boundary_of(solid(name))) is not None


@pytest.mark.parametrize("by", [1e-5, 0.5, 1000.0])
def test_a_far_face_that_is_sheared_sideways_is_seen(by):
    """Volume, number of faces, and the planes of both large faces stay as they are."""
    box = BRepPrimAPI_MakeBox(900.0, 700.0, 3.0).Shape()
    shear = gp_GTrsf()
    shear.SetVectorialPart(gp_Mat(1.0, 0.0, by / 3.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0))
    assert difference(boundary_of(BRepBuilderAPI_GTransform(box, shear, True).Shape()), boundary_of(box)) is not None


def test_normals_that_are_turned_are_seen():
    own = boundary_of(solid("folded"))
    turned = boundary_of(solid("folded").Reversed())
    assert difference(turned, own) == "has a face that looks 2 rad another way"


def test_loose_geometry_beside_a_shape_is_seen():
    loose = compound_of([solid("folded"), curve(np.array([[0.0, 0.0, 9.0], [5.0, 0.0, 9.0], [9.0, 1.0, 9.0]]))])
    assert "vertices" in str(difference(boundary_of(loose), boundary_of(solid("folded"))))


def test_a_surface_that_leaves_its_edges_alone_is_seen():
    """Between the same edges a cone may take the place of a plane: the kernel would not check it."""
    own = boundary_of(solid("folded"))
    surfaces = own.surfaces.copy()
    surfaces[0, 6:8] = 300.0, 0.1
    assert difference(replace(own, surfaces=surfaces), own) == "has a face of another kind"
    moved = own.surfaces.copy()
    moved[0, :3] += 0.01 * moved[0, 3:6]
    assert "mm from its place" in str(difference(replace(own, surfaces=moved), own))


def test_the_apex_of_a_cone_is_an_edge_without_length():
    cone = BRepPrimAPI_MakeCone(50.0, 0.0, 80.0).Shape()
    assert difference(boundary_of(cone), boundary_of(cone)) is None


def test_a_face_with_other_edges_is_seen():
    own = boundary_of(solid("folded"))
    crossed = own.edge_faces.copy()
    crossed[0], crossed[-1] = own.edge_faces[-1].copy(), own.edge_faces[0].copy()
    assert difference(replace(own, edge_faces=crossed), own) == "has a face with other edges"


def test_nothing_is_nothing():
    empty = compound_of([])
    BRep_Builder().MakeCompound(empty)
    assert difference(boundary_of(empty), boundary_of(empty)) is None
