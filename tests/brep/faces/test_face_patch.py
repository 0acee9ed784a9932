"""A face as a part of a parameter plane: its range, lengths along it, and pieces that are the same surface."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from OCP.Geom import Geom_Plane, Geom_SphericalSurface
from OCP.gp import gp_Ax3, gp_Dir, gp_Pln, gp_Pnt
from OCP.TopoDS import TopoDS

from cadpanel.brep.faces.face_patch import INTERVALS, equal_parts, lengths_along, patch_of, rectangle
from cadpanel.brep.splitting.splitter import area_of
from tests.known_faces import arc_face, bezier_surface, disc_on, face_on, graph_surface

RADIUS, LENGTH = 700.0, 1500.0
parts = st.floats(0.0, 1.0)


def bent():
    return patch_of(face_on(graph_surface(lambda x, y: 3e-4 * x * x - 2e-4 * x * y)))


def test_whole_and_trimmed_faces_are_told_apart():
    assert bent().whole
    assert patch_of(arc_face(RADIUS, 10.0, 200.0)).whole
    assert not patch_of(disc_on(Geom_Plane(gp_Pln()), (0.0, 0.0), 100.0)).whole
    assert patch_of(face_on(Geom_SphericalSurface(gp_Ax3(gp_Pnt(), gp_Dir(0.0, 0.0, 1.0)), RADIUS))).whole


@pytest.mark.parametrize(("last", "closed"), [(360.0, True), (359.0, False)])
def test_a_tube_is_closed_round_and_not_along(last, closed):
    patch = patch_of(arc_face(RADIUS, 0.0, last))
    assert (patch.closed(0), patch.closed(1)) == (closed, False)


@given(along=parts, across=parts)
def test_parts_of_the_range_are_taken_along_either_parameter(along, across):
    patch = bent()
    (u, v), (low, high) = patch.at(0, np.array(along), np.array(across)), patch.bounds.T
    np.testing.assert_allclose([u, v], low + (high - low) * [along, across])
    np.testing.assert_allclose(patch.at(1, np.array(along), np.array(across)), low + (high - low) * [across, along])


def test_a_reversed_face_has_the_same_points_and_turned_normals():
    face = face_on(graph_surface(lambda x, y: 3e-4 * x * y))
    patch, back = patch_of(face), patch_of(TopoDS.Face_s(face.Reversed()))
    places = patch.at(0, np.linspace(0.0, 1.0, 5)[:, None], np.linspace(0.0, 1.0, 4)[None])
    np.testing.assert_allclose(back.points(places), patch.points(places))
    np.testing.assert_allclose(back.normals(places), -patch.normals(places))
    np.testing.assert_allclose(np.linalg.norm(patch.normals(places), axis=-1), 1.0)
    # Up, as x and y turn into each other counterclockwise.
    assert (patch.normals(places)[..., 2] > 0.0).all()


@settings(max_examples=10)
@given(cut=st.floats(0.1, 0.9), reverse=st.booleans())
def test_two_rectangles_make_up_the_face_with_its_side(cut, reverse):
    face = face_on(graph_surface(lambda x, y: 3e-4 * x * y))
    patch = patch_of(TopoDS.Face_s(face.Reversed()) if reverse else face)
    halves = [rectangle(patch, (0.0, cut), (0.0, 1.0)), rectangle(patch, (cut, 1.0), (0.0, 1.0))]
    assert sum(map(area_of, halves)) == pytest.approx(area_of(face), rel=1e-9)
    place = np.array([0.5 * cut, 0.3])
    for half in halves:
        found = patch_of(half)
        assert found.side == patch.side
        np.testing.assert_allclose(found.points(place), patch.points(place))


@given(first=st.floats(0.0, 100.0), turn=st.floats(20.0, 250.0))
def test_lengths_round_and_along_a_cylinder_are_plain(first, turn):
    patch = patch_of(arc_face(RADIUS, first, first + turn, LENGTH))
    across = np.array([0.0, 0.4, 1.0])
    even = np.linspace(0.0, 1.0, INTERVALS + 1)
    np.testing.assert_allclose(lengths_along(patch, 0, across), np.tile(np.radians(turn) * RADIUS * even, (3, 1)))
    np.testing.assert_allclose(lengths_along(patch, 1, across), np.tile(LENGTH * even, (3, 1)))


def test_the_length_of_a_parabola_is_that_of_the_books():
    """y = x^2 / (2 p): from the vertex on x / 2 sqrt(1 + (x/p)^2) + p / 2 asinh(x / p)."""
    p, x = 400.0, 1000.0
    patch = patch_of(
        face_on(bezier_surface([[(a, 0.0, z), (a, 10.0, z)] for a, z in ((0, 0), (500, 0), (1000, 1250))]))
    )
    wanted = 0.5 * x * np.hypot(1.0, x / p) + 0.5 * p * np.arcsinh(x / p)
    assert lengths_along(patch, 0, np.array([0.5]))[0, -1] == pytest.approx(wanted, rel=1e-9)


@given(power=st.floats(1.0, 2.0), wanted=st.lists(parts, min_size=1, max_size=5))
def test_equal_parts_turn_the_growth_of_length_round(power, wanted):
    even = np.linspace(0.0, 1.0, INTERVALS + 1)
    found = equal_parts(500.0 * even**power, np.array(wanted))
    np.testing.assert_allclose(found**power, wanted, atol=3e-3 if power > 1.0 else 1e-12)


def test_a_stretch_without_length_is_passed_over():
    reach = np.concatenate([np.linspace(0.0, 1.0, 5), [1.0, 1.0], np.linspace(1.25, 2.0, 4)])
    assert equal_parts(reach, np.array([0.0, 0.5, 1.0])).tolist() == pytest.approx([0.0, 0.4, 1.0])
