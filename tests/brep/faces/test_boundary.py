"""Borders as points of the surface with its normals and the side of the face, the closer the more they bend."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from OCP.BRepPrimAPI import BRepPrimAPI_MakeCone
from OCP.Geom import Geom_Plane, Geom_SphericalSurface
from OCP.gp import gp_Ax3, gp_Dir, gp_Pln, gp_Pnt
from OCP.TopAbs import TopAbs_FACE
from OCP.TopoDS import TopoDS

from cadpanel.brep.faces.boundary import LARGEST_TURN, unit_normals
from cadpanel.brep.faces.face_patch import patch_of
from cadpanel.brep.kernel.shapes import shapes_of
from tests.known_faces import arc_face, disc_on, face_on, graph_surface

PLANE = Geom_Plane(gp_Pln())


@pytest.mark.parametrize("reverse", [False, True])
@pytest.mark.parametrize(
    "face",
    [
        face_on(PLANE, (0.0, 900.0), (0.0, 500.0)),
        disc_on(PLANE, (40.0, 50.0), 300.0),
        arc_face(400.0, 10.0, 130.0),
        face_on(graph_surface(lambda x, y: 4e-4 * x * x + 3e-4 * x * y)),
    ],
    ids=["plate", "disc", "arc", "bowl"],
)
def test_edges_lie_on_the_surface_with_its_normals_and_look_into_the_face(face, reverse):
    patch = patch_of(TopoDS.Face_s(face.Reversed()) if reverse else face)
    middle = patch.points(patch.bounds.mean(axis=1))
    for edge in patch.edges:
        np.testing.assert_allclose(patch.points(edge.parameters), edge.points, atol=1e-9)
        np.testing.assert_allclose(patch.normals(edge.parameters), edge.normals, atol=1e-9)
        place = len(edge.points) // 2
        inwards = edge.inwards(place)
        assert np.linalg.norm(inwards) == pytest.approx(1.0)
        assert inwards @ (middle - edge.points[place]) > 0.0
        assert inwards @ edge.normals[place] == pytest.approx(0.0, abs=1e-9)


def test_borders_of_a_plate_are_its_sides_and_a_ring_has_no_seam():
    plate = patch_of(face_on(PLANE, (0.0, 900.0), (0.0, 500.0)))
    lengths = sorted(np.linalg.norm(np.diff(edge.points, axis=0), axis=1).sum() for edge in plate.edges)
    assert lengths == pytest.approx([500.0, 500.0, 900.0, 900.0])
    ring = patch_of(arc_face(400.0, 0.0, 360.0))
    assert [np.linalg.norm(edge.points[0] - edge.points[-1]) < 1e-6 for edge in ring.edges] == [True, True]


@settings(max_examples=8)
@given(radius=st.floats(20.0, 5000.0))
def test_a_round_border_turns_little_between_its_points(radius):
    (edge,) = patch_of(disc_on(PLANE, (0.0, 0.0), radius)).edges
    ways = np.diff(edge.points, axis=0)
    ways /= np.linalg.norm(ways, axis=1)[:, None]
    assert np.degrees(np.arccos(np.clip(np.sum(ways[1:] * ways[:-1], axis=1), -1.0, 1.0))).max() < 2.0 * LARGEST_TURN
    np.testing.assert_allclose(np.linalg.norm(edge.points, axis=1), radius)


@given(turn=st.floats(0.1, 3.0), stretch=st.floats(1.0, 1e4))
def test_normals_are_square_to_both_derivatives_and_their_sizes_are_areas(turn, stretch):
    along_u = np.array([(stretch, 0.0, 0.0)])
    along_v = np.array([(2.0 * np.cos(turn), 2.0 * np.sin(turn), 0.0)])
    normals, sizes, defined = unit_normals(along_u, along_v)
    np.testing.assert_allclose(normals, [(0.0, 0.0, 1.0)])
    assert sizes[0] == pytest.approx(2.0 * stretch * np.sin(turn))
    assert defined.all()


def test_where_the_surface_shrinks_to_a_point_no_normal_is_trusted():
    along_u = np.array([(1e-9, 0.0, 0.0), (1.0, 0.0, 0.0)])
    along_v = np.array([(0.0, 1.0, 0.0), (0.0, 1.0, 0.0)])
    normals, _, defined = unit_normals(along_u, along_v)
    assert defined.tolist() == [False, True]
    assert normals[0].tolist() == [0.0, 0.0, 0.0]
    # Of two faces, each is held against its own mean.
    assert unit_normals(along_u, along_v, np.array([0, 1]))[2].tolist() == [True, True]


def test_at_a_pole_and_at_an_apex_an_edge_has_the_normal_beside():
    sphere = Geom_SphericalSurface(gp_Ax3(gp_Pnt(), gp_Dir(0.0, 0.0, 1.0)), 300.0)
    ball = face_on(sphere, (0.0, 1.0), (0.2, np.pi / 2.0))
    cone = shapes_of(BRepPrimAPI_MakeCone(200.0, 0.0, 500.0, 1.0).Shape(), TopAbs_FACE)[0]
    for face in (ball, cone):
        for edge in patch_of(TopoDS.Face_s(face)).edges:
            np.testing.assert_allclose(np.linalg.norm(edge.normals, axis=1), 1.0)
