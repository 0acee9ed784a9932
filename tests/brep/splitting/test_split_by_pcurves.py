"""A patch sliced in its parameter plane: pieces in order, of the same surface and side, that make up the whole."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.Geom import Geom_Plane
from OCP.gp import gp_Pln
from OCP.TopoDS import TopoDS

from cadpanel.brep.faces.face_patch import patch_of
from cadpanel.brep.splitting.split_by_pcurves import slice_patch
from cadpanel.brep.splitting.splitter import area_of
from tests.known_faces import face_on, graph_surface

ACROSS = np.linspace(0.0, 1.0, 9)


@settings(max_examples=10)
@given(
    axis=st.sampled_from([0, 1]), reverse=st.booleans(), slant=st.floats(-0.1, 0.1), bend=st.sampled_from([0.0, 0.08])
)
def test_pieces_make_up_the_patch_whichever_way_it_is_cut(axis, reverse, slant, bend):
    face = face_on(graph_surface(lambda x, y: 3e-4 * x * x - 1e-4 * x * y))
    patch = patch_of(TopoDS.Face_s(face.Reversed()) if reverse else face)
    shape = slant * (ACROSS - 0.5) + bend * np.sin(np.pi * ACROSS)
    cuts = np.array([0.3 + shape, 0.7 + shape])
    pieces = slice_patch(patch, axis, ACROSS, cuts)
    assert len(pieces) == 3
    assert all(BRepCheck_Analyzer(piece).IsValid() for piece in pieces)
    assert sum(map(area_of, pieces)) == pytest.approx(area_of(face), rel=1e-6)
    found = [patch_of(piece) for piece in pieces]
    assert {one.side for one in found} == {patch.side}
    # In the order of the parameter that the cuts divide.
    middles = [one.bounds[axis].mean() for one in found]
    assert middles == sorted(middles)


def test_slices_of_a_plane_have_the_areas_of_trapezia():
    patch = patch_of(face_on(Geom_Plane(gp_Pln()), (0.0, 1000.0), (0.0, 400.0)))
    pieces = slice_patch(patch, 0, ACROSS, np.array([0.2 + 0.4 * ACROSS]))
    assert [area_of(piece) for piece in pieces] == pytest.approx([0.4 * 400_000.0, 0.6 * 400_000.0])


def test_no_cuts_leave_the_patch_as_it_is_and_straight_cuts_its_rectangles():
    patch = patch_of(face_on(Geom_Plane(gp_Pln()), (0.0, 1000.0), (0.0, 400.0)))
    (whole,) = slice_patch(patch, 1, ACROSS, np.zeros((0, len(ACROSS))))
    np.testing.assert_allclose(patch_of(whole).bounds, patch.bounds)
    low, high = slice_patch(patch, 1, ACROSS, np.full((1, len(ACROSS)), 0.25))
    np.testing.assert_allclose(patch_of(low).bounds, [(0.0, 1000.0), (0.0, 100.0)])
    np.testing.assert_allclose(patch_of(high).bounds, [(0.0, 1000.0), (100.0, 400.0)])
