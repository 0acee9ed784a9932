"""The edge of a round roof as it is drawn: a flat flange with a hole, a quarter bend, a fascia, each turned round."""

import numpy as np
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeWire, BRepBuilderAPI_Transform
from OCP.BRepPrimAPI import BRepPrimAPI_MakeRevol
from OCP.GC import GC_MakeArcOfCircle, GC_MakeSegment
from OCP.gp import gp_Ax1, gp_Dir, gp_Pnt, gp_Trsf

from cadpanel.brep.kernel.shapes import faces_of

RADIUS, BEND, FLANGE, FASCIA = 9000.0, 300.0, 700.0, 600.0
AXIS = gp_Ax1(gp_Pnt(0.0, 0.0, 0.0), gp_Dir(0.0, 0.0, 1.0))


def roof_edge(turns=(1.0,)):
    """The faces of a flat flange, a quarter bend and a fascia, each turned so far round as a part of a whole turn."""
    inner, top = gp_Pnt(RADIUS - BEND - FLANGE, 0.0, 0.0), gp_Pnt(RADIUS - BEND, 0.0, 0.0)
    c = BEND * np.sqrt(0.5)
    middle = gp_Pnt(RADIUS - BEND + c, 0.0, c - BEND)
    side, foot = gp_Pnt(RADIUS, 0.0, -BEND), gp_Pnt(RADIUS, 0.0, -BEND - FASCIA)
    curves = (GC_MakeSegment(inner, top), GC_MakeArcOfCircle(top, middle, side), GC_MakeSegment(side, foot))
    faces, start = [], 0.0
    for turn in turns:
        wire = BRepBuilderAPI_MakeWire()
        for curve in curves:
            wire.Add(BRepBuilderAPI_MakeEdge(curve.Value()).Edge())
        begun = BRepBuilderAPI_Transform(wire.Wire(), turned_by(start), True).Shape()
        angles = () if turn == 1.0 else (2.0 * np.pi * turn,)
        faces += faces_of(BRepPrimAPI_MakeRevol(begun, AXIS, *angles).Shape())
        start += turn
    return faces


def turned_by(part):
    found = gp_Trsf()
    found.SetRotation(AXIS, 2.0 * np.pi * part)
    return found


def band_area(width):
    """Of the band of a width about the middle of the bend, mm^2 (Pappus), the flange's and fascia's parts included."""
    beyond = 0.5 * (width - 0.5 * np.pi * BEND)
    bend = 2.0 * np.pi * BEND * (0.5 * np.pi * (RADIUS - BEND) + BEND)
    flat = np.pi * beyond * (2.0 * (RADIUS - BEND) - beyond)
    return bend + flat + 2.0 * np.pi * RADIUS * beyond


WHOLE = band_area(2.0 * FASCIA + 0.5 * np.pi * BEND) + np.pi * (
    (RADIUS - BEND - FASCIA) ** 2 - (RADIUS - BEND - FLANGE) ** 2
)
