"""From rhino3dm's surfaces and curves to the kernel's, exactly: both are NURBS.

openNURBS leaves out the first and the last knot, and gives control points multiplied by their weights.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeFace
from OCP.Geom import Geom_BSplineCurve, Geom_BSplineSurface
from OCP.TColStd import TColStd_Array1OfInteger, TColStd_Array1OfReal
from OCP.TopoDS import TopoDS_Edge, TopoDS_Face

from cadpanel.arrays import Array
from cadpanel.brep.kernel.splines import knot_arrays, pole_array, pole_grid, real_array, real_grid

SURFACE_TOLERANCE = 1e-7
# One of rhino3dm's objects; it has no types.
RhinoObject = Any


class ConversionError(Exception):
    """A surface or curve that the kernel cannot take over; the message says why."""


def surface(source: RhinoObject) -> Geom_BSplineSurface:
    """A surface of rhino3dm as the kernel's.

    Raises:
        ConversionError: it has no NURBS form.
    """
    nurbs = source.ToNurbsSurface()
    if nurbs is None:
        raise ConversionError("a surface has no NURBS form")
    count_u, count_v = nurbs.Points.CountU, nurbs.Points.CountV
    points = [[nurbs.Points.GetControlPoint(i, j) for j in range(count_v)] for i in range(count_u)]
    numbers = np.array([[(point.X, point.Y, point.Z, point.W) for point in row] for row in points])
    poles, weights = _from_homogeneous(numbers)
    degree_u, degree_v = nurbs.OrderU - 1, nurbs.OrderV - 1
    knots_u, multiplicities_u = _knots(nurbs.KnotsU, degree_u)
    knots_v, multiplicities_v = _knots(nurbs.KnotsV, degree_v)
    return Geom_BSplineSurface(
        pole_grid(poles),
        real_grid(weights),
        knots_u,
        knots_v,
        multiplicities_u,
        multiplicities_v,
        degree_u,
        degree_v,
    )


def curve(source: RhinoObject) -> Geom_BSplineCurve:
    """A curve of rhino3dm as the kernel's.

    Raises:
        ConversionError: it has no NURBS form.
    """
    nurbs = source.ToNurbsCurve()
    if nurbs is None:
        raise ConversionError("a curve has no NURBS form")
    count = len(nurbs.Points)
    numbers = np.array([(point.X, point.Y, point.Z, point.W) for point in (nurbs.Points[i] for i in range(count))])
    poles, weights = _from_homogeneous(numbers)
    knots, multiplicities = _knots(nurbs.Knots, nurbs.Degree)
    return Geom_BSplineCurve(pole_array(poles), real_array(weights), knots, multiplicities, nurbs.Degree)


def curve_edge(source: RhinoObject) -> TopoDS_Edge:
    """A curve as an edge."""
    return BRepBuilderAPI_MakeEdge(curve(source)).Edge()


def surface_face(source: RhinoObject) -> TopoDS_Face:
    """A whole surface as a face."""
    return BRepBuilderAPI_MakeFace(surface(source), SURFACE_TOLERANCE).Face()


def _from_homogeneous(numbers: Array) -> tuple[Array, Array]:
    weights = numbers[..., 3]
    if not (np.isfinite(numbers).all() and (weights > 0.0).all()):
        raise ConversionError(
            "a control point is no point: a coordinate is not a number, or its weight is not positive"
        )
    return numbers[..., :3] / weights[..., None], weights


def _knots(source: RhinoObject, degree: int) -> tuple[TColStd_Array1OfReal, TColStd_Array1OfInteger]:
    """The kernel's knots and their multiplicities; the two that openNURBS leaves out repeat their neighbours."""
    given = np.array([source[index] for index in range(len(source))])
    if not np.isfinite(given).all():
        raise ConversionError("a knot is not a number")
    sequence = np.concatenate([given[:1], given, given[-1:]])
    values, counts = np.unique(sequence, return_counts=True)
    if len(values) < 2 or (np.diff(given) < 0.0).any() or counts.max() > degree + 1:
        raise ConversionError("its knots do not rise")
    return knot_arrays(sequence)
