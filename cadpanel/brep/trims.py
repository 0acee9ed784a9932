"""Faces whose borders run beside their own edges in the parameter plane, mended.

Some readers and the kernel's own projection lay a border's parameter curve up to a millimetre off its curve in space
and write that down as the edge's tolerance. Areas, samples and cuts all follow the parameter curve.
"""

from __future__ import annotations

from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve
from OCP.BRepLib import BRepLib
from OCP.GeomProjLib import GeomProjLib
from OCP.ShapeFix import ShapeFix_ShapeTolerance
from OCP.TopAbs import TopAbs_EDGE
from OCP.TopoDS import TopoDS, TopoDS_Edge, TopoDS_Face

from cadpanel.brep.kernel import TOLERANCE
from cadpanel.brep.model import shapes_of

# An edge whose tolerance is larger has its parameter curve laid anew, mm.
COARSE = 1e-3
# How closely the new one follows the edge, mm.
FINE = 1e-4


def sharpen_trims(face: TopoDS_Face) -> None:
    """Lay the parameter curves of a face's coarse edges anew where that brings them nearer, in place."""
    for shape in shapes_of(face, TopAbs_EDGE):
        edge = TopoDS.Edge_s(shape)
        free = not (BRep_Tool.Degenerated_s(edge) or BRep_Tool.IsClosed_s(edge, face))
        if free and BRep_Tool.Tolerance_s(edge) > COARSE:
            _sharpen(edge, face)


def _sharpen(edge: TopoDS_Edge, face: TopoDS_Face) -> None:
    adaptor = BRepAdaptor_Curve(edge)
    first, last = adaptor.FirstParameter(), adaptor.LastParameter()
    curve, surface = BRep_Tool.Curve_s(edge, first, last), BRep_Tool.Surface_s(face)
    if curve is None:
        return
    fine = GeomProjLib.Curve2d_s(curve, first, last, surface, FINE)
    if fine is None:
        return
    BRep_Builder().UpdateEdge(edge, fine, face, FINE)
    # A tolerance only ever grows: taken back to the least, it grows to what the curves on all faces need.
    ShapeFix_ShapeTolerance().SetTolerance(edge, TOLERANCE, TopAbs_EDGE)
    BRep_Builder().SameParameter(edge, False)
    BRepLib.SameParameter_s(edge, TOLERANCE)
