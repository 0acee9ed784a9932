"""Rhino files and what is put in them; tests that need them are skipped where rhino3dm is not installed."""

import numpy as np
import pytest
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve, BRepAdaptor_Curve2d, BRepAdaptor_Surface
from OCP.TopAbs import TopAbs_EDGE
from OCP.TopoDS import TopoDS

from cadpanel.brep.kernel.shapes import shapes_of

rhino = pytest.importorskip("rhino3dm")


def file_in(unit="Millimeters"):
    file = rhino.File3dm()
    file.Settings.ModelUnitSystem = getattr(rhino.UnitSystem, unit)
    return file


def written(path, file):
    assert file.Write(str(path), 8)
    return path


def bent_surface(length=9000.0, rational=False):
    """A surface of degree 3 x 1 over a bent section."""
    surface = rhino.NurbsSurface.Create(3, rational, 4, 2, 5, 2)
    for place, knot in enumerate((0.0, 0.0, 0.0, 0.4, 1.0, 1.0, 1.0)):
        surface.KnotsU[place] = knot
    for place, knot in enumerate((0.0, 1.0)):
        surface.KnotsV[place] = knot
    section = ((0.0, 0.0), (500.0, 0.0), (800.0, -100.0), (900.0, -500.0), (900.0, -900.0))
    for i, (y, z) in enumerate(section):
        for j, x in enumerate((0.0, length)):
            weight = 0.8 if rational and i == 2 else 1.0
            surface.Points[i, j] = rhino.Point4d(weight * x, weight * y, weight * z, weight)
    return surface


def off_border(face):
    """How far the borders of a face run beside their curves in space at most, mm."""
    surface = BRepAdaptor_Surface(face)
    off = [0.0]
    for edge in map(TopoDS.Edge_s, shapes_of(face, TopAbs_EDGE)):
        if not BRep_Tool.Degenerated_s(edge):
            drawn, flat = BRepAdaptor_Curve(edge), BRepAdaptor_Curve2d(edge, face)
            places = np.linspace(drawn.FirstParameter(), drawn.LastParameter(), 301).tolist()
            off += [drawn.Value(at).Distance(surface.Value(*flat.Value(at).Coord())) for at in places]
    return max(off)
