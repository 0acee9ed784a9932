"""Faces whose shape is known: discs, polygons, creases."""

import numpy as np
from OCP.BRepBuilderAPI import (
    BRepBuilderAPI_MakeEdge,
    BRepBuilderAPI_MakeFace,
    BRepBuilderAPI_MakePolygon,
    BRepBuilderAPI_MakeWire,
)
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepLib import BRepLib
from OCP.Geom import Geom_BezierSurface, Geom_BSplineSurface, Geom_Circle, Geom_CylindricalSurface
from OCP.Geom2d import Geom2d_Circle
from OCP.GeomConvert import GeomConvert
from OCP.gp import gp_Ax2, gp_Ax2d, gp_Ax3, gp_Dir, gp_Dir2d, gp_Pln, gp_Pnt, gp_Pnt2d
from OCP.ShapeFix import ShapeFix_Face
from OCP.TColgp import TColgp_Array2OfPnt
from OCP.TColStd import TColStd_Array1OfInteger, TColStd_Array1OfReal

RADIUS = 500.0


def spline_plane():
    poles = TColgp_Array2OfPnt(1, 2, 1, 2)
    for row, x in enumerate((-RADIUS, RADIUS), start=1):
        for column, y in enumerate((-RADIUS, RADIUS), start=1):
            poles.SetValue(row, column, gp_Pnt(x, y, 0.0))
    return GeomConvert.SurfaceToBSplineSurface_s(Geom_BezierSurface(poles))


def disc(surface):
    """A disc as the readers make it: on a spline surface its border runs up to 0.8 mm beside the circle."""
    circle = Geom_Circle(gp_Ax2(gp_Pnt(0.0, 0.0, 0.0), gp_Dir(0.0, 0.0, 1.0)), RADIUS)
    if not isinstance(surface, gp_Pln):
        circle = GeomConvert.CurveToBSplineCurve_s(circle)
    wire = BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(circle).Edge()).Wire()
    fixing = ShapeFix_Face(BRepBuilderAPI_MakeFace(surface, wire, True).Face())
    fixing.Perform()
    fixing.FixOrientation()
    BRepLib.SameParameter_s(fixing.Face(), 1e-7, True)
    assert BRepCheck_Analyzer(fixing.Face()).IsValid()
    return fixing.Face()


def creased_face(angle):
    """A face of 2 m x 1 m that breaks by so many degrees along its middle, without an edge there."""
    rise = 500.0 * np.tan(np.radians(angle))
    poles = TColgp_Array2OfPnt(1, 3, 1, 2)
    for row, (y, z) in enumerate(((0.0, 0.0), (500.0, 0.0), (1000.0, rise)), start=1):
        for column, x in enumerate((0.0, 2000.0), start=1):
            poles.SetValue(row, column, gp_Pnt(x, y, z))
    knots, ends = TColStd_Array1OfReal(1, 3), TColStd_Array1OfReal(1, 2)
    counts, twice = TColStd_Array1OfInteger(1, 3), TColStd_Array1OfInteger(1, 2)
    for place, (value, count) in enumerate(((0.0, 2), (0.5, 1), (1.0, 2)), start=1):
        knots.SetValue(place, value)
        counts.SetValue(place, count)
    for place in (1, 2):
        ends.SetValue(place, place - 1.0)
        twice.SetValue(place, 2)
    return BRepBuilderAPI_MakeFace(Geom_BSplineSurface(poles, knots, ends, counts, twice, 1, 1), 1e-7).Face()


def flat(corners):
    polygon = BRepBuilderAPI_MakePolygon()
    for corner in corners:
        polygon.Add(gp_Pnt(*map(float, corner)))
    polygon.Close()
    return BRepBuilderAPI_MakeFace(polygon.Wire(), True).Face()


BERNSTEIN = np.array([[1.0, 0.0, 0.0], [0.25, 0.5, 0.25], [0.0, 0.0, 1.0]])


def graph_surface(height, origin=(0.0, 0.0), way_u=(1000.0, 0.0), way_v=(0.0, 1000.0)):
    """The Bezier surface z = height(x, y), of degree 2 in each, over a parallelogram of the plane."""
    parts = np.array([0.0, 0.5, 1.0])
    u, v = np.meshgrid(parts, parts, indexing="ij")
    x, y = (origin[k] + way_u[k] * u + way_v[k] * v for k in range(2))
    inverse = np.linalg.inv(BERNSTEIN)
    poles = np.stack([inverse @ values @ inverse.T for values in (x, y, height(x, y))], axis=-1)
    return bezier_surface(poles)


def bezier_surface(poles):
    """The Bezier surface of (m, n, 3) poles."""
    array = TColgp_Array2OfPnt(1, len(poles), 1, len(poles[0]))
    for row, line in enumerate(np.asarray(poles, dtype=float).tolist(), start=1):
        for column, pole in enumerate(line, start=1):
            array.SetValue(row, column, gp_Pnt(*pole))
    return Geom_BezierSurface(array)


def face_on(surface, *ranges):
    """The face of a whole surface, or of the part of it over a range of u and of v."""
    return BRepBuilderAPI_MakeFace(surface, *(end for own in ranges for end in own), 1e-7).Face()


def disc_on(surface, center, radius):
    """The face that a circle of the parameter plane cuts out of a surface."""
    circle = Geom2d_Circle(gp_Ax2d(gp_Pnt2d(*center), gp_Dir2d(1.0, 0.0)), radius)
    edge = BRepBuilderAPI_MakeEdge(circle, surface).Edge()
    BRepLib.BuildCurves3d_s(edge)
    return BRepBuilderAPI_MakeFace(surface, BRepBuilderAPI_MakeWire(edge).Wire(), True).Face()


def arc_face(radius, first, last, length=1000.0):
    """Of a cylinder about the x axis the part between two angles, degrees."""
    surface = Geom_CylindricalSurface(gp_Ax3(gp_Pnt(), gp_Dir(1.0, 0.0, 0.0), gp_Dir(0.0, 1.0, 0.0)), radius)
    return face_on(surface, np.radians((first, last)).tolist(), (0.0, length))


def hem(gap):
    """A sheet folded twice, its three layers a gap apart."""
    return lambda u, v: np.stack([150.0 * np.cos(3.0 * np.pi * u), 4000.0 * v, 3.0 * gap * u], axis=-1)


def spiral(gap):
    """A sheet that winds round twice."""

    def surface(u, v):
        angle, radius = 4.0 * np.pi * u, 1000.0 + 2.0 * gap * u
        return np.stack([radius * np.cos(angle), radius * np.sin(angle), 3000.0 * v], axis=-1)

    return surface
