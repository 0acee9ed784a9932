"""Conjugate directions against closed forms (do Carmo 1976, section 3-2), and how planes are turned towards them."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cadpanel.brep.skin.conjugate import seam_bending
from cadpanel.brep.skin.seam_turns import seam_turns
from cadpanel.brep.skin.strip import Strip, find_strip
from tests.cuts import surface_of
from tests.known_faces import arc_face
from tests.model_files import strip_faces
from tests.reference_shapes import Lip, kernel_face
from tests.roof_edges import roof_edge

LENGTH, WIDTH = 6000.0, 600.0
ALONG = 1e-5
MIDDLE = np.array([0.5])


def bending(*faces, edges=None):
    """Of a strip between edges that are given, as functions of the part of the length, or that it is found to have."""
    surface = surface_of(*faces)
    strip = find_strip(surface, "roof.step", 1.0)
    if edges is not None:
        parts = np.linspace(0.0, 1.0, 257)
        strip = Strip(edges=(edges(0.0 * parts, parts), edges(0.0 * parts + 1.0, parts)), girth=WIDTH)
    return seam_bending(surface, strip), strip, surface


def normal_in_the_middle(faces, most, edges=None):
    """Of the plane across the middle, in the strip's own frame, and of its frame in space."""
    found, strip, surface = bending(*faces, edges=edges)
    turns = seam_turns(found, strip.length, surface.area / strip.length, np.radians(most))
    frames = strip.frames(MIDDLE)
    return turns.normals(MIDDLE, frames)[0], frames[0]


def sheet(along, mixed):
    """z = (along x^2 + 2 mixed x y) / 2 along x, shallow enough for its curvature to be its Hessian."""

    def points(u, v):
        x, y = LENGTH * (v - 0.5), WIDTH * (u - 0.5)
        return np.stack([x, y, 0.5 * along * x * x + mixed * x * y], axis=-1)

    return points


def whole(surface):
    return kernel_face(surface, (0.0, 1.0), poles=24)


@settings(max_examples=10)
@given(along=st.floats(-1.0, 1.0).filter(lambda k: abs(k) > 0.1), mixed=st.floats(-1.0, 1.0))
def test_the_conjugate_direction_leans_by_the_angle_of_twist_over_bending(along, mixed):
    surface = sheet(along * 1e-6, mixed * 1e-6)
    found, _, _ = bending(whole(surface), edges=surface)
    near = np.abs(found.places - 0.5) < 0.1
    np.testing.assert_allclose(found.leans[near], np.arctan(abs(mixed / along)), atol=0.01)


@settings(max_examples=10)
@given(lean=st.floats(-12.0, 12.0))
def test_a_plane_turns_to_the_conjugate_direction_where_that_is_allowed(lean):
    surface = sheet(ALONG, ALONG * np.tan(np.radians(lean)))
    normal, frame = normal_in_the_middle([whole(surface)], 15.0, surface)
    # The direction across (-M, L) that is conjugate to x; planes are drawn towards square by a fiftieth of it.
    conjugate = np.array([-np.sin(np.radians(lean)), np.cos(np.radians(lean)), 0.0])
    assert abs(np.degrees(np.arcsin(normal @ conjugate))) < 0.05 * abs(lean) + 0.05
    assert abs(frame[0] @ conjugate) == pytest.approx(abs(np.sin(np.radians(lean))), abs=1e-3)


@settings(max_examples=10)
@given(lean=st.floats(20.0, 60.0), most=st.floats(0.0, 15.0), side=st.sampled_from([-1.0, 1.0]))
def test_no_plane_is_turned_by_more_than_is_allowed(lean, most, side):
    surface = sheet(ALONG, side * ALONG * np.tan(np.radians(lean)))
    normal, frame = normal_in_the_middle([whole(surface)], most, surface)
    assert np.degrees(np.arccos(normal @ frame[0])) == pytest.approx(most, abs=0.02)


@pytest.mark.parametrize(
    "faces", [[arc_face(500.0, 0.0, 90.0, length=4000.0)], strip_faces(Lip(length=6000.0, twist=0.0, taper=0.0))]
)
def test_where_nothing_turns_along_the_strip_planes_are_square(faces):
    normal, frame = normal_in_the_middle(faces, 15.0)
    np.testing.assert_allclose(normal, frame[0], atol=1e-6)


def oblique(radius=8000.0, lean=10.0):
    """A strip on a cylinder whose rulings are off square to it by an angle."""
    c, s = np.cos(np.radians(lean)), np.sin(np.radians(lean))

    def surface(u, v):
        x, y = LENGTH * (v - 0.5), WIDTH * (u - 0.5)
        round_it, on = c * x + s * y, -s * x + c * y
        turn = round_it / radius
        return np.stack([radius * np.sin(turn), on, radius * np.cos(turn)], axis=-1)

    return surface


def test_planes_go_along_the_rulings_of_a_strip_that_is_bent_about_them():
    """Its rulings are conjugate to every other direction: panels between them meet without a step."""
    normal, frame = normal_in_the_middle([whole(oblique())], 15.0, oblique())
    ruling = np.array([0.0, 1.0, 0.0])
    assert abs(frame[0] @ ruling) == pytest.approx(np.sin(np.radians(10.0)), abs=0.01)
    assert abs(normal @ ruling) < 0.1 * abs(frame[0] @ ruling)


def test_two_flanges_of_a_twisting_fold_both_get_less_to_close():
    found, strip, surface = bending(*roof_edge())
    turns = seam_turns(found, strip.length, surface.area / strip.length, np.radians(15.0))
    stations = np.linspace(0.0, 1.0, len(turns.turns))
    a, b = (np.interp(found.places, stations, turn) for turn in turns.turns.T)
    e = found.conjugate
    for side in (found.sides < -300.0, found.sides > 300.0):
        square, turned = (
            found.weights[side] @ rest[side] ** 2 for rest in (e[:, 0], e[:, 0] + a * e[:, 1] + b * e[:, 2])
        )
        assert turned < 0.8 * square


@pytest.mark.parametrize("shift", [0.0, 2e6])
def test_where_the_strip_stands_and_how_its_faces_lie_change_no_turn(shift):
    lip = Lip(length=9000.0, twist=3.0, taper=0.05)

    def moved(u, v):
        points = lip(u, v)
        return np.stack([points[..., 0] + shift, -points[..., 2], points[..., 1] - shift], axis=-1)

    first = strip_faces(lip)
    other = [kernel_face(moved, (float(k), k + 1.0), poles=24).Reversed() for k in (2, 0, 1)]
    turns = []
    for faces in (first, other):
        found, strip, surface = bending(*faces)
        turns.append(np.abs(seam_turns(found, strip.length, surface.area / strip.length, np.radians(15.0)).turns))
    np.testing.assert_allclose(turns[0], turns[1], atol=1e-4)
