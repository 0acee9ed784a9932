"""Lips found on strips of any faces, and bands of even width cut out about them."""

import math
from itertools import pairwise

import numpy as np
import pytest
from OCP.BRep import BRep_Tool
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace
from OCP.gp import gp_Pln
from OCP.TopAbs import TopAbs_VERTEX
from OCP.TopoDS import TopoDS

import cadpanel as cp
from cadpanel.brep.kernel.shapes import compound_of, shapes_of
from cadpanel.brep.splitting.splitter import area_of
from cadpanel.errors import ReferenceFileError
from tests.cuts import EQUAL, cut, model_of, panels_of
from tests.model_files import write_shape
from tests.reference_shapes import kernel_face
from tests.thorough import cases, thorough

LENGTH, FLANGE, RADIUS, TURN = 6000.0, 800.0, 150.0, math.radians(100.0)


def fold(sweep=0.0, taper=0.0, wander=0.0):
    """A flange, an arc and a flange over u from 0 to 3, drawn along v, swept by an angle and tapered to an apex.

    `wander` makes lines of constant u run aslant over the same surface, between the borders of arc and flanges.
    """

    def surface(u, v):
        u = u + wander * (v - 0.5) * np.sin(math.pi * u)
        angle = TURN * (np.clip(u, 1.0, 2.0) - 1.5)
        out = FLANGE * np.clip(1.0 - u, 0.0, None), FLANGE * np.clip(u - 2.0, 0.0, None)
        y = RADIUS * np.sin(angle) + (out[1] - out[0]) * math.cos(0.5 * TURN)
        z = RADIUS * np.cos(angle) - (out[0] + out[1]) * math.sin(0.5 * TURN)
        size = 1.0 - taper * v
        return np.stack([LENGTH * v + 0.0 * u, size * y + math.tan(sweep) * LENGTH * v, size * z], axis=-1)

    return surface


def faces_of(surface, *rows):
    """Faces of a surface: for each row how far it reaches along v, and where it is cut across."""
    found = []
    for (low, high), cuts in rows:
        part = lambda u, v, low=low, high=high: surface(u, low + (high - low) * v)  # noqa: E731
        found += [kernel_face(part, (one, other), poles=24) for one, other in pairwise(cuts)]
    return found


WHOLE = ((0.0, 1.0), (0.0, 1.0, 2.0, 3.0))
# Two rows whose faces meet aslant in the middle: they share no parameter, and their corners do not meet.
STAGGERED = (((0.0, 0.45), (0.0, 1.0, 1.6, 2.0, 3.0)), ((0.45, 1.0), (0.0, 1.0, 1.3, 2.0, 3.0)))


@pytest.mark.parametrize("sweep", cases([30.0], [0.0, 10.0, 30.0]))
@pytest.mark.parametrize("rows", [(WHOLE,), STAGGERED], ids=["lanes", "staggered"])
@pytest.mark.parametrize("wander", cases([0.15], [0.0, 0.15]))
def test_the_band_is_as_wide_as_asked_square_to_the_lip(sweep, rows, wander):
    angle = math.radians(sweep)
    model = model_of(*faces_of(fold(sweep=angle, wander=wander), *rows))
    panels = panels_of(model, divide=3, lip=500.0)
    assert [panel.name for panel in panels] == ["S1-01", "S1-02", "S1-03"]
    areas = [sum(map(area_of, panel.faces)) for panel in panels]
    # Laid flat, the band is a parallelogram.
    assert sum(areas) == pytest.approx(500.0 * LENGTH / math.cos(angle), rel=EQUAL)


def test_the_band_of_a_tapered_strip_is_even():
    surface = fold(taper=0.4)
    panels = panels_of(model_of(*faces_of(surface, WHOLE)), divide=4, lip=400.0)
    lip = float(np.linalg.norm(surface(np.array(1.5), np.array(1.0)) - surface(np.array(1.5), np.array(0.0))))
    areas = [sum(map(area_of, panel.faces)) for panel in panels]
    assert sum(areas) == pytest.approx(400.0 * lip, rel=EQUAL)
    assert max(areas) <= 1.02 * min(areas)


@pytest.mark.parametrize("beyond", cases([0.01, 1.4, 2.0], [0.01, 0.3, 0.7, 1.0, 1.4, 2.0, 10.0]))
@pytest.mark.parametrize("wander", [0.0, 0.15], ids=["along parameters", "along curves"])
def test_a_border_close_to_where_two_faces_meet_is_made_there(tmp_path, beyond, wander):
    path = write_shape(tmp_path / "fold.brep", compound_of(faces_of(fold(wander=wander), WHOLE)))
    reference = cp.read(path, unit="mm", divide=3, lip=TURN * RADIUS + 2.0 * beyond)
    notes = [note for note in reference.notes if "would take in only" in note]
    assert len(notes) == (beyond < 1.5)
    asked = TURN * RADIUS + 2.0 * (0.0 if notes else beyond)
    area = sum(panel.weights.sum() for panel in reference.panels)
    assert area == pytest.approx(asked * LENGTH, rel=EQUAL)


def test_a_band_may_be_as_wide_as_inspect_says_that_its_lip_is(tmp_path):
    path = write_shape(tmp_path / "fold.brep", compound_of(faces_of(fold(), WHOLE)))
    lips = cp.inspect(path, unit="mm").surfaces[0].lips
    assert lips is not None
    (lip,) = lips
    assert len(cp.read(path, unit="mm", divide=3, lip=round(lip.width, 1)).panels) == 3


def test_the_lip_lies_in_the_middle_of_the_band(tmp_path):
    faces = faces_of(fold(sweep=0.3), *STAGGERED)
    reference = cp.read(write_shape(tmp_path / "fold.brep", compound_of(faces)), unit="mm", divide=3, lip=500.0)
    for panel in reference.panels:
        for normals in panel.edge_normals[:2]:
            turned = np.degrees(np.arccos(np.clip(normals[[0, -1]] @ normals[len(normals) // 2], -1.0, 1.0)))
            # Half of the turn is on either side; swept sections turn unevenly, but alike on both sides.
            assert turned[0] == pytest.approx(turned[1], abs=2.0)
            assert turned.sum() > math.degrees(TURN) * 0.9


@pytest.mark.parametrize("rows", [(WHOLE,), STAGGERED], ids=["lanes", "staggered"])
def test_inspect_measures_lips_whatever_the_faces_share(tmp_path, rows):
    path = write_shape(tmp_path / "fold.brep", compound_of(faces_of(fold(), *rows)))
    (surface,) = cp.inspect(path, unit="mm").surfaces
    assert surface.strip == pytest.approx((LENGTH, 2.0 * FLANGE + TURN * RADIUS), rel=1e-4)
    assert surface.lips is not None
    (lip,) = surface.lips
    assert lip.turn == pytest.approx(100.0, abs=1.0)
    assert lip.radius == pytest.approx(RADIUS, rel=0.02)


@pytest.mark.parametrize("rows", [(WHOLE,), STAGGERED], ids=["lanes", "staggered"])
@pytest.mark.parametrize(("width", "sentence"), [(1850.0, "no more than the band"), (1e5, "no more than the band")])
def test_a_band_as_wide_as_the_strip_is_refused(rows, width, sentence):
    with pytest.raises(ReferenceFileError, match=sentence):
        panels_of(model_of(*faces_of(fold(), *rows)), divide=3, lip=width + 20.0)


def test_a_band_that_runs_over_a_long_edge_is_refused_with_the_width_that_has_room():
    surface = fold(taper=0.5)
    with pytest.raises(ReferenceFileError, match=r"runs over its long edge: give less than (9\d\d)"):
        panels_of(model_of(*faces_of(surface, WHOLE)), divide=3, lip=1200.0)


def test_a_flat_strip_has_no_lip():
    flat = BRepBuilderAPI_MakeFace(gp_Pln(), 0.0, 6000.0, 0.0, 900.0).Face()
    with pytest.raises(ReferenceFileError, match="has no lip"):
        panels_of(model_of(flat), divide=3, lip=100.0)


def test_a_lip_beside_a_long_edge_has_no_band_on_that_side():
    # A flange of 80 mm beside the arc, however wide the other one is.
    faces = faces_of(fold(), ((0.0, 1.0), (0.9, 1.0, 2.0, 3.0)))
    with pytest.raises(ReferenceFileError, match=r"runs over its long edge: give less than 42\d"):
        panels_of(model_of(*faces), divide=3, lip=600.0)
    assert len(panels_of(model_of(*faces), divide=3, lip=400.0)) == 3


def folds(*turns, radius=100.0, between=500.0):
    """A strip of flanges with arcs between them that turn by so many degrees, alternately down and up.

    Flanges lie over u from 0 to 1, 2 to 3 and so on.
    """

    def surface(u, v):
        y, z, angle = np.zeros_like(u), np.zeros_like(u), 0.0
        for place, turn in enumerate([*turns, 0.0]):
            flat = (between if 0 < place < len(turns) else 500.0) * np.clip(u - 2 * place, 0.0, 1.0)
            y, z = y + flat * math.cos(angle), z + flat * math.sin(angle)
            bend = math.radians(turn) * (-1.0 if place % 2 == 0 else 1.0)
            side = math.copysign(radius, bend)
            turned = angle + bend * np.clip(u - 2 * place - 1, 0.0, 1.0)
            y = y + side * (np.sin(turned) - math.sin(angle))
            z = z - side * (np.cos(turned) - math.cos(angle))
            angle += bend
        return np.stack([LENGTH * v, y, z], axis=-1)

    return surface


def faces_between(surface, *cuts):
    return [kernel_face(surface, ends, poles=24) for ends in pairwise(cuts)]


def test_a_band_about_one_of_two_lips_that_turn_alike_is_refused_until_its_faces_are_chosen():
    model = model_of(*faces_between(folds(60.0, 62.0), 0.0, 1.0, 2.0, 2.5, 3.0, 4.0, 5.0))
    sentence = (
        r"has two lips that turn alike, by 60 and 62 degrees at 5\d\d and 11\d\d mm .*: choose the faces of the lip"
    )
    with pytest.raises(ReferenceFileError, match=sentence):
        panels_of(model, divide=3, lip=300.0)
    for chosen in ("1-3", "4-6"):
        panels = panels_of(model, divide=3, lip=300.0, faces=(chosen,))
        assert sum(area_of(face) for panel in panels for face in panel.faces) == pytest.approx(
            300.0 * LENGTH, rel=EQUAL
        )


def test_a_face_with_two_lips_is_to_be_split_first():
    with pytest.raises(
        ReferenceFileError, match=r"turn alike, .*: split it between its lips where it was modelled, and"
    ):
        panels_of(model_of(kernel_face(folds(60.0, 60.0), (0.0, 5.0), poles=80)), divide=3, lip=300.0)


def test_a_band_about_the_greater_of_two_lips_says_so():
    faces = faces_between(folds(40.0, 80.0), 0.0, 1.0, 2.0, 3.0, 4.0, 5.0)
    panels, notes = cut(model_of(*faces), divide=3, lip=300.0)
    (note,) = notes
    assert "lies about the lip that turns by 80 degrees" in note
    assert "and not about another one, which turns by 40; for another band, choose the faces of the lip" in note
    (only,) = {len(panel.faces) for panel in panels}
    assert only == 3


def test_two_bends_in_one_band_are_no_question():
    faces = faces_between(folds(60.0, 60.0, between=100.0), 0.0, 1.0, 2.0, 3.0, 4.0, 5.0)
    panels, notes = cut(model_of(*faces), divide=3, lip=600.0)
    assert len(panels) == 3
    assert len(notes) == 1


def test_a_lip_that_turns_less_for_a_moment_in_its_midst_is_one():
    faces = faces_between(folds(-40.0, 40.0, between=12.0), 0.0, 1.0, 2.0, 3.0, 4.0, 5.0)
    panels, notes = cut(model_of(*faces), divide=3, lip=100.0)
    assert len(panels) == 3
    assert notes == ()


@thorough
@pytest.mark.parametrize("kink", [0.0, 8.0])
def test_a_band_goes_on_over_faces_that_lie_end_to_end_and_hold_the_lip_each(kink):
    """Straight on, or in two lines that meet in a kink."""

    def half(start, aside):
        bent = fold(sweep=math.radians(aside))
        return kernel_face(lambda u, v: bent(u, 0.5 * v) + np.array([start, 0.0, 0.0]), poles=60)

    panels = panels_of(model_of(half(0.0, 0.0), half(0.5 * LENGTH, kink)), divide=4, lip=500.0)
    area = sum(area_of(face) for panel in panels for face in panel.faces)
    assert area == pytest.approx(250.0 * LENGTH * (1.0 + 1.0 / math.cos(math.radians(kink))), rel=5e-3)


def test_faces_end_to_end_whose_lips_do_not_meet_are_each_a_strip_of_their_own():
    first = kernel_face(lambda u, v: folds(60.0)(u, 0.5 * v), poles=60)
    second = kernel_face(lambda u, v: folds(60.0)(u, 0.5 + 0.5 * v) + np.array([0.0, 200.0, 0.0]), poles=60)
    model = model_of(first, second)
    sentence = r"no strip .*only 1 of its 2 faces touch each other along whole edges\)\.$"
    with pytest.raises(ReferenceFileError, match=sentence):
        panels_of(model, divide=2, lip=300.0)
    assert [len(panels_of(model, divide=2, lip=300.0, faces=(face,))) for face in "12"] == [2, 2]


def test_strips_side_by_side_are_named_in_order_however_their_middles_are_rounded():
    def strips(shift):
        surfaces = [lambda u, v, y=y: fold()(u, v) + np.array([shift, y, 0.0]) for y in (0.0, 3000.0, 6000.0)]
        parts = [faces_of(surface, WHOLE)[0] for surface in surfaces]
        panels = panels_of(model_of(*(parts[i] for i in (2, 0, 1))), divide=1)
        return [float(np.mean([p[1] for f in panel.faces for p in corners_of(f)])) for panel in panels]

    for shift in (0.5, 0.5 + 1e-9, 0.5 - 1e-9):
        assert strips(shift) == sorted(strips(shift))


def corners_of(face):
    return [BRep_Tool.Pnt_s(TopoDS.Vertex_s(vertex)).Coord() for vertex in shapes_of(face, TopAbs_VERTEX)]
