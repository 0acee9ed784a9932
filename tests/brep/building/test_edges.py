"""Edges and faces that are built by hand: where they end, how long they are, and on which side their face is."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.GCPnts import GCPnts_AbscissaPoint
from OCP.TopAbs import TopAbs_FACE
from OCP.TopExp import TopExp

from cadpanel.brep.building.edges import arc_edge, face_on, line_edge, shell_of, vertex_at
from cadpanel.brep.building.surfaces import plane_surface
from cadpanel.brep.faces.face_patch import patch_of
from cadpanel.brep.kernel.points import TOLERANCE
from cadpanel.brep.kernel.shapes import shapes_of
from cadpanel.brep.splitting.splitter import area_of
from cadpanel.geometry.cone_sections import EllipticSection

places = st.tuples(*[st.floats(-5000.0, 5000.0)] * 3).map(np.array)
X, Y, Z = np.eye(3)


def ends(edge):
    return [np.array(BRep_Tool.Pnt_s(one(edge, True)).Coord()) for one in (TopExp.FirstVertex_s, TopExp.LastVertex_s)]


def at(edge, part):
    curve = BRepAdaptor_Curve(edge)
    first, last = curve.FirstParameter(), curve.LastParameter()
    return np.array(curve.Value(first + part * (last - first)).Coord())


@given(start=places, way=places.filter(lambda way: np.linalg.norm(way) > 1.0))
def test_a_line_runs_from_its_first_vertex_to_its_last_by_length(start, way):
    stop = start + way
    edge = line_edge(vertex_at(start), vertex_at(stop), start, stop)
    np.testing.assert_allclose(ends(edge), [start, stop])
    np.testing.assert_allclose([at(edge, 0.0), at(edge, 0.25), at(edge, 1.0)], [start, start + 0.25 * way, stop])
    assert GCPnts_AbscissaPoint.Length_s(BRepAdaptor_Curve(edge)) == pytest.approx(np.linalg.norm(way))
    assert BRep_Tool.Tolerance_s(edge) == TOLERANCE


@given(major=st.floats(10.0, 3000.0), share=st.floats(0.2, 1.0), start=st.floats(-3.0, 2.0), sweep=st.floats(0.1, 3.0))
def test_an_arc_has_the_parameter_of_its_section(major, share, start, sweep):
    section = EllipticSection(
        center=np.array([5.0, 6.0, 7.0]),
        cosine_axis=major * X,
        sine_axis=share * major * Y,
        start=start,
        stop=start + sweep,
        eccentricity=0.0,
        phase=0.0,
        sense=1,
        mean_height=0.0,
        height_swing=0.0,
    )
    first, last = section.points(np.array([start, start + sweep]))
    edge = arc_edge(vertex_at(first), vertex_at(last), section)
    for part in (0.0, 0.3, 1.0):
        (wanted,) = section.points(np.array([start + part * sweep]))
        np.testing.assert_allclose(at(edge, part), wanted, atol=1e-9 * major)
    np.testing.assert_allclose(ends(edge), [first, last], atol=1e-9 * major)


def square(turn=1):
    corners = [np.array(corner) for corner in ((0.0, 0.0, 0.0), (4.0, 0.0, 0.0), (4.0, 3.0, 0.0), (0.0, 3.0, 0.0))]
    corners = corners[::turn]
    vertices = [vertex_at(corner) for corner in corners]
    following = [*range(1, 4), 0]
    return [line_edge(vertices[k], vertices[n], corners[k], corners[n]) for k, n in enumerate(following)]


@pytest.mark.parametrize("agrees", [True, False])
def test_a_face_looks_the_way_about_which_its_loop_turns(agrees):
    """The loop turns about z, whichever way the plane's own normal points."""
    plane = plane_surface(np.zeros(3), Z if agrees else -Z, X)
    face = face_on(plane.surface, agrees, square())
    assert BRepCheck_Analyzer(face).IsValid()
    assert area_of(face) == pytest.approx(12.0)
    patch = patch_of(face)
    np.testing.assert_allclose(patch.normals(patch.bounds.mean(axis=1)), Z)


def test_faces_that_share_an_edge_make_a_shell_that_hangs_together():
    plane = plane_surface(np.zeros(3), Z, X).surface
    face = face_on(plane, True, square())
    shell = shell_of([face, face])
    assert len(shapes_of(shell, TopAbs_FACE)) == 2
