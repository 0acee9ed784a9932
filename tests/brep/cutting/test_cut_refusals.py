"""Cuts that leave no panels are refused with the face or panel and a remedy, and the remedy works."""

import math
import time

import numpy as np
import pytest
from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeFace
from OCP.BRepPrimAPI import (
    BRepPrimAPI_MakeCone,
    BRepPrimAPI_MakeCylinder,
    BRepPrimAPI_MakeSphere,
    BRepPrimAPI_MakeTorus,
)
from OCP.gp import gp_Ax2, gp_Circ, gp_Dir, gp_Pln, gp_Pnt
from OCP.TopAbs import TopAbs_FACE

from cadpanel.brep.kernel.shapes import compound_of, shapes_of
from cadpanel.brep.splitting.splitter import area_of
from cadpanel.errors import CadpanelError, OutlineError, PanelError, ReferenceFileError, SettingsError
from tests.cuts import reference_of
from tests.model_files import strip_faces, write_shape
from tests.reference_shapes import Lip
from tests.thorough import cases, thorough

STRAIGHT = Lip(length=9000.0, twist=0.0, taper=0.0)
RADIUS = 700.0


def first_face(shape):
    return shapes_of(shape, TopAbs_FACE)[0]


BALL = first_face(BRepPrimAPI_MakeSphere(RADIUS).Shape())
DOME = first_face(BRepPrimAPI_MakeSphere(RADIUS, 0.0, math.pi / 2).Shape())
HALF_BALL = first_face(BRepPrimAPI_MakeSphere(RADIUS, -math.pi / 2, math.pi / 2, math.pi).Shape())
CONE = first_face(BRepPrimAPI_MakeCone(1000.0, 0.0, 2000.0).Shape())
TUBE = first_face(BRepPrimAPI_MakeCylinder(500.0, 6000.0).Shape())
TORUS = first_face(BRepPrimAPI_MakeTorus(2000.0, 400.0).Shape())
DISC = shapes_of(BRepPrimAPI_MakeCylinder(1000.0, 10.0).Shape(), TopAbs_FACE)[1]
NEEDLE = BRepBuilderAPI_MakeFace(gp_Pln(), 0.0, 4000.0, 0.0, 2.0).Face()
_DRILL = BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(2000.0, 1500.0, -1.0), gp_Dir(0.0, 0.0, 1.0)), 500.0, 2.0).Shape()
HOLED = first_face(BRepAlgoAPI_Cut(BRepBuilderAPI_MakeFace(gp_Pln(), 0.0, 4000.0, 0.0, 3000.0).Face(), _DRILL).Shape())

GRIDS = [
    # The face, a grid that is none, what is said of it, and a grid as the remedy asks for it.
    (BALL, (1, 4), "Face 1 of 'skin.brep' is closed along its parameter u.*: cut it into 3 or more that way", (3, 4)),
    (BALL, (2, 2), "nor half-way round the point to which it shrinks: cut it into 3 or more that way", (3, 2)),
    (BALL, (4, 1), "shrinks to a point at both ends of its parameter v.*: cut it into 2 or more that way", (4, 2)),
    (DOME, (2, 2), "is closed along its parameter u.*: cut it into 3 or more that way", (3, 2)),
    (HALF_BALL, (1, 2), "Panel 'S1-R01-C01'.* 2 corners .*: a grid of 3x3 cuts it", (2, 2)),
    (CONE, (2, 1), "is closed along its parameter u.*: cut it into 3 or more that way", (3, 1)),
    (TUBE, (1, 4), "is closed along its parameter u, and a panel cannot go round it: cut it into 2 or more", (2, 4)),
    (TORUS, (4, 1), "is closed along its parameter v, and a panel cannot go round it: cut it into 2 or more", (4, 2)),
    (DISC, (1, 1), "Panel 'S1-R01-C01'.* 0 corners .*: a grid of 3x3 cuts it", (2, 2)),
    (DISC, (1, 2), "Panel 'S1-R01-C01'.* 2 corners .*: a grid of 3x3 cuts it", (2, 2)),
    (HOLED, (1, 1), "Panel 'S1-R01-C01'.* 2 loops .*: a grid of 3x3 cuts it", (2, 2)),
    (NEEDLE, (4, 2), "would be 1 mm long, and corners closer than 2.5 mm .*: do not cut it that way", None),
]


@pytest.mark.parametrize(("face", "grid", "sentence", "remedy"), cases(GRIDS[::3], GRIDS))
def test_grids_that_leave_no_panels_are_refused_with_a_remedy_that_works(tmp_path, face, grid, sentence, remedy):
    with pytest.raises(CadpanelError, match=sentence):
        reference_of(tmp_path, face, grid=grid)
    if remedy is not None:
        panels = reference_of(tmp_path, face, grid=remedy).panels
        assert len(panels) == remedy[0] * remedy[1]
        assert sum(panel.weights.sum() for panel in panels) == pytest.approx(area_of(face), rel=2e-3)


CROWDED = [
    # How many panels, of which some or all would be shorter than 2.5 mm, and what has room as the remedy asks for it.
    ({"divide": 20_000}, "20000 panels along the surface .* would be 0.45 mm long,.* ask for 3240 or fewer", None),
    ({"divide": 1_000_000}, "ask for 3240 or fewer, or give a smaller seam tolerance", None),
    ({"divide": 20_000, "seam_tolerance": 0.1}, "closer than 1 mm cannot be told apart: ask for 8100 or fewer$", None),
    ({"divide": 900, "seam_tolerance": 20.0}, "ask for 162 or fewer", {"divide": 162, "seam_tolerance": 20.0}),
    ({"grid": (1, 20_000)}, "20000 panels along parameter v of face 1 of .* ask for 3240 or fewer", None),
    ({"grid": (90, 1), "seam_tolerance": 10.0}, "ask for 17 or fewer", {"grid": (16, 1), "seam_tolerance": 10.0}),
]


@pytest.mark.parametrize(("how", "sentence", "remedy"), CROWDED)
def test_more_panels_than_there_is_room_for_are_refused_before_anything_is_cut(tmp_path, how, sentence, remedy):
    began = time.perf_counter()
    with pytest.raises(SettingsError, match=sentence):
        reference_of(tmp_path, *strip_faces(STRAIGHT), **how)
    assert time.perf_counter() - began < 10.0
    if remedy is not None:
        assert reference_of(tmp_path, *strip_faces(STRAIGHT), **remedy).panels


@pytest.mark.parametrize("face", [TORUS, BALL], ids=["torus", "ball"])
def test_more_panels_round_than_there_is_room_for_are_refused_before_anything_is_cut(tmp_path, face):
    with pytest.raises(SettingsError, match=r"100000 panels along .* cannot be told apart: ask for"):
        reference_of(tmp_path, face, grid=(100_000, 3))


def test_a_ring_has_room_for_so_many_panels_and_no_more(tmp_path):
    hoop = first_face(BRepPrimAPI_MakeCylinder(500.0, 300.0).Shape())
    with pytest.raises(SettingsError, match=r"would be 0\.031 mm long,.* ask for 1130 or fewer"):
        reference_of(tmp_path, hoop, divide=100_000)
    assert len(reference_of(tmp_path, hoop, divide=100).seams) == 100


def test_a_needle_is_a_strip_within_a_finer_tolerance(tmp_path):
    with pytest.raises(CadpanelError, match=r"too large for panel 'S1-01', .*: at most 0\.8 mm"):
        reference_of(tmp_path, NEEDLE, divide=4)
    assert len(reference_of(tmp_path, NEEDLE, divide=4, seam_tolerance=0.8).seams) == 3


@pytest.mark.parametrize(
    ("face", "fault"),
    [(TUBE, "2 loops"), *cases([], [(BALL, "closed surface"), (DOME, "0 corners"), (HOLED, "2 loops")])],
)
def test_what_is_no_strip_is_pointed_to_other_ways_to_cut(tmp_path, face, fault):
    sentence = rf"surface of face 1 of 'skin.brep' is no strip .*{fault}.*: a grid of 3x2 cuts it\.$"
    with pytest.raises(CadpanelError, match=sentence):
        reference_of(tmp_path, face, stations=(500.0,))


@pytest.mark.parametrize("station", cases([2.4, 9000.0], [1e-3, 0.5, 2.4, 8998.0, 8999.9999, 9000.0, 9500.0]))
def test_stations_at_or_beyond_the_ends_are_refused_with_the_stretch_that_has_room(tmp_path, station):
    where = "too close to" if station < 9000.0 else "beyond"
    sentence = (
        rf"the station at {station:.10g} mm lies {where} the end of the surface of faces 1, 2 and 3 of 'skin.brep', "
        r"which goes from 0 to 9000 mm: give stations from 2\.5 to 8997\.5 mm"
    )
    faces = strip_faces(STRAIGHT)
    with pytest.raises(CadpanelError, match=sentence):
        reference_of(tmp_path, *faces, stations=(station,))
    assert len(reference_of(tmp_path, *faces, stations=(2.51, 8997.49)).seams) == 2


def test_stations_side_by_side_are_refused(tmp_path):
    faces = strip_faces(STRAIGHT)
    with pytest.raises(CadpanelError, match=r"the stations at 1000 and 1000.5 mm .*: leave at least 2.5 mm between"):
        reference_of(tmp_path, *faces, stations=(1000.0, 1000.5))
    assert len(reference_of(tmp_path, *faces, stations=(1000.0, 1002.6)).seams) == 2


def spine(tmp_path, *ends):
    return write_shape(tmp_path / "spine.brep", BRepBuilderAPI_MakeEdge(*(gp_Pnt(*end) for end in ends)).Edge())


@pytest.mark.parametrize(
    ("ends", "station", "room"),
    [
        (((-5000.0, 0.0, 0.0), (9000.0, 0.0, 0.0)), 4000.0, (5000.0, 14000.0)),
        (((0.0, 0.0, 0.0), (12000.0, 0.0, 0.0)), 9500.0, (0.0, 9000.0)),
        (((0.0, 0.0, 0.0), (12000.0, 0.0, 0.0)), 8999.9, (0.0, 9000.0)),
        (((4000.0, -50000.0, 0.0), (4000.0, 0.0, 0.0)), 1000.0, (49500.0, 50300.0)),
    ],
)
def test_stations_that_miss_the_surface_are_told_where_along_the_spine_it_lies(tmp_path, ends, station, room):
    low, high = room
    sentence = (
        rf"the station at {station:g} mm lies .* the end of the surface of faces 1, 2 and 3 of 'skin.brep' beside the "
        rf"spine in 'spine.brep', which goes from {low:g} to {high:g} mm"
    )
    line = spine(tmp_path, *ends)
    with pytest.raises(CadpanelError, match=sentence):
        reference_of(tmp_path, *strip_faces(STRAIGHT), stations=(station,), spine=line)
    halves = reference_of(tmp_path, *strip_faces(STRAIGHT), stations=(0.5 * (low + min(high, 49999.0)),), spine=line)
    assert len(halves.seams) == 1


@pytest.mark.parametrize(
    ("turn", "sentence"),
    [
        (360.0, "The spine in 'spine.brep' closes to a ring, on which no station is the first: leave a part of it out"),
        (
            355.0,
            "Beyond the last cut of 3 there is nothing of the surface of faces 1, 2 and 3 of 'skin.brep': give",
        ),
    ],
)
def test_a_spine_that_goes_all_round_is_refused(tmp_path, turn, sentence):
    circle = gp_Circ(gp_Ax2(gp_Pnt(4500.0, 0.0, -6000.0), gp_Dir(0.0, 1.0, 0.0)), 6000.0)
    line = write_shape(tmp_path / "spine.brep", BRepBuilderAPI_MakeEdge(circle, 0.0, math.radians(turn)).Edge())
    with pytest.raises(ReferenceFileError, match=sentence):
        reference_of(tmp_path, *strip_faces(STRAIGHT), stations=(1000.0, 3000.0, 8000.0), spine=line)


@pytest.mark.parametrize("face", cases([TUBE], [BALL, TUBE, TORUS]))
@thorough
def test_planes_that_leave_rings_are_refused_with_another_way_to_cut(tmp_path, face):
    line = spine(tmp_path, (0.0, 0.0, -RADIUS), (0.0, 0.0, 6000.0))
    with pytest.raises(OutlineError, match=r"Panel 'S1-01': .*: a grid of 3x2 cuts it\.$"):
        reference_of(tmp_path, face, stations=(RADIUS + 50.0,), spine=line)
    assert len(reference_of(tmp_path, face, grid=(3, 2)).panels) == 6


def test_a_ready_made_tube_is_said_to_be_closed_round_and_a_grid_cuts_it(tmp_path):
    said = "it is closed round, its outline has 2 loops where a panel has one: cut it with a grid"
    with pytest.raises(PanelError, match=said):
        reference_of(tmp_path, TUBE)
    assert len(reference_of(tmp_path, TUBE, grid=(2, 1)).panels) == 2


def test_a_ready_made_tube_with_a_slit_is_told_where_it_nearly_meets_itself(tmp_path):
    slit = BRepPrimAPI_MakeCylinder(500.0, 3000.0, 2.0 * math.pi - 0.001).Shape()
    with pytest.raises(
        PanelError, match=r"comes within 1 mm of itself at \(500.0, .*: widen the slit there, or cut it"
    ):
        reference_of(tmp_path, first_face(slit))
    assert len(reference_of(tmp_path, first_face(slit), grid=(2, 1)).panels) == 2


def test_a_panel_without_an_outline_in_the_file_itself_keeps_its_own_remedy(tmp_path):
    with pytest.raises(PanelError, match="its outline has 2 loops where a panel has one: close its holes, trim"):
        reference_of(tmp_path, HOLED)
    assert np.isclose(area_of(compound_of([HOLED])), 12e6 - math.pi * 500.0**2)
