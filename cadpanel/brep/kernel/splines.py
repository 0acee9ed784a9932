"""Splines between arrays and the kernel: poles, knots, whole curves, and the smooth pieces of a surface or curve."""

from __future__ import annotations

from collections.abc import Sequence
from io import BytesIO

import numpy as np
from OCP.BinTools import BinTools_SurfaceSet
from OCP.BRepAdaptor import BRepAdaptor_Curve, BRepAdaptor_Curve2d, BRepAdaptor_Surface
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge
from OCP.Geom import Geom_BSplineCurve, Geom_BSplineSurface
from OCP.Geom2d import Geom2d_BSplineCurve, Geom2d_Curve
from OCP.GeomAbs import GeomAbs_CN, GeomAbs_Shape
from OCP.TColgp import TColgp_Array1OfPnt, TColgp_Array1OfPnt2d, TColgp_Array2OfPnt
from OCP.TColStd import TColStd_Array1OfInteger, TColStd_Array1OfReal, TColStd_Array2OfReal
from OCP.TopoDS import TopoDS_Edge
from scipy.interpolate import BSpline

from cadpanel.arrays import Array, IntArray
from cadpanel.brep.kernel import points as kernel

DEGREE = 3
# Bytes of a B-spline surface before its poles: its kind, four flags, two degrees, and numbers of poles and knots.
_BEFORE_POLES = 1 + 4 + 2 * 2 + 4 * 4


def numbers(array: TColStd_Array1OfReal) -> Array:
    """The kernel's array of n reals as (n,)."""
    # Not by iteration, which takes the kernel's binding forty times as long.
    return np.array([array.Value(index) for index in range(array.Lower(), array.Upper() + 1)])


def surface_poles(spline: Geom_BSplineSurface) -> Array:
    """(m, n, 3) poles of a surface along u and v, mm; of a rational one (m, n, 4), homogeneous: weighted, and weights.

    They come in the kernel's binary form, at once: asked for one by one they take thirty times as long.
    """
    only, stream = BinTools_SurfaceSet(), BytesIO()
    only.Add(spline)
    only.Write(stream)
    data = stream.getvalue()
    shape, width = (spline.NbUPoles(), spline.NbVPoles()), 4 if spline.IsURational() or spline.IsVRational() else 3
    at = data.index(b"\n") + 1 + _BEFORE_POLES
    poles = np.frombuffer(data, "<f8", shape[0] * shape[1] * width, at).reshape(*shape, width).astype(float)
    poles[..., :3] *= poles[..., 3:] if width > 3 else 1.0
    return poles


def real_array(values: Array) -> TColStd_Array1OfReal:
    """(n,) reals as the kernel's array."""
    array = TColStd_Array1OfReal(1, len(values))
    for index, value in enumerate(values.tolist(), start=1):
        array.SetValue(index, value)
    return array


def integer_array(values: IntArray) -> TColStd_Array1OfInteger:
    """(n,) integers as the kernel's array."""
    array = TColStd_Array1OfInteger(1, len(values))
    for index, value in enumerate(values.tolist(), start=1):
        array.SetValue(index, value)
    return array


def real_grid(values: Array) -> TColStd_Array2OfReal:
    """(m, n) reals as the kernel's array."""
    rows, columns = values.shape
    grid = TColStd_Array2OfReal(1, rows, 1, columns)
    for i, row in enumerate(values.tolist(), start=1):
        for j, value in enumerate(row, start=1):
            grid.SetValue(i, j, value)
    return grid


def pole_array(poles: Array) -> TColgp_Array1OfPnt:
    """(n, 3) control points of a curve, mm."""
    array = TColgp_Array1OfPnt(1, len(poles))
    for index, pole in enumerate(poles, start=1):
        array.SetValue(index, kernel.point(pole))
    return array


def pole_array_2d(poles: Array) -> TColgp_Array1OfPnt2d:
    """(n, 2) control points of a curve in a surface's parameter plane."""
    array = TColgp_Array1OfPnt2d(1, len(poles))
    for index, (u, v) in enumerate(poles.tolist(), start=1):
        array.SetValue(index, kernel.point_2d(u, v))
    return array


def pole_grid(poles: Array) -> TColgp_Array2OfPnt:
    """(m, n, 3) control points of a surface along u and v, mm."""
    rows, columns = poles.shape[:2]
    grid = TColgp_Array2OfPnt(1, rows, 1, columns)
    for i, row in enumerate(poles, start=1):
        for j, pole in enumerate(row, start=1):
            grid.SetValue(i, j, kernel.point(pole))
    return grid


def knot_arrays(sequence: Array) -> tuple[TColStd_Array1OfReal, TColStd_Array1OfInteger]:
    """The different ones of (k,) knots, which do not fall, and how often each of them comes."""
    values, counts = np.unique(sequence, return_counts=True)
    return real_array(values), integer_array(counts)


def spline_curve(spline: BSpline) -> Geom2d_Curve:
    """A spline of the parameter plane as the kernel's."""
    poles = pole_array_2d(np.asarray(spline.c, dtype=np.float64))
    return Geom2d_BSplineCurve(poles, *knot_arrays(spline.t), int(spline.k))


def polyline_edge(points: Sequence[Array]) -> TopoDS_Edge:
    """The edge along a polyline of n >= 2 points (3,), mm, as a spline of degree 1 by number of the point."""
    places = np.arange(1.0, len(points) + 1.0)
    knots = np.concatenate([places[:1], places, places[-1:]])
    return BRepBuilderAPI_MakeEdge(Geom_BSplineCurve(pole_array(np.array(points)), *knot_arrays(knots), 1)).Edge()


def spans_of(surface: BRepAdaptor_Surface, smooth: GeomAbs_Shape = GeomAbs_CN) -> tuple[int, int]:
    """Of how many pieces a surface is made along u and along v, each as smooth as asked for."""
    return int(surface.NbUIntervals(smooth)), int(surface.NbVIntervals(smooth))


def breaks_of(surface: BRepAdaptor_Surface, axis: int, smooth: GeomAbs_Shape = GeomAbs_CN) -> Array:
    """The ends of a surface's smooth pieces along u (0) or v (1), rising parameters."""
    found = TColStd_Array1OfReal(1, spans_of(surface, smooth)[axis] + 1)
    (surface.UIntervals if axis == 0 else surface.VIntervals)(found, smooth)
    return numbers(found)


def curve_breaks(curve: BRepAdaptor_Curve | BRepAdaptor_Curve2d, smooth: GeomAbs_Shape) -> Array:
    """The ends of a curve's smooth pieces, rising parameters."""
    found = TColStd_Array1OfReal(1, curve.NbIntervals(smooth) + 1)
    curve.Intervals(found, smooth)
    return numbers(found)
