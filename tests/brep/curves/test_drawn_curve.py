"""Cuts follow what was drawn: corners, waves, closed curves, layers and seams."""

import numpy as np
import pytest
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeFace
from OCP.BRepPrimAPI import BRepPrimAPI_MakeCylinder, BRepPrimAPI_MakePrism, BRepPrimAPI_MakeSphere
from OCP.Geom import Geom_BSplineCurve
from OCP.gp import gp_Ax2, gp_Circ, gp_Dir, gp_Pln, gp_Pnt, gp_Vec
from OCP.TColgp import TColgp_Array1OfPnt
from OCP.TColStd import TColStd_Array1OfInteger, TColStd_Array1OfReal
from OCP.TopAbs import TopAbs_FACE

from cadpanel.brep.curves import pcurve_fit
from cadpanel.brep.curves.drawn_curve import sampled
from cadpanel.brep.curves.projection import land_curves
from cadpanel.brep.cutting.by_network import cut_network
from cadpanel.brep.cutting.raw_panels import raw_panels
from cadpanel.brep.faces.area import enclosed
from cadpanel.brep.files.face_choice import select_faces
from cadpanel.brep.files.model import Label, Model, ModelCurve, Part
from cadpanel.brep.kernel.shapes import compound_of, shapes_of
from cadpanel.brep.kernel.tolerances import CLOSE
from cadpanel.brep.read import read_raw_panels, read_reference
from cadpanel.brep.skin.adjacency import surfaces_of
from cadpanel.brep.skin.face_cleanup import skin_faces
from cadpanel.brep.splitting.splitter import area_of
from cadpanel.errors import PanelError, ReferenceFileError
from cadpanel.geometry.polyline import distances_to_polylines
from cadpanel.reference.settings import ReferenceSettings
from tests.model_files import write_shape

LENGTH, WIDTH = 6000.0, 2000.0
SAME_AREA = 1e-6  # part of the area
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


@pytest.mark.parametrize(
    "corners",
    [
        [(3000, 0), (3000, 1000), (4500, 1000), (4500, 2000)],
        [(3000, 0), (3000, 1003), (3360, 2000)],
        [(3000, 0), (3000, 1000), (3001, 2000)],
    ],
    ids=["L", "20 degrees", "a hair"],
)
def test_cut_along_a_polyline_keeps_its_corners(tmp_path, corners):
    drawn = np.array([(*corner, 0.0) for corner in corners], dtype=float)
    edge = polyline(*drawn)
    left = 0.5 * float(np.sum((drawn[1:, 0] + drawn[:-1, 0]) * np.diff(drawn[:, 1])))
    assert areas(cut([plate()], [edge])) == pytest.approx(sorted([left, LENGTH * WIDTH - left]), rel=SAME_AREA)
    points = cut_points(raw(tmp_path, plate(), [edge]).panels)
    assert distances_to_polylines(points[None], drawn[None]).max() <= CLOSE
    for corner in drawn[1:-1]:
        assert np.linalg.norm(points - corner, axis=1).min() <= CLOSE


@pytest.mark.parametrize("periods", [1, 10, 40])
def test_cut_along_a_wave_keeps_to_it(tmp_path, periods):
    half = 0.5 * LENGTH * WIDTH
    assert areas(cut([plate()], [wave(periods)])) == pytest.approx([half, half], rel=SAME_AREA)
    edge = wave(periods)
    points = cut_points(raw(tmp_path, plate(), [edge]).panels)
    (curve,) = sampled([ModelCurve(label=Label(), edge=edge)], "lines", np.zeros(3))
    # The drawn curve goes evenly in y, so that its parameter is known.
    t = points[:, 1] / WIDTH
    (x, before, after) = (curve.pieces[0].at(t + step)[:, 0] for step in (0.0, -1e-6, 1e-6))
    slope = (after - before) / (2e-6 * WIDTH)
    assert (np.abs(points[:, 0] - x) / np.hypot(1.0, slope)).max() <= CLOSE
    assert np.ptp(points[:, 0]) == pytest.approx(2.0 * WAVE, rel=0.02)


def test_smooth_curve_is_one_edge_with_few_points():
    (piece,) = sampled([ModelCurve(label=Label(), edge=wave(1))], "lines", np.zeros(3))[0].pieces
    assert len(piece.points) <= 300


def test_curve_lands_on_the_nearer_of_two_layers_and_on_both_from_midway(tmp_path):
    layers = compound_of([plate(), plate(50.0)])
    for height, names in ((50.0, 3), (48.0, 3), (25.2, 4)):
        found = raw(tmp_path, layers, [line((3000, 0, height), (3000, WIDTH, height))])
        assert len(found.panels) == names
        notes = [note for note in found.notes if "mm off" in note]
        assert len(notes) == (height != 50.0)
        assert all(f"off the surface of face {1 if height == 25.2 else 2} " in note for note in notes)


def test_closed_curve_cuts_out_a_panel_and_what_is_left_is_refused_for_its_hole(tmp_path):
    panels = cut([plate()], [circle((3000.0, 1000.0, 0.0), 500.0)])
    disc = np.pi * 500.0**2
    assert areas(panels) == pytest.approx([disc, LENGTH * WIDTH - disc], rel=SAME_AREA)
    square = [(2500, 500, 0), (3500, 500, 0), (3500, 1500, 0), (2500, 1500, 0), (2500, 500, 0)]
    raw(tmp_path, plate(), [polyline(*square)])
    settings = ReferenceSettings(unit="mm", network=tmp_path / "lines.brep")
    with pytest.raises(PanelError, match=r"Panel 'S1-\d\d': .* outline has 2 loops .* close its holes"):
        read_reference(tmp_path / "skin.brep", settings)


def tube():
    return max(shapes_of(BRepPrimAPI_MakeCylinder(500.0, 3000.0).Shape(), TopAbs_FACE), key=area_of)


def generator(angle):
    x, y = 500.0 * np.cos(angle), 500.0 * np.sin(angle)
    return line((x, y, -5.0), (x, y, 3005.0))


@pytest.mark.parametrize(
    ("heights", "angles", "count"),
    [
        ((1000.0, 2000.0), (0.5, 2.5, 4.5), 9),
        ((1500.0,), (0.0, 2.0, 4.0), 6),
        ((), (0.5, 2.5, 4.5), 3),
        ((), (0.0, 2.0), 2),
    ],
)
def test_circles_and_generators_cut_a_whole_cylinder(tmp_path, heights, angles, count):
    curves = [*(circle((0.0, 0.0, z), 500.0) for z in heights), *map(generator, angles)]
    found = raw(tmp_path, tube(), curves)
    assert len(found.panels) == count
    turns = np.diff([*angles, angles[0] + 2.0 * np.pi])
    bands = np.diff([0.0, *heights, 3000.0])
    wanted = sorted(500.0 * turn * band for turn in turns for band in bands)
    weights = sorted(sum(face.weights.sum() for face in panel.faces) for panel in found.panels)
    assert weights == pytest.approx(wanted, rel=1e-4)
    reference = read_reference(tmp_path / "skin.brep", ReferenceSettings(unit="mm", network=tmp_path / "lines.brep"))
    assert len(reference.panels) == count


def test_great_circles_cut_a_whole_sphere_into_octants(tmp_path):
    sphere = max(shapes_of(BRepPrimAPI_MakeSphere(500.0).Shape(), TopAbs_FACE), key=area_of)
    circles = [
        BRepBuilderAPI_MakeEdge(gp_Circ(gp_Ax2(gp_Pnt(0.0, 0.0, 0.0), gp_Dir(*axis)), 500.0)).Edge()
        for axis in ((0.0, 0.0, 1.0), (1.0, 0.2, 0.0), (-0.2, 1.0, 0.0))
    ]
    panels = raw(tmp_path, sphere, circles).panels
    weights = [sum(face.weights.sum() for face in panel.faces) for panel in panels]
    assert weights == pytest.approx(8 * [0.5 * np.pi * 500.0**2], rel=1e-3)


def test_curve_that_runs_on_beyond_the_joint_of_two_faces_parts_them(tmp_path):
    halves = [
        BRepBuilderAPI_MakeFace(gp_Pln(), low, high, 0.0, WIDTH).Face()
        for low, high in ((0.0, 0.5 * LENGTH), (0.5 * LENGTH, LENGTH))
    ]
    joint = line((3000, -50, 0), (3000, WIDTH + 50, 0))
    assert len(raw(tmp_path, compound_of(halves), [joint]).panels) == 2


@pytest.mark.parametrize(
    ("places", "panels"), [((0.3,), 1), ((LENGTH - 0.3, 0.5 * LENGTH), 2), ((500.0, 500.3), 2)], ids=str
)
def test_curve_that_runs_close_beside_another_one_or_the_outline_reaches_it(tmp_path, places, panels):
    found = raw(tmp_path, plate(), [line((x, 0, 0), (x, WIDTH, 0)) for x in places]).panels
    assert len(found) == panels
    assert sum(face.weights.sum() for panel in found for face in panel.faces) == pytest.approx(LENGTH * WIDTH)


def test_curve_that_leaves_a_sliver_is_named(tmp_path):
    with pytest.raises(ReferenceFileError, match=r"Curve \d of 'lines.brep' leaves a panel only 0.8 mm wide near"):
        raw(tmp_path, plate(), [line((x, 0, 0), (x, WIDTH, 0)) for x in (500.0, 500.8)])


def test_curve_that_cannot_be_followed_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(pcurve_fit, "ROUNDS", 0)
    skin = write_shape(tmp_path / "skin.brep", plate())
    lines = write_shape(tmp_path / "lines.brep", wave(1))
    with pytest.raises(ReferenceFileError, match=r"Curve 1 of 'lines.brep' cannot be followed .* on face 1: draw it"):
        raw_panels(skin, ReferenceSettings(unit="mm", network=lines))


def test_curve_over_a_valley_that_it_jumps_stays_in_one_piece(tmp_path):
    valley = BRepPrimAPI_MakePrism(polyline((-1000, 0, 20), (0, 0, 0), (1000, 0, 20)), gp_Vec(0, 2000, 0)).Shape()
    assert len(raw(tmp_path, valley, [line((-1100, 900, 20), (1100, 1100, 20))]).panels) == 2
