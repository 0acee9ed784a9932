"""Breaks of the tangent plane inside a face are found with their angle, smooth joins are not."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from OCP.BRepAdaptor import BRepAdaptor_Surface

from cadpanel.brep.faces.creases import LEAST, crease_of, has_breaks
from cadpanel.brep.faces.face_patch import patch_of
from tests.known_faces import arc_face, creased_face, face_on, graph_surface


@settings(max_examples=10)
@given(angle=st.floats(1.1 * LEAST, 89.0))
def test_a_crease_has_the_angle_by_which_its_halves_lean(angle):
    assert crease_of(patch_of(creased_face(angle))) == pytest.approx(angle, rel=1e-6)


@pytest.mark.parametrize("angle", [0.0, 0.9 * LEAST])
def test_a_break_that_is_too_small_to_tell_is_none(angle):
    assert crease_of(patch_of(creased_face(angle))) == 0.0


def test_only_surfaces_that_are_not_smooth_have_breaks():
    assert has_breaks(BRepAdaptor_Surface(creased_face(30.0)))
    for face in (arc_face(100.0, 0.0, 300.0), face_on(graph_surface(lambda x, y: 1e-3 * x * y))):
        assert not has_breaks(BRepAdaptor_Surface(face))
        assert crease_of(patch_of(face)) == 0.0
