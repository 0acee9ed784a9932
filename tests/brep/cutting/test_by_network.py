"""Cuts by a network of curves: they part faces, rows and columns, over joints and gaps."""

import re

import numpy as np
import pytest
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeFace
from OCP.Geom import Geom_BezierCurve
from OCP.gp import gp_Pln, gp_Pnt
from OCP.TColgp import TColgp_Array1OfPnt

from cadpanel.brep.kernel.shapes import compound_of
from cadpanel.brep.read import read_raw_panels, read_reference
from cadpanel.errors import ReferenceFileError
from cadpanel.reference.settings import ReferenceSettings
from tests.covering import assert_covers, weight
from tests.drawn import POINTS, curve
from tests.known_faces import flat
from tests.model_files import STRIP, strip_faces, write_shape
from tests.reference_shapes import kernel_face
from tests.strip_cuts import across, along
from tests.thorough import cases


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("network")


def raw(folder, faces, curves, **how):
    skin = write_shape(folder / "skin.brep", compound_of(faces))
    lines = write_shape(folder / "lines.brep", compound_of(curves))
    return read_raw_panels(skin, ReferenceSettings(unit="mm", network=lines, **how))


@pytest.mark.parametrize("lift", [0.0, 0.003, 0.5])
def test_curves_near_a_strip_of_three_faces_cut_it_into_panels(folder, lift):
    faces = strip_faces()
    found = raw(folder, faces, [across(v, lift) for v in (0.2, 0.45, 0.8)])
    assert [panel.name for panel in found.panels] == ["S1-01", "S1-02", "S1-03", "S1-04"]
    assert [len(panel.faces) for panel in found.panels] == [3] * 4
    assert_covers(found.panels, faces)
    said = [re.search(r"lie up to ([\d.]+) mm off the surface", note) for note in found.notes]
    (offset,) = [float(match[1]) for match in said if match]
    # The curves themselves follow the formula to a tenth of a millimetre only.
    assert lift <= offset <= lift + 0.15


def test_curve_that_ends_farther_from_the_outline_than_the_tolerance_is_refused_until_that_is_raised(folder):
    faces = strip_faces()
    with pytest.raises(ReferenceFileError, match=r"separates no two panels near"):
        raw(folder, faces, [across(0.5, stop=2.997)])
    assert len(raw(folder, faces, [across(0.5, stop=2.997)], seam_tolerance=4.0).panels) == 2


def test_curve_that_sticks_out_beyond_another_one_by_less_than_the_tolerance_is_fine(folder):
    face = kernel_face(STRIP, poles=40)
    found = raw(folder, [face], [along(1.5), across(0.7, stop=1.5005)])
    assert len(found.panels) == 3
    assert_covers(found.panels, [face])
    assert all(len(edge) >= 33 for panel in found.panels for face in panel.faces for edge in face.edges)


def test_curve_along_the_border_between_two_faces_parts_them(folder):
    faces = strip_faces()
    found = raw(folder, faces, [along(1.0)])
    assert sorted(len(panel.faces) for panel in found.panels) == [1, 2]
    assert_covers(found.panels, faces)


def test_neighbours_share_their_ends(folder):
    faces = strip_faces()
    raw(folder, faces, [across(v) for v in (0.2, 0.45, 0.8)])
    reference = read_reference(folder / "skin.brep", ReferenceSettings(unit="mm", network=folder / "lines.brep"))
    assert [seam.panels for seam in reference.seams] == [(0, 1), (1, 2), (2, 3)]


def test_crossing_curves_cut_one_face_into_rows_and_columns(folder):
    face = kernel_face(STRIP, poles=40)
    found = raw(folder, [face], [*map(across, (0.2, 0.4, 0.6, 0.8)), along(1.0), along(2.0)])
    assert len(found.panels) == 15
    assert {panel.name for panel in found.panels} == {f"S1-R0{r}-C0{c}" for r in (1, 2, 3) for c in range(1, 6)}
    assert_covers(found.panels, [face])


def test_order_of_the_curves_changes_nothing(folder):
    face = kernel_face(STRIP, poles=40)
    curves = [across(0.3), across(0.7), along(1.5)]
    first, second = (raw(folder, [face], order).panels for order in (curves, curves[::-1]))
    assert [panel.name for panel in first] == [panel.name for panel in second]
    for one, other in zip(first, second, strict=True):
        assert weight(one) == pytest.approx(weight(other), rel=1e-9)


def test_curves_of_the_same_file_cut_its_surface(folder):
    faces = strip_faces()
    path = write_shape(folder / "both.brep", compound_of([compound_of(faces), across(0.5)]))
    found = read_raw_panels(path, ReferenceSettings(unit="mm", network=path))
    assert [panel.name for panel in found.panels] == ["S1-01", "S1-02"]


def test_curve_that_ends_inside_a_panel_is_refused_with_its_place(folder):
    face = kernel_face(STRIP, poles=40)
    with pytest.raises(
        ReferenceFileError, match=r"Curve 2 of 'lines.brep' separates no two panels near \(.*draw it on"
    ):
        raw(folder, [face], [across(0.3), across(0.7, stop=1.4)])


def test_curve_that_ends_at_another_one_is_fine(folder):
    face = kernel_face(STRIP, poles=40)
    found = raw(folder, [face], [along(1.5), across(0.7, stop=1.5)])
    assert len(found.panels) == 3
    assert_covers(found.panels, [face])


@pytest.mark.parametrize("meet", cases([0.9997, 1.001], [0.999, 0.9997, 1.0, 1.0003, 1.001]))
def test_curves_that_go_on_from_each_other_beside_a_border_leave_no_sliver(folder, meet):
    faces = strip_faces()
    parts = [np.linspace(0.0, meet, POINTS), np.linspace(meet, 3.0, POINTS)]
    found = raw(folder, faces, [curve(STRIP(u, 0.5 + 0.1 * np.sin(2.0 * u))) for u in parts])
    assert [panel.name for panel in found.panels] == ["S1-01", "S1-02"]
    assert_covers(found.panels, faces)


def test_curve_far_from_the_surface_and_file_without_curves_are_refused(folder):
    face = kernel_face(STRIP, poles=40)
    with pytest.raises(ReferenceFileError, match=r"Curve 1 of 'lines.brep' lies over no surface of 'skin.brep'"):
        raw(folder, [face], [across(0.3, lift=3000.0)])
    with pytest.raises(ReferenceFileError, match=r"'lines.brep' holds no loose curves, only faces"):
        raw(folder, [face], [face])


@pytest.mark.parametrize(
    "ends",
    cases(
        [(0.3, 0.3), (0.0, 0.6), (0.0, -0.02)],
        [(0.0, 0.0), (0.02, 0.02), (0.3, 0.3), (0.9, 0.9), (0.0, 0.6), (0.0, -0.02)],
    ),
)
def test_panels_go_on_across_gaps_within_the_tolerance(folder, ends):
    """Two plates of 3 by 4 m side by side with a gap, of even width or a wedge, below zero where they overlap."""
    first = [(0, 0, 0), (3000, 0, 0), (3000, 4000, 0), (0, 4000, 0)]
    second = [(3000 + ends[0], 0, 0), (6000, 0, 0), (6000, 4000, 0), (3000 + ends[1], 4000, 0)]
    plates = [flat(first), flat(second)]
    found = raw(folder, plates, [straight((0, y, 0), (6000, y, 0)) for y in (1000, 2000, 3000)])
    assert [len(panel.faces) for panel in found.panels] == 4 * [2]
    assert sum(map(weight, found.panels)) == pytest.approx(24e6, rel=3e-4)
    how = ReferenceSettings(unit="mm", network=folder / "lines.brep")
    assert len(read_reference(folder / "skin.brep", how).seams) == 3


def test_panels_do_not_go_on_across_a_gap_beyond_the_tolerance(folder):
    plates = [flat([(x, 0, 0), (x + 3000, 0, 0), (x + 3000, 4000, 0), (x, 4000, 0)]) for x in (0.0, 3001.5)]
    found = raw(folder, plates, [straight((0, 2000, 0), (6100, 2000, 0))])
    assert [len(panel.faces) for panel in found.panels] == 4 * [1]


def straight(first, last):
    return BRepBuilderAPI_MakeEdge(gp_Pnt(*map(float, first)), gp_Pnt(*map(float, last))).Edge()


def test_curves_without_length_alone_are_refused(folder):
    point = TColgp_Array1OfPnt(1, 2)
    for place in (1, 2):
        point.SetValue(place, gp_Pnt(3000.0, 0.0, 0.0))
    dot = BRepBuilderAPI_MakeEdge(Geom_BezierCurve(point)).Edge()
    with pytest.raises(ReferenceFileError, match=r"'lines.brep' holds only curves without length: draw them again"):
        raw(folder, [kernel_face(STRIP)], [dot])


def test_surface_that_no_curve_passes_over_stays_whole(folder):
    beside = BRepBuilderAPI_MakeFace(gp_Pln(), 0.0, 9000.0, 20_000.0, 24_000.0).Face()
    found = raw(folder, [kernel_face(STRIP, poles=40), beside], [across(0.5)])
    assert len(found.panels) == 3
