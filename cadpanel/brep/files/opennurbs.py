"""From rhino3dm's surfaces, polysurfaces and curves to the kernel's, exactly: both are NURBS.

openNURBS leaves out the first and the last knot, and gives control points multiplied by their weights. rhino3dm shows a
face's trimming curves in space and not in the parameter plane; the kernel projects them onto the surface anew, roughly
(`sharpen_trims` does it again once lengths are millimetres).
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from OCP.BRep import BRep_Tool
from OCP.BRepBuilderAPI import (
    BRepBuilderAPI_MakeEdge,
    BRepBuilderAPI_MakeFace,
    BRepBuilderAPI_MakeWire,
    BRepBuilderAPI_Sewing,
)
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepLib import BRepLib
from OCP.Geom import Geom_BSplineCurve, Geom_BSplineSurface, Geom_Curve
from OCP.GeomAPI import GeomAPI_ProjectPointOnCurve
from OCP.gp import gp_Pnt
from OCP.ShapeFix import ShapeFix_Face
from OCP.TColStd import TColStd_Array1OfInteger, TColStd_Array1OfReal
from OCP.TopAbs import TopAbs_FACE
from OCP.TopoDS import TopoDS, TopoDS_Edge, TopoDS_Face, TopoDS_Shape

from cadpanel.arrays import Array
from cadpanel.brep.kernel.shapes import compound_of, shapes_of
from cadpanel.brep.kernel.splines import knot_arrays, pole_array, pole_grid, real_array, real_grid

# How far a trimming curve may run off its surface, in units of the file: Rhino's own default tolerances are smaller.
TRIM_TOLERANCE = 1e-2
SEWING_TOLERANCE = 1e-3
SURFACE_TOLERANCE = 1e-7
# Points of a curve that are compared with the border of a surface.
CHECKED_POINTS = 9
NATURAL_BORDER = 1e-5
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


def brep_shape(source: RhinoObject) -> TopoDS_Shape:
    """A polysurface as a face, shell or solid, or a compound where its faces do not hang together.

    Raises:
        ConversionError: a face cannot be trimmed as the file says.
    """
    faces = [_face(source, source.Faces[index]) for index in range(len(source.Faces))]
    if not faces:
        raise ConversionError("it has no faces")
    if len(faces) == 1:
        return faces[0]
    sewing = BRepBuilderAPI_Sewing(SEWING_TOLERANCE)
    for face in faces:
        sewing.Add(face)
    sewing.Perform()
    sewn = sewing.SewedShape()
    # Sewing may drop what it takes for a sliver; then the faces stay as they were read.
    return sewn if len(shapes_of(sewn, TopAbs_FACE)) == len(faces) else compound_of(faces)


def _face(brep: RhinoObject, face: RhinoObject) -> TopoDS_Face:
    geometry = surface(face.UnderlyingSurface())
    loops = [face.Loops[index] for index in range(len(face.Loops))]
    trims = [[loop.Trims[index] for index in range(len(loop.Trims))] for loop in loops]
    whole = BRepBuilderAPI_MakeFace(geometry, SURFACE_TOLERANCE).Face()
    edges = {
        trim.EdgeIndex: curve_edge(brep.Edges[trim.EdgeIndex]) for loop in trims for trim in loop if trim.EdgeIndex >= 0
    }
    if len(trims) <= 1 and _is_border(geometry, list(edges.values())):
        made = whole
    else:
        made = _trimmed(geometry, [[edges[trim.EdgeIndex] for trim in loop if trim.EdgeIndex >= 0] for loop in trims])
    return TopoDS.Face_s(made.Reversed()) if face.OrientationIsReversed else made


def _trimmed(geometry: Geom_BSplineSurface, loops: list[list[TopoDS_Edge]]) -> TopoDS_Face:
    making: BRepBuilderAPI_MakeFace | None = None
    for loop in loops:
        wiring = BRepBuilderAPI_MakeWire()
        for edge in loop:
            wiring.Add(edge)
        if not wiring.IsDone():
            raise ConversionError("the trimming curves of a face do not join to a loop")
        if making is None:
            making = BRepBuilderAPI_MakeFace(geometry, wiring.Wire(), True)
        else:
            making.Add(wiring.Wire())
    if making is None or not making.IsDone():
        raise ConversionError("a face cannot be bounded by its trimming curves")
    fixing = ShapeFix_Face(making.Face())
    fixing.SetPrecision(SURFACE_TOLERANCE)
    fixing.SetMaxTolerance(TRIM_TOLERANCE)
    fixing.Perform()
    fixing.FixOrientation()
    fixed = fixing.Face()
    BRepLib.SameParameter_s(fixed, SURFACE_TOLERANCE, True)
    if not BRepCheck_Analyzer(fixed).IsValid():
        raise ConversionError("a face is not valid once it is trimmed by its curves")
    return fixed


def _is_border(geometry: Geom_BSplineSurface, edges: list[TopoDS_Edge]) -> bool:
    """Tell whether all edges run along the border of the surface's parameter range."""
    u_0, u_1, v_0, v_1 = geometry.Bounds()
    borders = (geometry.UIso(u_0), geometry.UIso(u_1), geometry.VIso(v_0), geometry.VIso(v_1))
    for edge in edges:
        along = BRep_Tool.Curve_s(edge, 0.0, 1.0)
        first, last = along.FirstParameter(), along.LastParameter()
        points = [along.Value(first + part * (last - first)) for part in np.linspace(0.0, 1.0, CHECKED_POINTS).tolist()]
        if not any(all(_distance(point, border) < NATURAL_BORDER for point in points) for border in borders):
            return False
    return True


def _distance(point: gp_Pnt, border: Geom_Curve) -> float:
    """From a point to a curve; its ends count, too, as a point beyond them has no foot square to the curve."""
    ends = (border.Value(border.FirstParameter()), border.Value(border.LastParameter()))
    feet = GeomAPI_ProjectPointOnCurve(point, border)
    return float(min(*map(point.Distance, ends), feet.LowerDistance() if feet.NbPoints() else math.inf))


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
