import math
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from OCP.BRepBuilderAPI import (
    BRepBuilderAPI_MakeEdge,
    BRepBuilderAPI_MakeFace,
    BRepBuilderAPI_MakePolygon,
    BRepBuilderAPI_MakeWire,
)
from OCP.BRepLib import BRepLib
from OCP.BRepPrimAPI import BRepPrimAPI_MakeCylinder
from OCP.GCE2d import GCE2d_MakeSegment
from OCP.Geom import Geom_BezierSurface, Geom_CylindricalSurface
from OCP.gp import gp_Ax3, gp_Dir, gp_Pln, gp_Pnt, gp_Pnt2d
from OCP.TColgp import TColgp_Array2OfPnt
from OCP.TopAbs import TopAbs_FACE

from cadpanel.brep.faces.sampling import sample_faces
from cadpanel.brep.kernel.shapes import compound_of, shapes_of
from cadpanel.brep.splitting.splitter import area_of
from cadpanel.errors import ReferenceFileError, SettingsError
from cadpanel.reference.settings import ReferenceSettings
from cadpanel.reference.texts import choice_named, choices_of
from tests.cuts import EQUAL, assert_covers, cut, middle, model_of, panels_of, reference_of
from tests.model_files import STRIP, strip_faces
from tests.reference_shapes import Lip, kernel_face, ring

STRAIGHT = Lip(length=9000.0, twist=0.0, taper=0.0)


@pytest.mark.parametrize("count", [1, 2, 9])
def test_divided_strip_has_so_many_panels_of_all_its_faces_that_cover_it(count):
    faces = strip_faces()
    panels = panels_of(model_of(*faces), divide=count)
    assert [panel.name for panel in panels] == [f"S1-{place:02d}" for place in range(1, count + 1)]
    assert [len(panel.faces) for panel in panels] == [3] * count
    assert_covers(panels, faces)


def test_neighbours_of_a_divided_strip_share_their_ends(tmp_path):
    reference = reference_of(tmp_path, *strip_faces(), divide=9)
    assert [(seam.panels, seam.edges) for seam in reference.seams] == [((k, k + 1), (1, 0)) for k in range(8)]
    for first, second in pairwise(reference.panels):
        np.testing.assert_allclose(first.ends[1], second.ends[0], atol=1e-6)


def test_panels_of_a_divided_strip_are_equally_long(tmp_path):
    lengths = [panel.length for panel in reference_of(tmp_path, *strip_faces(), divide=6).panels]
    np.testing.assert_allclose(lengths, np.mean(lengths), rtol=EQUAL)


def test_one_face_is_cut_like_three(tmp_path):
    one, three = kernel_face(STRAIGHT, poles=60), strip_faces(STRAIGHT)
    for first, second in zip(
        reference_of(tmp_path, one, divide=5).panels, reference_of(tmp_path, *three, divide=5).panels, strict=True
    ):
        np.testing.assert_allclose(first.corners, second.corners, atol=0.5)


@given(order=st.permutations([0, 1, 2]), flips=st.lists(st.booleans(), min_size=3, max_size=3))
@settings(max_examples=8, deadline=None)
def test_order_of_the_faces_and_side_of_their_normals_change_nothing(order, flips):
    faces = strip_faces()
    turned = [faces[index].Reversed() if flips[index] else faces[index] for index in order]
    for first, second in zip(
        panels_of(model_of(*faces), divide=4), panels_of(model_of(*turned), divide=4), strict=True
    ):
        assert first.name == second.name
        np.testing.assert_allclose(middle(first), middle(second), atol=1.0)


def test_strip_whose_faces_share_no_parameter_is_cut_by_planes(tmp_path):
    """The blend's parameter runs unevenly along the strip, so that equal parts of it are not opposite each other."""
    faces = strip_faces()
    faces[1] = kernel_face(lambda u, v: STRIP(u, 0.6 * v + 0.4 * v * v), (1.0, 2.0), poles=24)
    panels = panels_of(model_of(*faces), divide=9)
    assert [len(panel.faces) for panel in panels] == [3] * 9
    assert_covers(panels, faces)
    reference = reference_of(tmp_path, *faces, divide=9)
    assert len(reference.seams) == 8
    np.testing.assert_allclose([panel.length for panel in reference.panels], 1000.0, rtol=0.01)
    for first, second in pairwise(reference.panels):
        np.testing.assert_allclose(first.ends[1], second.ends[0], atol=0.01)


def trimmed_strip():
    """A cylinder's quarter whose long edges are not parameter lines."""
    axis = gp_Ax3(gp_Pnt(0.0, 0.0, 0.0), gp_Dir(1.0, 0.0, 0.0))
    surface = Geom_CylindricalSurface(axis, 500.0)
    corners = [(0.1, 0.0), (1.8, 0.0), (1.5, 6000.0), (0.3, 6000.0)]
    wire = BRepBuilderAPI_MakeWire()
    for (a, b), (c, d) in zip(corners, [*corners[1:], corners[0]], strict=True):
        wire.Add(BRepBuilderAPI_MakeEdge(GCE2d_MakeSegment(gp_Pnt2d(a, b), gp_Pnt2d(c, d)).Value(), surface).Edge())
    face = BRepBuilderAPI_MakeFace(surface, wire.Wire(), False).Face()
    BRepLib.BuildCurves3d_s(face)
    return face


def test_trimmed_face_is_divided_and_covered(tmp_path):
    face = trimmed_strip()
    panels = panels_of(model_of(face), divide=5)
    assert [len(panel.faces) for panel in panels] == [1] * 5
    assert_covers(panels, [face])
    assert len(reference_of(tmp_path, face, divide=5).seams) == 4


def test_long_strip_of_many_panels_loses_none():
    lip = Lip(length=2000.0 * 100, twist=0.06, taper=0.001)
    faces = strip_faces(lip, poles=50)
    faces[1] = kernel_face(lambda u, v: lip(u, 0.9 * v + 0.1 * v * v), (1.0, 2.0), poles=50)
    panels = panels_of(model_of(*faces), divide=100)
    assert [len(panel.faces) for panel in panels] == [3] * 100
    assert_covers(panels, faces)


def test_ring_is_divided_round():
    surface = ring(1)[0]
    faces = [kernel_face(surface, (k, k + 1), poles=40) for k in (0.0, 1.0, 2.0)]
    panels = panels_of(model_of(*faces), divide=8)
    assert [len(panel.faces) for panel in panels] == [3] * 8
    assert_covers(panels, faces)


def test_tube_is_not_divided_along_its_length_but_by_a_grid():
    (tube,) = [
        face for face in shapes_of(BRepPrimAPI_MakeCylinder(500.0, 6000.0).Shape(), TopAbs_FACE) if area_of(face) > 1e7
    ]
    with pytest.raises(ReferenceFileError, match="closed round its length, and a panel cannot go round: cut it both"):
        panels_of(model_of(tube), divide=4)
    with pytest.raises(
        ReferenceFileError, match="is closed along its parameter u, and a panel cannot go round it: cut it into 2"
    ):
        panels_of(model_of(tube), grid=(1, 4))
    assert_covers(panels_of(model_of(tube), grid=(4, 3)), [tube])


@pytest.mark.parametrize("by", ["length", "parameter"])
def test_grid_covers_a_whole_face_and_names_rows_and_columns(by):
    face = kernel_face(STRIP, poles=40)
    panels = panels_of(model_of(face), grid=(3, 12), by=by)
    assert [panel.name for panel in panels] == [f"S1-R{r:02d}-C{c:02d}" for r in range(1, 4) for c in range(1, 13)]
    assert_covers(panels, [face])


def test_grid_by_length_has_equal_lengths_where_parameters_are_uneven():
    poles = TColgp_Array2OfPnt(1, 2, 1, 3)
    for row, y in enumerate((0.0, 1000.0), start=1):
        for column, x in enumerate((0.0, 500.0, 4000.0), start=1):
            poles.SetValue(row, column, gp_Pnt(x, y, 0.0))
    face = BRepBuilderAPI_MakeFace(Geom_BezierSurface(poles), 1e-6).Face()
    areas = {
        by: [area_of(p.faces[0]) for p in panels_of(model_of(face), grid=(2, 4), by=by)]
        for by in ("length", "parameter")
    }
    np.testing.assert_allclose(areas["length"], np.mean(areas["length"]), rtol=1e-3)
    assert max(areas["parameter"]) > 1.2 * min(areas["parameter"])


def test_grid_on_a_trimmed_face_has_panels_where_the_face_lies():
    corners = [gp_Pnt(*point, 0.0) for point in ((0.0, 0.0), (4000.0, 0.0), (4000.0, 1000.0), (0.0, 3000.0))]
    wire = BRepBuilderAPI_MakePolygon(*corners, True).Wire()
    face = BRepBuilderAPI_MakeFace(gp_Pln(), wire).Face()
    panels = panels_of(model_of(face), grid=(4, 3))
    assert_covers(panels, [face])
    assert 8 <= len(panels) < 12


def test_grid_of_several_faces_names_each():
    faces = strip_faces()
    panels = panels_of(model_of(*faces), grid=(1, 2))
    assert_covers(panels, faces)
    assert [panel.name for panel in panels][:3] == ["S1.1-R01-C01", "S1.1-R01-C02", "S1.2-R01-C01"]


def test_stations_cut_where_they_say():
    faces = strip_faces(STRAIGHT)
    panels = panels_of(model_of(*faces), stations=(1000.0, 2500.0, 7000.0))
    assert_covers(panels, faces)
    spans = [
        np.ptp(np.concatenate([e for f in sample_faces(compound_of(p.faces)) for e in f.edges])[:, 0]) for p in panels
    ]
    np.testing.assert_allclose(spans, [1000.0, 1500.0, 4500.0, 2000.0], atol=1e-3)


def test_station_beyond_the_strip_is_refused():
    with pytest.raises(
        SettingsError, match="the station at 9500 mm lies beyond the end of the surface of faces 1, 2 and 3"
    ):
        panels_of(model_of(*strip_faces(STRAIGHT)), stations=(1000.0, 9500.0))


def test_surfaces_apart_are_divided_each_for_itself_and_named_by_place_or_by_name():
    near, far = kernel_face(STRAIGHT), kernel_face(Lip(length=9000.0, twist=0.0, taper=0.0, start=20_000.0))
    assert [panel.name for panel in panels_of(model_of(far, near), divide=2)] == ["S1-01", "S1-02", "S2-01", "S2-02"]
    taken = [panel.name for panel in panels_of(model_of(far, near, names=("", "S2")), divide=2)]
    assert taken == ["S2-01", "S2-02", "S3-01", "S3-02"]
    named = panels_of(model_of(far, near, names=("east", "west")), divide=2)
    assert [panel.name for panel in named] == ["west-01", "west-02", "east-01", "east-02"]


def test_faces_that_fold_back_like_a_trailing_edge_are_not_joined():
    def skin(side):
        return lambda u, v: np.stack([2000.0 * v, 1000.0 * u**2, side * 60.0 * u * (1.0 - u)], axis=-1)

    upper, lower = kernel_face(skin(1.0), (0.0, 1.0), 30), kernel_face(skin(-1.0), (0.0, 1.0), 30)
    panels, notes = cut(model_of(upper, lower), divide=3)
    assert [len(panel.faces) for panel in panels] == [2, 2, 2]
    assert any("fold back by" in note for note in notes)


def test_gap_within_the_tolerance_is_noted_and_a_wider_one_parts_the_strip():
    faces = strip_faces(STRAIGHT)

    def lifted(gap):
        def surface(u, v):
            return STRAIGHT(u, v) + np.array([0.0, 0.0, gap])

        return [faces[0], faces[1], kernel_face(surface, (2.0, 3.0), poles=24)]

    panels, notes = cut(model_of(*lifted(0.4)), divide=3)
    assert [len(panel.faces) for panel in panels] == [3, 3, 3]
    assert any("An edge between faces of 'roof.step' gapes, by 0.4 mm" in note for note in notes)
    panels, notes = cut(model_of(*lifted(1.5)), divide=3)
    assert sorted(len(panel.faces) for panel in panels) == [1, 1, 1, 2, 2, 2]
    assert notes == ()


@pytest.mark.parametrize("radius", [300.0, 2000.0, 20_000.0])
@pytest.mark.parametrize(("gap", "joined"), [(0.05, True), (0.36, True), (0.999, True), (1.001, False)])
def test_gap_along_curved_edges_is_told_as_it_is(radius, gap, joined):
    def sector(inner, outer):
        def surface(u, v):
            reach = inner + (outer - inner) * u
            return np.stack([reach * np.cos(v), reach * np.sin(v), 0.0 * v], axis=-1)

        return kernel_face(surface, (0.0, 1.0), 24)

    model = model_of(sector(radius - gap - 200.0, radius - gap), sector(radius, radius + 200.0))
    panels, notes = cut(model, grid=(1, 1))
    whole = ["S1.1-R01-C01", "S1.2-R01-C01"] if joined else ["S1-R01-C01", "S2-R01-C01"]
    assert [panel.name for panel in panels] == whole
    assert notes == (
        (
            f"An edge between faces of 'roof.step' gapes, by {gap:.2g} mm between faces 1 and 2; that is "
            "within the tolerance of 1 mm.",
        )
        if joined
        else ()
    )


def test_face_drawn_twice_and_face_without_width_are_left_out_with_a_note():
    faces = strip_faces(STRAIGHT)
    hair = kernel_face(lambda u, v: np.stack([9000.0 * v, 5000.0 + 0.01 * u, 0.0 * u], axis=-1), (0.0, 1.0))
    again = kernel_face(STRAIGHT, (1.0, 2.0), poles=24)
    panels, notes = cut(model_of(*faces, hair, again), divide=3)
    assert_covers(panels, faces)
    assert any(note == "Face 5 of 'roof.step' lies on face 2 and is left out." for note in notes)
    assert any("Face 4 of 'roof.step' is only 0.01 mm wide and is left out." in note for note in notes)


@pytest.mark.parametrize(
    ("how", "sentence"),
    [
        ({"divide": 0}, "must be a whole number from 1"),
        ({"divide": 2.5}, "must be a whole number from 1"),
        ({"divide": True}, "must be a whole number from 1"),
        ({"grid": (3,)}, "a grid is two numbers of panels"),
        ({"grid": (3, 0)}, "must be a whole number from 1"),
        ({"grid": (2000, 2000)}, "a grid may have 1000000 panels"),
        ({"grid": (2, 2), "by": "chance"}, "by length or by parameter"),
        ({"by": "parameter"}, "give a grid, too"),
        ({"stations": ()}, "positive lengths along the strip"),
        ({"stations": (2.0, 1.0)}, "must rise"),
        ({"stations": (-1.0,)}, "positive lengths"),
        ({"stations": (math.nan,)}, "positive lengths"),
        ({"spine": "spine.step"}, "give stations, too"),
        ({"divide": 3, "grid": (1, 2)}, "divide and grid are ways to cut the same surface: choose one"),
        ({"unit": ["mm"]}, "there is no unit"),
        ({"unit": "cubit"}, "there is no unit 'cubit'"),
        ({"faces": ()}, "faces are chosen by"),
        ({"seam_tolerance": 0.0}, "must be a positive length"),
        ({"network": 3}, "must be the name of a file"),
    ],
)
def test_settings_that_make_no_sense_are_refused(how, sentence):
    with pytest.raises(SettingsError, match=sentence):
        ReferenceSettings(**how)


@given(st.lists(st.text().map(str.strip).filter(bool), min_size=1))
@settings(max_examples=200, deadline=None)
def test_any_names_can_be_listed_with_commas_between_them(names):
    assert choices_of(", ".join(map(choice_named, names))) == tuple(names)


@pytest.mark.parametrize("text", ['"Roof, north', 'layer="Skin', '"a"b', '3,"'])
def test_quotation_marks_about_a_part_of_a_choice_are_refused(text):
    with pytest.raises(SettingsError, match=r"the quotation marks in .* do not enclose one choice each"):
        ReferenceSettings(faces=text)


def test_settings_take_their_usual_forms():
    make: Any = ReferenceSettings
    how = make(faces="1, layer=Skin", stations=[1, 2.5], unit="in")
    assert how.faces == ("1", "layer=Skin")
    assert make(faces='"Roof, north", layer = "Skin, east",3').faces == ("Roof, north", "layer = Skin, east", "3")
    assert how.stations == (1.0, 2.5)
    assert how.millimetres == 25.4
    assert how.way == "stations"
