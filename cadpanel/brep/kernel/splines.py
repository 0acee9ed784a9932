"""Splines between arrays and the kernel: parameter curves, polylines, and the smooth pieces of a surface."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge
from OCP.Geom import Geom_BSplineCurve
from OCP.Geom2d import Geom2d_BSplineCurve, Geom2d_Curve
from OCP.GeomAbs import (
    GeomAbs_CN,
)
from OCP.gp import gp_Pnt
from OCP.TColgp import TColgp_Array1OfPnt, TColgp_Array1OfPnt2d
from OCP.TColStd import TColStd_Array1OfInteger, TColStd_Array1OfReal
from OCP.TopoDS import TopoDS_Edge
from scipy.interpolate import BSpline

from cadpanel.arrays import Array
from cadpanel.brep.kernel import points as kernel

DEGREE = 3


def spline_curve(spline: BSpline) -> Geom2d_Curve:
    """A spline of the parameter plane as the kernel's."""
    poles = TColgp_Array1OfPnt2d(1, len(spline.c))
    for index, (u, v) in enumerate(np.asarray(spline.c, dtype=np.float64).tolist(), start=1):
        poles.SetValue(index, kernel.point_2d(u, v))
    values, counts = np.unique(spline.t, return_counts=True)
    knots, multiplicities = TColStd_Array1OfReal(1, len(values)), TColStd_Array1OfInteger(1, len(values))
    for index, (value, count) in enumerate(zip(values.tolist(), counts.tolist(), strict=True), start=1):
        knots.SetValue(index, value)
        multiplicities.SetValue(index, count)
    return Geom2d_BSplineCurve(poles, knots, multiplicities, int(spline.k))


def polyline_edge(points: Sequence[Array]) -> TopoDS_Edge:
    """The edge along a polyline of n >= 2 points (3,), mm, as a spline of degree 1 by number of the point."""
    count = len(points)
    poles = TColgp_Array1OfPnt(1, count)
    knots, multiplicities = TColStd_Array1OfReal(1, count), TColStd_Array1OfInteger(1, count)
    for place, point in enumerate(points, start=1):
        poles.SetValue(place, gp_Pnt(*point.tolist()))
        knots.SetValue(place, float(place))
        multiplicities.SetValue(place, 2 if place in (1, count) else 1)
    return BRepBuilderAPI_MakeEdge(Geom_BSplineCurve(poles, knots, multiplicities, 1)).Edge()


def spans_of(surface: BRepAdaptor_Surface) -> tuple[int, int]:
    """Of how many smooth pieces a surface is made along u and along v."""
    return int(surface.NbUIntervals(GeomAbs_CN)), int(surface.NbVIntervals(GeomAbs_CN))


def breaks_of(surface: BRepAdaptor_Surface, axis: int) -> Array:
    """The ends of a surface's smooth pieces along u (0) or v (1), rising parameters."""
    found = TColStd_Array1OfReal(1, spans_of(surface)[axis] + 1)
    (surface.UIntervals if axis == 0 else surface.VIntervals)(found, GeomAbs_CN)
    return np.array([found.Value(place) for place in range(1, found.Length() + 1)])
