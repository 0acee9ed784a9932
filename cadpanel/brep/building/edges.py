"""Vertices and edges of a skin: straight generatrices, straight flange ends, arcs of ellipse; and wires of them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from OCP.BRep import BRep_Builder
from OCP.Geom import Geom_BSplineCurve, Geom_Circle, Geom_Curve, Geom_Ellipse, Geom_Line, Geom_Surface
from OCP.Geom2d import Geom2d_Curve
from OCP.gp import gp_Circ, gp_Elips
from OCP.TopAbs import TopAbs_FORWARD, TopAbs_REVERSED
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS, TopoDS_Edge, TopoDS_Face, TopoDS_Shape, TopoDS_Shell, TopoDS_Vertex, TopoDS_Wire

from cadpanel.arrays import Array
from cadpanel.brep.building.interpolation import DEGREE, Interpolant
from cadpanel.brep.kernel import points as kernel
from cadpanel.brep.kernel.splines import pole_array
from cadpanel.geometry.cone_sections import EllipticSection
from cadpanel.geometry.vectors import cross

_BUILDER = BRep_Builder()


def vertex_at(xyz: Array) -> TopoDS_Vertex:
    """A vertex at (3,) mm."""
    vertex = TopoDS_Vertex()
    _BUILDER.MakeVertex(vertex, kernel.point(xyz), kernel.TOLERANCE)
    return vertex


def line_edge(first: TopoDS_Vertex, last: TopoDS_Vertex, start: Array, stop: Array) -> TopoDS_Edge:
    """The straight edge between two vertices at (3,) start and stop, parameter 0 to its length in mm."""
    span = stop - start
    line = Geom_Line(kernel.point(start), kernel.direction(span))
    return _edge(line, first, last, 0.0, float(np.linalg.norm(span)))


def arc_edge(first: TopoDS_Vertex, last: TopoDS_Vertex, section: EllipticSection) -> TopoDS_Edge:
    """The arc of ellipse between two vertices, its parameter that of the section."""
    major = float(np.linalg.norm(section.cosine_axis))
    # A circle's two half axes may come out in the wrong order by a rounding error, which the kernel refuses.
    minor = min(major, float(np.linalg.norm(section.sine_axis)))
    turn = cross(section.cosine_axis / major, section.sine_axis / minor)
    conic = gp_Elips(kernel.conic_frame(section.center, turn, section.cosine_axis / major), major, minor)
    return _edge(Geom_Ellipse(conic), first, last, section.start, section.stop)


def turned_edge(
    first: TopoDS_Vertex, last: TopoDS_Vertex, center: Array, start: Array, turn: Array, sweep: float
) -> TopoDS_Edge:
    """The arc of a circle from (3,) start on, by `sweep` radians about the unit vector `turn` through the center."""
    radius = float(np.linalg.norm(start - center))
    circle = gp_Circ(kernel.conic_frame(center, turn, (start - center) / radius), radius)
    return _edge(Geom_Circle(circle), first, last, 0.0, sweep)


def circle_edge(first: TopoDS_Vertex, last: TopoDS_Vertex, circle: gp_Circ, start: float, stop: float) -> TopoDS_Edge:
    """The arc of a circle between two vertices at the angles start and stop."""
    return _edge(Geom_Circle(circle), first, last, start, stop)


def spline_edge(first: TopoDS_Vertex, last: TopoDS_Vertex, spline: Interpolant) -> TopoDS_Edge:
    """The edge along a spline between two vertices, its parameter the spline's."""
    curve = Geom_BSplineCurve(pole_array(spline.poles), *spline.kernel_knots(), DEGREE)
    start, stop = spline.knots[[0, -1]].tolist()
    return _edge(curve, first, last, start, stop)


def _edge(curve: Geom_Curve, first: TopoDS_Vertex, last: TopoDS_Vertex, start: float, stop: float) -> TopoDS_Edge:
    edge = TopoDS_Edge()
    _BUILDER.MakeEdge(edge, curve, kernel.TOLERANCE)
    _BUILDER.Add(edge, first.Oriented(TopAbs_FORWARD))
    _BUILDER.Add(edge, last.Oriented(TopAbs_REVERSED))
    _BUILDER.Range(edge, start, stop)
    return edge


def lay_on_surface(edge: TopoDS_Edge, curve: Geom2d_Curve, surface: Geom_Surface) -> None:
    """Give the edge its curve in the parameter plane of a cone or cylinder. Planes need none: the kernel derives it."""
    _BUILDER.UpdateEdge(edge, curve, surface, TopLoc_Location(), kernel.TOLERANCE)


def face_on(
    surface: Geom_Surface,
    agrees: bool,
    loop: Sequence[TopoDS_Shape],
    holes: Sequence[Sequence[TopoDS_Shape]] = (),
) -> TopoDS_Face:
    """A face bounded by a loop of oriented edges that runs counterclockwise about the wanted normal.

    `agrees` says whether the surface's own normal is the wanted one; otherwise the face comes out reversed. Loops round
    holes run clockwise.
    """
    face = TopoDS_Face()
    _BUILDER.MakeFace(face, surface, kernel.TOLERANCE)
    for edges in (loop, *holes):
        wire = TopoDS_Wire()
        _BUILDER.MakeWire(wire)
        for edge in edges:
            _BUILDER.Add(wire, edge)
        wire.Closed(True)
        _BUILDER.Add(face, wire if agrees else wire.Reversed())
    return face if agrees else TopoDS.Face_s(face.Reversed())


def shell_of(faces: Sequence[TopoDS_Face]) -> TopoDS_Shell:
    """A shell of faces that already share their edges."""
    shell = TopoDS_Shell()
    _BUILDER.MakeShell(shell)
    for face in faces:
        _BUILDER.Add(shell, face)
    return shell
