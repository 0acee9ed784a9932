"""The faces of a Rhino polysurface on the kernel's surfaces, bounded by the trims that the file has.

Every edge is made once, by its curve in space, and shared by the faces that it bounds. On each of them it gets a curve
of the parameter plane that runs where the file's trim does, at the same pace as the edge: so a seam has its place on
both sides of the range, and a side that has shrunk to a point is one.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Any, cast

import numpy as np
from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepLib import BRepLib
from OCP.Geom import Geom_BSplineCurve
from OCP.Geom2d import Geom2d_BSplineCurve
from OCP.GeomAPI import GeomAPI
from OCP.gp import gp_Pln, gp_Pnt
from OCP.Standard import Standard_Failure
from OCP.TopAbs import TopAbs_REVERSED
from OCP.TopoDS import TopoDS, TopoDS_Edge, TopoDS_Face, TopoDS_Shape, TopoDS_Vertex, TopoDS_Wire

from cadpanel.arrays import Array
from cadpanel.brep.files.opennurbs import ConversionError, RhinoObject, curve, surface
from cadpanel.brep.files.opennurbs_pcurves import Course, Line, line_of, straight_line
from cadpanel.brep.files.opennurbs_trims import SINGULAR, Trim, trims_of
from cadpanel.brep.kernel import points as kernel
from cadpanel.brep.kernel.said import said_by
from cadpanel.brep.kernel.shapes import compound_of
from cadpanel.brep.kernel.splines import numbers, real_array

# How far a trim may run beside its edge, in units of the file: Rhino's own default tolerances are smaller.
TRIM_TOLERANCE = 1e-2
# What counts as no distance between a trim and its edge, mm.
CLOSE = 1e-5
# A tolerance is larger by this factor than what was measured, as points between those looked at may lie farther off.
SPARE = 2.0
# Parts of a surface's range at which its parameters are compared with those of its NURBS form, and how closely.
PROBED = np.linspace(0.0, 1.0, 6)
ALIKE = 1e-12
# A point has no length to walk: its line in the parameter plane has a range of its own.
POINT_RANGE = (0.0, 1.0)
BOTH_SIDES = 2
_BUILDER = BRep_Builder()


@dataclass(frozen=True, slots=True, kw_only=True)
class Faces:
    """What a polysurface gives.

    Attributes:
        shape: a face, or a compound of faces that share their edges; None where none can be read.
        unreadable: of those that cannot, the place among all its faces, and why.
    """

    shape: TopoDS_Shape | None
    unreadable: dict[int, str]


def brep_faces(source: RhinoObject, rhino: Any, millimetres: float) -> Faces:
    """The faces of a polysurface.

    Args:
        source: rhino3dm's Brep.
        rhino: the library.
        millimetres: how many the unit of the file has.

    Raises:
        ConversionError: it has none, or none of its trims can be read.
    """
    if not len(source.Faces):
        raise ConversionError("it has no faces")
    building = _Building(source, rhino, millimetres)
    faces: list[TopoDS_Face] = []
    unreadable: dict[int, str] = {}
    for index in range(len(source.Faces)):
        try:
            faces.append(building.face(index))
        except ConversionError as error:
            unreadable[index] = str(error)
        except Standard_Failure as error:
            unreadable[index] = f"it makes the CAD kernel fail, {said_by(error)}"
    shape = faces[0] if len(faces) == 1 else compound_of(faces) if faces else None
    return Faces(shape=shape, unreadable=unreadable)


class _Building:
    """What the faces of one polysurface have in common."""

    def __init__(self, source: RhinoObject, rhino: Any, millimetres: float) -> None:
        self._source, self._millimetres = source, millimetres
        self._tolerance = kernel.TOLERANCE / millimetres
        self._trims = trims_of(source, rhino.CommonObject.Decode)
        self._edges: dict[int, TopoDS_Edge] = {}
        self._vertices: dict[int, TopoDS_Vertex] = {}

    def face(self, index: int) -> TopoDS_Face:
        """One face.

        Raises:
            ConversionError: its surface, an edge or its borders are nothing that the kernel could take over.
            Standard_Failure: the kernel gives up.
        """
        given = self._source.Faces[index].UnderlyingSurface()
        geometry = surface(given)
        if self._trims.loops[index]:
            face = TopoDS_Face()
            _BUILDER.MakeFace(face, geometry, self._tolerance)
            parameters = _Parameters(given)
            for loop in self._trims.loops[index]:
                _BUILDER.Add(face, self._wire(loop, face, parameters))
            BRepLib.UpdateTolerances_s(face, False)
        else:
            face = BRepBuilderAPI_MakeFace(geometry, self._tolerance).Face()
        if not BRepCheck_Analyzer(face).IsValid():
            raise ConversionError("it is not valid once it is trimmed by its curves")
        return TopoDS.Face_s(face.Reversed()) if self._source.Faces[index].OrientationIsReversed else face

    def _wire(self, loop: tuple[Trim, ...], face: TopoDS_Face, parameters: _Parameters) -> TopoDS_Wire:
        wire, adaptor = TopoDS_Wire(), BRepAdaptor_Surface(face, False)
        _BUILDER.MakeWire(wire)
        by_edge: dict[int, list[Trim]] = {}
        for trim in loop:
            if trim.edge < 0 or trim.kind == SINGULAR:
                _BUILDER.Add(wire, self._point(trim, face, parameters))
            else:
                by_edge.setdefault(trim.edge, []).append(trim)
                _BUILDER.Add(wire, self._edge(trim.edge, turned=trim.against_edge))
        for index, trims in by_edge.items():
            edge = self._edge(index, turned=False)
            self._lay(edge, [self._line(trim, edge, adaptor, parameters) for trim in _sides(trims)], face)
        wire.Closed(True)
        return wire

    def _line(self, trim: Trim, edge: TopoDS_Edge, adaptor: BRepAdaptor_Surface, parameters: _Parameters) -> Line:
        along = BRep_Tool.Curve_s(edge, 0.0, 1.0)
        course = Course(
            trim=partial(parameters.along_edge, trim),
            spline=parameters.spline(trim, along),
            surface=adaptor,
            edge=along,
            close=CLOSE / self._millimetres,
        )
        line = line_of(course)
        if line.off > TRIM_TOLERANCE:
            raise ConversionError(f"a trimming curve runs beside its edge, by up to {line.off:.2g} units of the file")
        return line

    def _lay(self, edge: TopoDS_Edge, lines: list[Line], face: TopoDS_Face) -> None:
        """Give an edge its curves on a face, two where it has the face on both sides."""
        off = SPARE * max(line.off for line in lines)
        tolerance = max(off, self._tolerance, float(BRep_Tool.Tolerance_s(edge)))
        _BUILDER.UpdateEdge(edge, *(line.curve for line in lines), face, tolerance)

    def _edge(self, index: int, *, turned: bool) -> TopoDS_Edge:
        if index not in self._edges:
            along, edge = curve(self._source.Edges[index]), TopoDS_Edge()
            _BUILDER.MakeEdge(edge, along, self._tolerance)
            first, last = self._trims.edge_vertices[index]
            _BUILDER.Add(edge, self._vertex(first))
            _BUILDER.Add(edge, self._vertex(last).Oriented(TopAbs_REVERSED))
            _BUILDER.Range(edge, along.FirstParameter(), along.LastParameter())
            self._edges[index] = edge
        edge = self._edges[index]
        return TopoDS.Edge_s(edge.Oriented(TopAbs_REVERSED)) if turned else edge

    def _point(self, trim: Trim, face: TopoDS_Face, parameters: _Parameters) -> TopoDS_Edge:
        """A side that has shrunk to a point, as an edge without length."""
        edge, vertex = TopoDS_Edge(), self._vertex(trim.vertices[0])
        _BUILDER.MakeEdge(edge)
        first, last = parameters.along_edge(trim, np.array([0.0, 1.0]))
        _BUILDER.UpdateEdge(edge, straight_line(first, last, POINT_RANGE), face, self._tolerance)
        _BUILDER.Add(edge, vertex)
        _BUILDER.Add(edge, vertex.Oriented(TopAbs_REVERSED))
        _BUILDER.Range(edge, *POINT_RANGE)
        _BUILDER.Degenerated(edge, True)
        return edge

    def _vertex(self, index: int) -> TopoDS_Vertex:
        if index not in self._vertices:
            point, vertex = self._source.Vertices[index].Location, TopoDS_Vertex()
            _BUILDER.MakeVertex(vertex, gp_Pnt(point.X, point.Y, point.Z), self._tolerance)
            self._vertices[index] = vertex
        return self._vertices[index]


class _Parameters:
    """The parameters of a surface, of which its NURBS form may have others."""

    def __init__(self, given: RhinoObject) -> None:
        self._given = given
        spans = [given.Domain(axis) for axis in (0, 1)]
        grid = np.stack(np.meshgrid(*(span.T0 + PROBED * (span.T1 - span.T0) for span in spans)), axis=-1).reshape(
            -1, 2
        )
        sizes = np.array([span.T1 - span.T0 for span in spans])
        self._alike = bool(np.abs((self._of_nurbs(grid) - grid) / sizes).max() <= ALIKE)

    def along_edge(self, trim: Trim, parts: Array) -> Array:
        """(k, 2) parameters of the NURBS form at (k,) parts of a trim's edge, or of the trim where it has none."""
        places = trim.at(1.0 - parts if trim.against_edge and trim.edge >= 0 else parts)
        return places if self._alike else self._of_nurbs(places)

    def spline(self, trim: Trim, edge: Geom_BSplineCurve) -> Geom2d_BSplineCurve | None:
        """A trim as a spline over its edge's range; None where it is only a part of one, or the pace is another."""
        domain = trim.curve.Domain
        if not self._alike or trim.domain != (domain.T0, domain.T1):
            return None
        found = cast(Geom2d_BSplineCurve, GeomAPI.To2d_s(curve(trim.curve), gp_Pln()))
        if trim.backwards != trim.against_edge:
            found.Reverse()
        knots, first, last = numbers(found.Knots()), edge.FirstParameter(), edge.LastParameter()
        parts = (knots - knots[0]) / (knots[-1] - knots[0])
        found.SetKnots(real_array(first + parts * (last - first)))
        return found

    def _of_nurbs(self, places: Array) -> Array:
        found = [self._given.GetNurbsFormParameterFromSurfaceParameter(u, v) for u, v in places.tolist()]
        if not all(known for known, _, _ in found):
            raise ConversionError("its surface has no NURBS form of its own parameters")
        return np.array([(u, v) for _, u, v in found])


def _sides(trims: list[Trim]) -> list[Trim]:
    """The one trim of an edge in a loop, or the two, that along the edge first.

    Raises:
        ConversionError: there are more, or both run the same way.
    """
    found = sorted(trims, key=lambda trim: trim.against_edge)
    ways = [trim.against_edge for trim in found]
    if len(found) > BOTH_SIDES or ways in ([False, False], [True, True]):
        raise ConversionError("one edge bounds it more than once on the same side")
    return found
