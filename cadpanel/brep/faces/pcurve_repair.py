"""Faces whose borders run beside their own edges in the parameter plane, mended.

Some readers and the kernel's own projection lay a border's parameter curve up to a millimetre off its curve in space
and write that down as the edge's tolerance. Areas, samples and cuts all follow the parameter curve.
"""

from __future__ import annotations

import numpy as np
from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve, BRepAdaptor_Curve2d
from OCP.BRepLib import BRepLib
from OCP.BRepTools import BRepTools
from OCP.Geom import Geom_Surface
from OCP.Geom2d import Geom2d_Curve
from OCP.GeomAbs import GeomAbs_Line
from OCP.GeomProjLib import GeomProjLib
from OCP.gp import gp_Pnt
from OCP.ShapeFix import ShapeFix_ShapeTolerance
from OCP.TopAbs import TopAbs_EDGE
from OCP.TopoDS import TopoDS_Edge, TopoDS_Face

from cadpanel.brep.kernel.points import TOLERANCE
from cadpanel.brep.kernel.shapes import edges_of

# An edge whose tolerance or whose parameter curve's distance is larger has that curve laid anew, mm.
COARSE = 1e-3
# How closely the new one is asked to follow the edge, mm; the kernel stays within some ten times that.
FINE = 1e-5
# A curve that lies farther off another one than this part of the face's range is no better place for the same border.
ELSEWHERE = 0.25
# Points of an edge at which that is looked at.
CHECKED_POINTS = 65


def sharpen_trims(face: TopoDS_Face) -> None:
    """Lay the parameter curves of a face's coarse edges anew where that brings them nearer, in place."""
    for edge in edges_of(face):
        if not (BRep_Tool.Degenerated_s(edge) or BRep_Tool.IsClosed_s(edge, face)):
            _sharpen(edge, face)


def _sharpen(edge: TopoDS_Edge, face: TopoDS_Face) -> None:
    own, tolerant = BRepAdaptor_Curve2d(edge, face), BRep_Tool.Tolerance_s(edge) > COARSE
    if own.GetType() == GeomAbs_Line and not tolerant:
        return
    adaptor = BRepAdaptor_Curve(edge)
    first, last = adaptor.FirstParameter(), adaptor.LastParameter()
    curve, surface = BRep_Tool.Curve_s(edge, first, last), BRep_Tool.Surface_s(face)
    if curve is None:
        return
    places = np.linspace(first, last, CHECKED_POINTS).tolist()
    drawn = [curve.Value(place) for place in places]
    off = _beside(surface, own, places, drawn)
    # The kernel's tolerance may promise more than is true, or be that of another face.
    if off > COARSE:
        fine = GeomProjLib.Curve2d_s(curve, first, last, surface, FINE)
        if fine is None or _is_elsewhere(face, own, fine, places) or _beside(surface, fine, places, drawn) > off:
            return
        BRep_Builder().UpdateEdge(edge, fine, face, FINE)
    elif not tolerant:
        return
    # A tolerance only ever grows: taken back to the least, it grows to what the curves on all faces need.
    ShapeFix_ShapeTolerance().SetTolerance(edge, TOLERANCE, TopAbs_EDGE)
    BRep_Builder().SameParameter(edge, False)
    BRepLib.SameParameter_s(edge, TOLERANCE)


def _is_elsewhere(face: TopoDS_Face, own: BRepAdaptor_Curve2d, fine: Geom2d_Curve, places: list[float]) -> bool:
    """Whether a new curve passes by the other side of a seam, where the surface has the same points."""
    spans = np.ptp(np.array(BRepTools.UVBounds_s(face)).reshape(2, 2), axis=1)
    away = np.array([np.subtract(fine.Value(place).Coord(), own.Value(place).Coord()) for place in places])
    return bool((np.abs(away) > ELSEWHERE * spans).any())


def _beside(
    surface: Geom_Surface, curve: Geom2d_Curve | BRepAdaptor_Curve2d, places: list[float], drawn: list[gp_Pnt]
) -> float:
    """How far a curve of the parameter plane runs beside points in space at the same parameters at most, mm."""
    on_surface = (surface.Value(*curve.Value(place).Coord()) for place in places)
    return max(float(point.Distance(other)) for point, other in zip(drawn, on_surface, strict=True))
