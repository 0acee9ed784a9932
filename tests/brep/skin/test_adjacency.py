"""How much faces fold where they touch does not depend on their outlines: holes, notches and plain edges are alike."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace, BRepBuilderAPI_MakePolygon
from OCP.gp import gp_Pnt
from OCP.TopoDS import TopoDS

from cadpanel.brep.files.model import Label, ModelFace
from cadpanel.brep.skin.adjacency import contacts_of, surfaces_of
from cadpanel.brep.skin.face_cleanup import measure

# Plates in the plane z = 0, each a closed line and one that goes round a hole, if any; all have an edge along x, from
# 1000 to 3000 at y = 1000, on whose far side (y > 1000) there is nothing of the plate near the edge.
PLATES = {
    "plain": ([(1000, 0), (3000, 0), (3000, 1000), (1000, 1000)], ()),
    "hole": ([(0, 0), (4000, 0), (4000, 5000), (0, 5000)], [(1000, 1000), (1000, 4000), (3000, 4000), (3000, 1000)]),
    "small hole": ([(0, -9000), (9000, -9000), (9000, 5000), (0, 5000)],
                   [(1000, 1000), (1000, 4000), (3000, 4000), (3000, 1000)]),
    "notch": ([(0, 0), (3000, 0), (3000, 1000), (1000, 1000), (1000, 9000), (0, 9000)], ()),
    "slot": ([(0, 0), (4000, 0), (4000, 6000), (3000, 6000), (3000, 1000), (1000, 1000), (1000, 6000), (0, 6000)], ()),
}  # fmt: skip


def face(number, outer, hole=(), reversed_=False):
    def wire(corners):
        polygon = BRepBuilderAPI_MakePolygon()
        for corner in corners:
            polygon.Add(gp_Pnt(*map(float, corner)))
        polygon.Close()
        return polygon.Wire()

    maker = BRepBuilderAPI_MakeFace(wire(outer), True)
    if len(hole):
        maker.Add(wire(hole))
    made = TopoDS.Face_s(maker.Face().Reversed()) if reversed_ else maker.Face()
    return measure(
        ModelFace(number=number, part=0, panel="", label=Label(), names=(), face=made, of_solid=False), "roof.step"
    )


@pytest.mark.parametrize("plate", PLATES)
@given(fold=st.floats(0.0, 179.0), turned=st.tuples(st.booleans(), st.booleans()), seed=st.integers(0, 99))
@settings(max_examples=12, deadline=None)
def test_a_flap_at_any_edge_folds_by_its_angle(plate, fold, turned, seed):
    rotation, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    rotation *= np.linalg.det(rotation)
    y, z = 1000.0 + 500.0 * np.cos(np.radians(fold)), 500.0 * np.sin(np.radians(fold))
    flap = [(1000.0, 1000.0, 0.0), (3000.0, 1000.0, 0.0), (3000.0, y, z), (1000.0, y, z)]

    def placed(corners):
        return np.array([(*corner, 0.0)[:3] for corner in corners]) @ rotation.T

    outer, hole = PLATES[plate]
    faces = (
        face(1, placed(outer), placed(hole) if hole else (), turned[0]),
        face(2, placed(flap), reversed_=turned[1]),
    )
    contacts = contacts_of(faces, 0.1)
    # The flap of a plate's slot also touches both its sides as it lies flat.
    folds = [contact.fold for contact in contacts if abs(contact.point @ rotation[:, 1] - 1000.0) < 1.0]
    assert folds
    assert folds == pytest.approx([fold] * len(folds), abs=1e-3)


@pytest.mark.parametrize("plate", ["hole", "small hole", "notch", "slot"])
@pytest.mark.parametrize("turned", [(False, False), (True, False), (False, True)])
def test_what_fills_a_plate_makes_one_surface_with_it(plate, turned):
    outer, hole = PLATES[plate]
    filler = [(1000, 1000, 0), (3000, 1000, 0), (3000, 4000, 0), (1000, 4000, 0)]
    if plate == "notch":
        filler = [(1000, 1000, 0), (3000, 1000, 0), (3000, 9000, 0), (1000, 9000, 0)]
    flat = [(*corner, 0) for corner in outer]
    faces = (face(1, flat, [(*corner, 0) for corner in hole], turned[0]), face(2, filler, reversed_=turned[1]))
    surfaces, notes = surfaces_of(faces, "roof.step", 1.0)
    assert len(surfaces) == 1
    assert not notes
