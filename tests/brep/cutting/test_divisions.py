"""Strips and rings divided by the length of their panels, and by planes that lean."""

from itertools import pairwise

import numpy as np
import pytest

from cadpanel.brep.cutting.divisions import Across, Lengthwise, Round, division_of
from cadpanel.errors import ReferenceFileError
from tests.cuts import EQUAL, assert_covers, model_of, panels_of, reference_of, surface_of
from tests.known_faces import arc_face, flat
from tests.model_files import strip_faces
from tests.reference_shapes import Lip, kernel_face
from tests.roof_edges import roof_edge

TOWER = Lip(length=6000.0, twist=0.0, taper=0.0)


def division(*faces, seams="square"):
    return division_of(surface_of(*faces), seams, np.radians(15.0), "roof.step", 1.0)


def tower(lean=0.2):
    """A lip that stands, and leans by a slope."""

    def upright(u, v):
        x, y, z = np.moveaxis(TOWER(u, v), -1, 0)
        return np.stack([y + lean * x, z, x], axis=-1)

    return [kernel_face(upright, (float(k), k + 1.0), poles=24) for k in range(3)]


def trapezoid():
    """A face whose long edges are no lines of its parameters."""
    return [flat([(0, 0, 0), (6000, 0, 0), (5700, 600, 0), (300, 600, 0)])]


@pytest.mark.parametrize(
    ("faces", "kind"),
    [
        (strip_faces(), Lengthwise),
        (trapezoid(), Across),
        ([arc_face(2000.0, 0.0, 200.0), arc_face(2000.0, 200.0, 360.0)], Round),
    ],
    ids=["lengthwise", "across", "round"],
)
@pytest.mark.parametrize("most", [700.0, 1500.0, 2400.0])
def test_panels_are_the_fewest_of_which_none_is_longer_than_allowed(faces, kind, most):
    found = division(*faces)
    assert isinstance(found, kind)
    panels = panels_of(model_of(*faces), panel_length=most)
    assert_covers(panels, faces)
    count = len(panels)
    assert found.longest_panel(count) <= most * (1.0 + 1e-5)
    assert found.longest_panel(count - 1) > most
    assert count - 1 <= found.longest / most + 1.0
    for panel, other in zip(panels, panels_of(model_of(*faces), divide=count), strict=True):
        assert panel.name == other.name


def test_of_two_strips_each_has_as_many_as_its_length_asks_for():
    long, short = (
        flat([(0, 0, 0), (5000, 0, 0), (5000, 500, 0), (0, 500, 0)]),
        flat([(0, 900, 0), (1900, 900, 0), (1900, 1400, 0), (0, 1400, 0)]),
    )
    names = [panel.name for panel in panels_of(model_of(long, short), panel_length=1000.0)]
    assert [sum(name.startswith(f"S{k}-") for name in names) for k in (1, 2)] in ([5, 2], [2, 5])


def test_the_band_about_a_lip_is_divided_by_length_as_well():
    faces = strip_faces(Lip(length=6000.0, twist=0.0, taper=0.0))
    assert len(panels_of(model_of(*faces), panel_length=1000.0, lip=600.0)) == 6
    assert len(panels_of(model_of(*faces), panel_length=999.0, lip=600.0)) == 7


def test_conjugate_panels_cover_the_strip_and_meet_in_planes_that_lean(tmp_path):
    faces = roof_edge()
    panels = panels_of(model_of(*faces), divide=9, seams="conjugate")
    assert_covers(panels, faces)
    reference = reference_of(tmp_path, *faces, divide=9, seams="conjugate")
    assert [seam.panels for seam in reference.seams] == [(k, k + 1) for k in range(8)]
    square = reference_of(tmp_path, *faces, divide=9)
    for first, second in pairwise(reference.panels):
        np.testing.assert_allclose(first.ends[1], second.ends[0], atol=0.02)
    for turned, panel in zip(reference.panels[1:], square.panels[1:], strict=True):
        normals = [np.linalg.svd(end - end.mean(axis=0))[2][-1] for end in (turned.ends[0], panel.ends[0])]
        assert 8.0 < np.degrees(np.arccos(np.clip(abs(normals[0] @ normals[1]), 0.0, 1.0))) < 15.5


def test_conjugate_seams_that_may_not_turn_are_square(tmp_path):
    faces = trapezoid()
    square, still = (
        reference_of(tmp_path, *faces, divide=6, **how) for how in ({}, {"seams": "conjugate", "cut_turn": 0.0})
    )
    for one, other in zip(square.panels, still.panels, strict=True):
        np.testing.assert_allclose(one.corners, other.corners, atol=1e-6)


def test_level_seams_stand_at_equal_heights_and_cover_the_strip(tmp_path):
    faces = tower()
    assert_covers(panels_of(model_of(*faces), divide=4, seams="level"), faces)
    reference = reference_of(tmp_path, *faces, divide=4, seams="level")
    heights = [panel.ends[1][:, 2] for panel in reference.panels[:-1]]
    for height, expected in zip(heights, (1500.0, 3000.0, 4500.0), strict=True):
        np.testing.assert_allclose(height, expected, atol=0.02)
    assert len(reference.seams) == 3


def test_level_panels_are_counted_by_their_length_too():
    faces = tower(lean=0.75)  # 6 m of height are 7.5 m of length
    assert len(panels_of(model_of(*faces), panel_length=1500.0 * 1.001, seams="level")) == 5
    assert len(panels_of(model_of(*faces), panel_length=1490.0, seams="level")) == 6


def test_level_seams_of_a_strip_that_lies_and_leaning_ones_of_a_ring_are_refused():
    with pytest.raises(ReferenceFileError, match=r"^The surface of faces 1, 2 and 3 .* level seams want 20 everywhere"):
        panels_of(model_of(*strip_faces()), divide=3, seams="level")
    belt = [arc_face(2000.0, 0.0, 200.0), arc_face(2000.0, 200.0, 360.0)]
    for seams in ("level", "conjugate"):
        with pytest.raises(ReferenceFileError, match="closes to a ring, which is cut right across"):
            panels_of(model_of(*belt), divide=3, seams=seams)


@pytest.mark.parametrize(
    ("faces", "kind"),
    [(strip_faces(), Lengthwise), ([arc_face(2000.0, 0.0, 200.0), arc_face(2000.0, 200.0, 360.0)], Round)],
    ids=["lengthwise", "round"],
)
def test_free_seams_are_cut_as_square_ones(faces, kind):
    assert isinstance(division(*faces, seams="free"), kind)


def test_equal_parts_are_as_long_as_the_length_says():
    found = division(*strip_faces(Lip(length=9000.0, twist=0.0, taper=0.0)))
    assert found.longest_panel(6) == pytest.approx(1500.0, rel=EQUAL)
    assert found.longest == pytest.approx(9000.0, rel=1e-6)
