"""Corners that coincide become one, the first of them, and no others do."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cadpanel.brep.cutting.mesh_t_junctions import parted, round_of, unordered, uses_of
from cadpanel.brep.cutting.mesh_weld import welded

TOLERANCE = 0.01
GRID = np.array([(x, y, 0.0) for y in range(3) for x in range(3)]) * 1000.0
QUADS = ((0, 1, 4, 3), (1, 2, 5, 4), (3, 4, 7, 6), (4, 5, 8, 7))


def apart(random, off):
    """Every face with corners of its own, each moved by no more than `off` along each axis."""
    corners = np.concatenate([GRID[list(face)] for face in QUADS])
    faces = tuple(tuple(range(4 * k, 4 * k + 4)) for k in range(len(QUADS)))
    return corners + random.uniform(-off, off, corners.shape), faces


@given(seed=st.integers(0, 2**32 - 1))
def test_welding_faces_apart_gives_the_mesh_in_which_they_share_corners(seed):
    corners, faces = apart(np.random.default_rng(seed), 0.4 * TOLERANCE)
    found, gone = welded(corners, faces, TOLERANCE)
    assert gone == len(corners) - len(GRID)
    flat = [one for face in found for one in face]
    wanted = np.concatenate([GRID[list(face)] for face in QUADS])
    np.testing.assert_allclose(corners[flat], wanted, atol=TOLERANCE)
    shared = [edge for edge, uses in uses_of(found).items() if uses == 2]
    assert len(shared) == 4
    assert welded(corners, found, TOLERANCE)[0] == found
    first = [np.flatnonzero(np.abs(corners - place).max(axis=1) < TOLERANCE).min() for place in GRID]
    assert set(flat) == set(first)


@pytest.mark.parametrize(("off", "gone"), [(0.0, 1), (0.9, 1), (1.1, 0)])
def test_corners_coincide_up_to_the_tolerance_along_each_axis(off, gone):
    corners = np.array([(0.0, 0.0, 0.0), (10.0, 0.0, 0.0), (10.0, 10.0, 0.0), (off * TOLERANCE, off * TOLERANCE, 0.0)])
    assert welded(corners, [(0, 1, 2), (3, 1, 2)], TOLERANCE)[1] == gone


def test_a_face_loses_a_corner_that_coincides_with_its_neighbour_also_at_its_end():
    corners = np.array([(0.0, 0.0, 0.0), (10.0, 0.0, 0.0), (10.0, 0.0, 0.0), (10.0, 10.0, 0.0), (0.0, 0.0, 0.0)])
    assert welded(corners, [(0, 1, 2, 3, 4)], TOLERANCE) == (((1, 3, 0),), 2)


def bricks(aside=0.0, along=0.5):
    """A long face below two short ones: the corner between these lies beside the middle of its edge."""
    middle = 2000.0 * along
    below = [(0, 0, 0), (2000, 0, 0), (2000, 1000, 0), (0, 1000, 0), (middle, 1000 + aside, 0)]
    corners = np.array([*below, (0, 2000, 0), (middle, 2000, 0), (2000, 2000, 0)], dtype=float)
    return corners, ((0, 1, 2, 3), (3, 4, 6, 5), (4, 2, 7, 6))


@given(aside=st.floats(-90.0, 90.0), along=st.floats(0.05, 0.95))
def test_a_corner_of_others_on_an_edge_becomes_a_corner_of_its_face(aside, along):
    corners, faces = bricks(aside, along)
    found, count = parted(corners, faces)
    assert count == 1
    assert found == ((0, 1, 2, 4, 3), *faces[1:])
    assert parted(corners, found) == (found, 0)


@pytest.mark.parametrize(("aside", "along"), [(110.0, 0.5), (-110.0, 0.5), (0.0, 0.01)])
def test_a_corner_beside_an_edge_or_by_its_end_is_none_of_its_face(aside, along):
    corners, faces = bricks(aside, along)
    assert parted(corners, faces) == (faces, 0)


def test_an_edge_is_parted_only_if_another_face_shares_each_of_its_parts():
    corners, faces = bricks()
    assert parted(corners, faces[:2]) == (faces[:2], 0)


def test_edges_go_round_a_face_and_count_whichever_way_they_run():
    assert round_of((4, 2, 7)) == [(4, 2), (2, 7), (7, 4)]
    assert unordered(5, 3) == unordered(3, 5) == (3, 5)
    assert uses_of(QUADS)[1, 4] == 2
    assert uses_of(QUADS)[0, 1] == 1
