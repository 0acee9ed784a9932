"""Rings whose faces share no parameter, as a stadium's roof edge is drawn: a flat flange with a hole, a bend."""

import numpy as np
import pytest
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeWire, BRepBuilderAPI_Transform
from OCP.BRepPrimAPI import BRepPrimAPI_MakeRevol
from OCP.GC import GC_MakeArcOfCircle, GC_MakeSegment
from OCP.gp import gp_Ax1, gp_Dir, gp_Pnt, gp_Trsf

from cadpanel.brep.kernel.shapes import compound_of, faces_of
from cadpanel.brep.read import read_reference
from cadpanel.errors import CadpanelError
from cadpanel.reference.settings import ReferenceSettings
from tests.model_files import write_shape

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
RINGS = {"whole turns": (1.0,), "halves": (0.5, 0.5), "uneven": (0.3, 0.45, 0.25)}


def cut(folder, turns, **how):
    path = write_shape(folder / "edge.brep", compound_of(roof_edge(turns)))
    return read_reference(path, ReferenceSettings(unit="mm", **how))


def assert_round(reference, count, area, rel):
    areas = np.array([panel.weights.sum() for panel in reference.panels])
    assert [panel.name for panel in reference.panels] == [f"S1-{place:02}" for place in range(1, count + 1)]
    np.testing.assert_allclose(areas, area / count, rtol=rel)
    assert len(reference.seams) == count if count > 2 else reference.seams
    assert {len(panel.edges) for panel in reference.panels} == {4}


@pytest.mark.parametrize("turns", RINGS)
@pytest.mark.parametrize("count", [3, 8, 17])
def test_ring_of_flange_bend_and_fascia_is_divided_round(tmp_path, turns, count):
    assert_round(cut(tmp_path, RINGS[turns], divide=count), count, WHOLE, 2e-3)


@pytest.mark.parametrize("turns", ["whole turns", "halves"])
@pytest.mark.parametrize("width", [300.0, 900.0])
def test_band_about_the_bend_of_a_ring_is_divided_round(tmp_path, turns, width):
    assert_round(cut(tmp_path, RINGS[turns], divide=12, lip=width), 12, band_area(width), 1e-2)


def test_ring_is_not_one_panel(tmp_path):
    with pytest.raises(CadpanelError, match="closes to a ring, and a panel cannot go round: divide it into 2 or more"):
        cut(tmp_path, (1.0,), divide=1)
