"""Runs of a curve over a face: parted where it leaves, where it runs along the border, and over a seam."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from OCP.Geom import Geom_Plane
from OCP.gp import gp_Pln

from cadpanel.brep.curves.curve_intervals import kept_on_face, runs_over, stretches_of
from cadpanel.brep.curves.pieces import piece_through
from cadpanel.brep.faces.closest_points import Search
from cadpanel.brep.faces.face_patch import patch_of
from cadpanel.brep.faces.inside_test import Trim
from tests.known_faces import arc_face, disc_on, face_on

SIDE, TOLERANCE, NEAR = 1000.0, 1.0, 10.0


def plate():
    return Search(patch_of(face_on(Geom_Plane(gp_Pln()), (0.0, SIDE), (0.0, SIDE))))


def runs(search, points):
    """The runs of one smooth curve through points."""
    piece = piece_through(np.asarray(points, dtype=float))
    feet = search.feet(piece.points)
    near = feet.distances <= NEAR
    return runs_over(search.patch, 0, piece, feet, 0, near, TOLERANCE)


def straight(first, last, count=101):
    t = np.linspace(0.0, 1.0, count)[:, None]
    return np.asarray(first) * (1.0 - t) + np.asarray(last) * t


def ends(search, points, trim=None):
    found = runs(search, points)
    if trim is not None:
        inside = trim.encloses(found[0].feet.parameters)
        found = kept_on_face(found, trim, inside, TOLERANCE)
    stretches = [one for one in stretches_of(search, found, TOLERANCE, trim) if one is not None]
    return [one.line[[0, -1]] for one in stretches]


@settings(max_examples=10)
@given(height=st.floats(50.0, 950.0), before=st.floats(10.0, 300.0), after=st.floats(10.0, 300.0))
def test_a_curve_that_goes_beyond_the_border_on_both_sides_reaches_it_on_both(height, before, after):
    (found,) = ends(plate(), straight((-before, height, 0.0), (SIDE + after, height, 0.0)))
    np.testing.assert_allclose(found, [(0.0, height), (SIDE, height)], atol=1e-6)


@pytest.mark.parametrize(("gap", "reached"), [(0.5, True), (0.99, True), (1.01, False), (5.0, False)])
def test_a_curve_that_ends_by_the_border_reaches_it_within_the_tolerance(gap, reached):
    (found,) = ends(plate(), straight((gap, 500.0, 0.0), (700.0, 500.0, 0.0)))
    np.testing.assert_allclose(found[0], (0.0 if reached else gap, 500.0), atol=1e-6)
    np.testing.assert_allclose(found[1], (700.0, 500.0), atol=1e-6)


def test_a_curve_far_off_has_no_runs_and_one_that_rises_is_parted():
    search = plate()
    assert runs(search, straight((100.0, 500.0, 50.0), (900.0, 500.0, 50.0))) == []
    t = np.linspace(0.0, 1.0, 201)
    hill = np.stack([1000.0 * t, 0.0 * t + 500.0, 40.0 * np.sin(np.pi * t) ** 2], axis=1)
    first, last = (run for run in runs(search, hill) if not run.along)
    assert (first.goes_on(1), last.goes_on(-1)) == (True, True)
    assert last.first > first.last + 1


def test_a_curve_along_the_border_is_told_from_one_inside():
    search = plate()
    beside = runs(search, straight((100.0, -0.5, 0.0), (900.0, -0.5, 0.0)))
    assert [run.along for run in beside] == [True]
    inside = runs(search, straight((100.0, 5.0, 0.0), (900.0, 5.0, 0.0)))
    assert [run.along for run in inside] == [False]
    assert runs(search, straight((100.0, -2.0, 0.0), (900.0, -2.0, 0.0))) == []


def test_a_curve_round_a_tube_is_parted_at_its_seam_alone():
    search = Search(patch_of(arc_face(500.0, 0.0, 360.0)))
    angles = np.radians(np.linspace(90.0, 430.0, 200))
    circle = np.stack([np.full(200, 300.0), 500.0 * np.cos(angles), 500.0 * np.sin(angles)], axis=1)
    found = runs(search, circle)
    assert len(found) == 2
    assert found[0].last + 1 == found[1].first


@pytest.mark.parametrize("height", [500.0, 620.0])
def test_a_curve_over_a_disc_is_cut_short_at_its_circle(height):
    """On a plane whose surface goes on beyond the face."""
    patch = patch_of(disc_on(Geom_Plane(gp_Pln()), (500.0, 500.0), 300.0))
    assert not patch.whole
    (found,) = ends(Search(patch), straight((205.0, height, 0.0), (795.0, height, 0.0), 202), Trim(patch))
    half = np.sqrt(300.0**2 - (height - 500.0) ** 2)
    low, high = max(205.0, 500.0 - half), min(795.0, 500.0 + half)
    np.testing.assert_allclose(found[:, 0], (low, high), atol=2.0 * TOLERANCE)
