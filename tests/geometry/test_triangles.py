"""Surfaces of triangles: what lies together is one, closed is closed, and the volume is known."""

from dataclasses import replace

import numpy as np
import pytest

from cadpanel.geometry.triangles import Triangles, is_closed, merged

# A cube of side 2 somewhere, every face with corners of its own.
FACES = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
CORNERS = np.array([[x, y, z] for x in (0.0, 2.0) for y in (0.0, 2.0) for z in (0.0, 2.0)]) + 500.0


def cube():
    points = np.concatenate([CORNERS[list(face)] for face in FACES])
    corners = np.concatenate([[[4 * i, 4 * i + 2, 4 * i + 1], [4 * i, 4 * i + 3, 4 * i + 2]] for i in range(6)])
    return Triangles(points=points, normals=np.zeros_like(points), corners=corners)


def test_a_cube_has_its_volume_and_turned_inside_out_the_negative_one():
    inside_out = Triangles(points=cube().points, normals=cube().normals, corners=cube().corners[:, ::-1])
    assert abs(cube().volume()) == pytest.approx(8.0, rel=1e-12)
    assert inside_out.volume() == pytest.approx(-cube().volume())


def test_far_from_the_origin_a_cube_has_the_same_volume():
    far = replace(cube(), points=cube().points / 3.0 + 1e7)
    assert far.volume() == pytest.approx(cube().volume() / 27.0, rel=1e-6)


def test_corners_that_lie_together_become_one_in_the_order_in_which_they_come():
    shaken = cube().points + np.random.default_rng(0).uniform(-1e-9, 1e-9, (24, 3))
    points, place = merged(shaken, 1e-6)
    assert points.shape == (8, 3)
    assert np.abs(points[place] - shaken).max() < 4e-9
    assert np.array_equal(place[:4], [0, 1, 2, 3])
    assert is_closed(place[cube().corners])


def test_a_surface_with_a_hole_or_a_face_turned_round_is_not_closed():
    _, place = merged(cube().points, 1e-6)
    closed = place[cube().corners]
    assert is_closed(closed)
    assert not is_closed(closed[1:])
    assert not is_closed(np.concatenate([closed[1:], closed[:1, ::-1]]))
    assert not is_closed(np.concatenate([closed, closed[:1]]))


def test_points_apart_stay_apart():
    points, place = merged(CORNERS, 1e-6)
    assert np.array_equal(points, CORNERS)
    assert np.array_equal(place, np.arange(8))
