import numpy as np
import pytest
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace
from OCP.Geom import Geom_BSplineCurve, Geom_BSplineSurface
from scipy.interpolate import make_interp_spline

from cadpanel.brep.files import opennurbs
from cadpanel.brep.files.opennurbs_pcurves import Course, line_of
from cadpanel.brep.kernel.splines import knot_arrays, pole_array
from cadpanel.geometry.vectors import norm
from tests.rhino_files import bent_surface

CLOSE = 1e-5
EVEN = np.linspace(0.0, 1.0, 201)


def arch(parts):
    """A line over the surface, by a part of the way."""
    return np.stack([0.1 + 0.8 * parts, 0.3 + 0.4 * np.sin(np.pi * parts)], axis=-1)


def slant(parts):
    return np.stack([0.1 + 0.8 * parts, 0.2 + 0.6 * parts], axis=-1)


def course_of(line, pace):
    """A trim along a line, and the edge above it, which is walked at another pace."""
    surface: Geom_BSplineSurface = opennurbs.surface(bent_surface())
    adaptor = BRepAdaptor_Surface(BRepBuilderAPI_MakeFace(surface, 1e-7).Face())
    places = np.linspace(0.0, 1.0, 401)
    points = [surface.Value(u, v).Coord() for u, v in line(pace(places)).tolist()]
    spline = make_interp_spline(places, np.array(points), k=3)
    edge = Geom_BSplineCurve(pole_array(spline.c), *knot_arrays(spline.t), 3)
    return Course(trim=line, spline=None, surface=adaptor, edge=edge, close=CLOSE)


@pytest.mark.parametrize("line", [arch, slant])
@pytest.mark.parametrize("pace", [lambda t: t, lambda t: 0.5 * (t + t**2), lambda t: 0.5 - 0.5 * np.cos(np.pi * t)])
def test_curve_keeps_the_edges_pace_and_stays_on_the_trim(line, pace):
    course = course_of(line, pace)
    found = line_of(course)
    values = np.array([found.curve.Value(place).Coord() for place in EVEN.tolist()])
    np.testing.assert_allclose(values, line(pace(EVEN)), atol=1e-6)
    assert norm(course.lifted(values) - course.drawn(EVEN)).max() <= max(10.0 * CLOSE, found.off)


def test_trim_beside_its_edge_is_told_by_how_far():
    course = course_of(arch, lambda t: t)
    shifted = Course(
        trim=lambda parts: arch(parts) + np.array([0.0, 1e-3]),
        spline=None,
        surface=course.surface,
        edge=course.edge,
        close=CLOSE,
    )
    assert line_of(shifted).off == pytest.approx(9.0, rel=1e-3)  # a thousandth of 9 m
