"""Rings of any faces: planes across them at equal lengths, square to both closed edges, and what is no ring."""

import numpy as np
import pytest
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeFace, BRepBuilderAPI_MakeWire
from OCP.gp import gp_Ax2, gp_Circ, gp_Dir, gp_Pln, gp_Pnt
from OCP.TopoDS import TopoDS

from cadpanel.brep.skin.belt import find_belt
from tests.cuts import surface_of
from tests.round_roofs import BEND, FLANGE, RADIUS, roof_edge

UP = gp_Dir(0.0, 0.0, 1.0)
TURN = 2.0 * np.pi


def washer(outer, inner):
    """A flat disc with a round hole."""
    wires = [
        BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(gp_Circ(gp_Ax2(gp_Pnt(), UP), radius)).Edge()).Wire()
        for radius in (outer, inner)
    ]
    making = BRepBuilderAPI_MakeFace(gp_Pln(gp_Pnt(), UP), wires[0], True)
    making.Add(TopoDS.Wire_s(wires[1].Reversed()))
    return making.Face()


def angles(points):
    return np.mod(np.arctan2(points[:, 1], points[:, 0]), TURN)


@pytest.mark.parametrize("count", [5, 12])
@pytest.mark.parametrize("start", [0.0, 1.3, 4.0])
def test_planes_lie_at_equal_lengths_from_a_place_on_and_square_to_the_ring(count, start):
    belt = find_belt(surface_of(*roof_edge()), "edge.step", 1.0)
    assert belt is not None
    assert belt.length == pytest.approx(TURN * 0.5 * (RADIUS + RADIUS - BEND - FLANGE), rel=1e-4)
    cuts = belt.cuts(count, start)
    wanted = np.mod((np.ceil(start) + np.arange(count)) / count, 1.0) * TURN
    away = np.mod(angles(cuts.origins) - wanted + np.pi, TURN) - np.pi
    assert np.abs(away).max() < 1e-5
    tangents = np.stack([-np.sin(wanted), np.cos(wanted), 0.0 * wanted], axis=1)
    np.testing.assert_allclose(cuts.normals, tangents, atol=1e-4)
    assert (np.diff(cuts.places) > 0.0).all()


@pytest.mark.parametrize(("inner", "is_ring"), [(1700.0, True), (1200.0, True), (300.0, False)])
def test_a_plate_with_a_small_hole_is_no_ring(inner, is_ring):
    assert (find_belt(surface_of(washer(2000.0, inner)), "plate.step", 1.0) is not None) == is_ring


def test_what_has_one_edge_is_no_ring():
    face = BRepBuilderAPI_MakeFace(gp_Pln(gp_Pnt(), UP), 0.0, 100.0, 0.0, 300.0).Face()
    assert find_belt(surface_of(face), "plate.step", 1.0) is None
