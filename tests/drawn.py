"""A flat plate, curves drawn on it, and the panels that they cut out of it."""

import numpy as np
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeFace
from OCP.Geom import Geom_BSplineCurve
from OCP.GeomAbs import GeomAbs_C2
from OCP.GeomAPI import GeomAPI_PointsToBSpline
from OCP.gp import gp_Ax2, gp_Circ, gp_Dir, gp_Pln, gp_Pnt
from OCP.TColgp import TColgp_Array1OfPnt
from OCP.TColStd import TColStd_Array1OfInteger, TColStd_Array1OfReal

from cadpanel.brep.curves.drawn_curve import sampled
from cadpanel.brep.curves.projection import land_curves
from cadpanel.brep.cutting.by_network import cut_network
from cadpanel.brep.faces.area import enclosed
from cadpanel.brep.files.face_choice import select_faces
from cadpanel.brep.files.model import Label, Model, ModelCurve, Part
from cadpanel.brep.kernel.shapes import compound_of
from cadpanel.brep.read import read_raw_panels
from cadpanel.brep.skin.adjacency import surfaces_of
from cadpanel.brep.skin.face_cleanup import skin_faces
from cadpanel.reference.settings import ReferenceSettings
from tests.model_files import write_shape

POINTS = 41
LENGTH, WIDTH = 6000.0, 2000.0
WAVE = 100.0


def plate(z=0.0):
    return BRepBuilderAPI_MakeFace(gp_Pln(gp_Pnt(0.0, 0.0, z), gp_Dir(0.0, 0.0, 1.0)), 0.0, LENGTH, 0.0, WIDTH).Face()


def polyline(*corners):
    poles, count = TColgp_Array1OfPnt(1, len(corners)), len(corners)
    knots, multiplicities = TColStd_Array1OfReal(1, count), TColStd_Array1OfInteger(1, count)
    for place, corner in enumerate(corners, start=1):
        poles.SetValue(place, gp_Pnt(*map(float, corner)))
        knots.SetValue(place, float(place))
        multiplicities.SetValue(place, 2 if place in (1, count) else 1)
    return BRepBuilderAPI_MakeEdge(Geom_BSplineCurve(poles, knots, multiplicities, 1)).Edge()


def line(first, last):
    return BRepBuilderAPI_MakeEdge(gp_Pnt(*map(float, first)), gp_Pnt(*map(float, last))).Edge()


def circle(center, radius):
    return BRepBuilderAPI_MakeEdge(gp_Circ(gp_Ax2(gp_Pnt(*center), gp_Dir(0.0, 0.0, 1.0)), radius)).Edge()


def wave(periods):
    """A cubic spline with the places and slopes of a sine, across the plate."""
    t = np.linspace(0.0, 1.0, 16 * periods + 1)
    x = 0.5 * LENGTH + WAVE * np.sin(2.0 * np.pi * periods * t)
    slope = 2.0 * np.pi * periods * WAVE * np.cos(2.0 * np.pi * periods * t)
    places, step = np.stack([x, WIDTH * t], axis=1), t[1] / 3.0
    ways = np.stack([slope, np.full(len(t), WIDTH)], axis=1) * step
    inner = np.stack([places[:-1] + ways[:-1], places[1:] - ways[1:]], axis=1).reshape(-1, 2)
    poles = np.concatenate([places[:1], inner, places[-1:]])
    array = TColgp_Array1OfPnt(1, len(poles))
    for place, (px, py) in enumerate(poles.tolist(), start=1):
        array.SetValue(place, gp_Pnt(px, py, 0.0))
    knots, multiplicities = TColStd_Array1OfReal(1, len(t)), TColStd_Array1OfInteger(1, len(t))
    for place, value in enumerate(t.tolist(), start=1):
        knots.SetValue(place, value)
        multiplicities.SetValue(place, 4 if place in (1, len(t)) else 2)
    return BRepBuilderAPI_MakeEdge(Geom_BSplineCurve(array, knots, multiplicities, 3)).Edge()


def cut(faces, curves):
    """The panels that curves cut from faces, and how far they lie off."""
    part = Part(label=Label(), shape=compound_of(faces), face_labels=(Label(),) * len(faces))
    model = Model(source="skin", format="STEP", unit="millimetre", parts=(part,))
    skin, _ = skin_faces(select_faces(model, None), "skin", 1.0)
    surfaces, _ = surfaces_of(skin, "skin", 1.0)
    drawn = sampled([ModelCurve(label=Label(), edge=edge) for edge in curves], "lines", np.zeros(3))
    landings = land_curves(surfaces, drawn, 1.0, "lines")
    panels = [
        cut_network(surface, drawn, landing, "skin", "lines", "draw it on", 1.0)
        for surface, landing in zip(surfaces, landings, strict=True)
    ]
    return [panel for own in panels for panel in own]


def areas(panels):
    """What the panels enclose; the plate's parameters are millimetres."""
    return sorted(sum(abs(enclosed(face)) for face in panel.faces) for panel in panels)


def raw(tmp_path, shape, curves, **how):
    skin = write_shape(tmp_path / "skin.brep", shape)
    lines = write_shape(tmp_path / "lines.brep", compound_of(curves))
    return read_raw_panels(skin, ReferenceSettings(unit="mm", network=lines, **how))


def cut_points(panels):
    """Points along the panels' edges that are not on the plate's outline."""
    edges = [edge for panel in panels for face in panel.faces for edge in face.edges]
    inner = [edge[(edge[:, 1] > 1.0) & (edge[:, 1] < WIDTH - 1.0) & (edge[:, 0] > 1.0)] for edge in edges]
    return np.concatenate([edge[edge[:, 0] < LENGTH - 1.0] for edge in inner])


def curve(points):
    array = TColgp_Array1OfPnt(1, len(points))
    for index, point in enumerate(points.tolist(), start=1):
        array.SetValue(index, gp_Pnt(*point))
    return BRepBuilderAPI_MakeEdge(GeomAPI_PointsToBSpline(array, 3, 8, GeomAbs_C2, 1e-4).Curve()).Edge()
