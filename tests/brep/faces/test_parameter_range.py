"""A grid lies evenly over what a face fills, whatever curve its border is written as."""

import numpy as np
import pytest
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeFace, BRepBuilderAPI_MakeWire
from OCP.BRepLib import BRepLib
from OCP.BRepTools import BRepTools
from OCP.Convert import Convert_QuasiAngular, Convert_RationalC1, Convert_TgtThetaOver2
from OCP.Geom2d import Geom2d_Ellipse
from OCP.Geom2dConvert import Geom2dConvert
from OCP.gp import gp_Ax2d, gp_Dir2d, gp_Pnt2d

from cadpanel.brep.faces.face_patch import patch_of
from cadpanel.brep.faces.parameter_range import parameter_range
from cadpanel.brep.read import read_raw_panels
from cadpanel.reference.settings import ReferenceSettings
from tests.brep.splitting.test_split import RADIUS, spline_plane
from tests.model_files import strip_faces, write_shape

CENTER = (0.45, 0.55)  # of the spline plane's parameters, which go from 0 to 1 over a square
KINDS = {"thirds": Convert_TgtThetaOver2, "quasi-angular": Convert_QuasiAngular, "C1": Convert_RationalC1}


def ellipse_face(kind, turn, major=0.3, minor=0.2):
    """A face within an ellipse, its major axis turned by an angle, written as a rational spline."""
    axis = gp_Ax2d(gp_Pnt2d(*CENTER), gp_Dir2d(np.cos(turn), np.sin(turn)))
    border = Geom2dConvert.CurveToBSplineCurve_s(Geom2d_Ellipse(axis, major, minor), kind)
    surface = spline_plane()
    wire = BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(border, surface).Edge()).Wire()
    face = BRepBuilderAPI_MakeFace(surface, wire, True).Face()
    BRepLib.BuildCurves3d_s(face)
    return face


@pytest.mark.parametrize("kind", KINDS.values(), ids=KINDS)
@pytest.mark.parametrize("turn", [0.0, 0.5, 2.0])
def test_range_of_an_ellipse_is_its_own_and_not_that_of_its_control_points(kind, turn):
    face = ellipse_face(kind, turn)
    half_u = np.hypot(0.3 * np.cos(turn), 0.2 * np.sin(turn))
    half_v = np.hypot(0.3 * np.sin(turn), 0.2 * np.cos(turn))
    wanted = [[CENTER[0] - half_u, CENTER[0] + half_u], [CENTER[1] - half_v, CENTER[1] + half_v]]
    np.testing.assert_allclose(parameter_range(face), wanted, atol=1e-9)
    np.testing.assert_allclose(patch_of(face).bounds, wanted, atol=1e-9)


def test_range_of_a_whole_face_is_the_kernels():
    for face in strip_faces():
        np.testing.assert_array_equal(parameter_range(face).ravel(), BRepTools.UVBounds_s(face))


@pytest.mark.parametrize("kind", KINDS.values(), ids=KINDS)
def test_grid_over_an_ellipse_is_symmetric(tmp_path, kind):
    path = write_shape(tmp_path / "ellipse.brep", ellipse_face(kind, 0.0))
    panels = read_raw_panels(path, ReferenceSettings(unit="mm", grid=(2, 3))).panels
    weights = np.array([sum(face.weights.sum() for face in panel.faces) for panel in panels]).reshape(2, 3)
    assert [panel.name for panel in panels] == [f"S1-R0{row}-C0{column}" for row in (1, 2) for column in (1, 2, 3)]
    np.testing.assert_allclose(weights, weights[::-1, ::-1], rtol=1e-6)
    np.testing.assert_allclose(weights, weights[::-1], rtol=1e-6)
    # The outer thirds of a circle's height each hold this part of it, and an ellipse is a circle drawn out.
    half_chord = np.arccos(1.0 / 3.0)
    outer = (half_chord - np.sin(half_chord) / 3.0) / np.pi
    whole = np.pi * 0.3 * 0.2 * (2.0 * RADIUS) ** 2
    np.testing.assert_allclose(weights[0], 0.5 * whole * np.array([outer, 1.0 - 2.0 * outer, outer]), rtol=1e-6)
