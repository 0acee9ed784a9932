"""How far off a surface curves and points may lie: in proportion to its size, and more in the middle of a chord."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cadpanel.brep.curves.reach import NEAR, NEAR_PART, ON_LIMIT, SAG_PART, far_off, reach_of, sags
from tests.cuts import surface_of
from tests.known_faces import arc_face, flat

parts = st.lists(st.floats(-0.5, 1.5), min_size=1, max_size=8)


def plate(side, x=0.0):
    return surface_of(flat([(x, 0, 0), (x + side, 0, 0), (x + side, side, 0), (x, side, 0)]))


@given(places=parts, length=st.floats(1.0, 1e4))
def test_a_chord_sags_most_in_its_middle_alike_from_both_ends_and_not_beyond_them(places, length):
    places = np.array(places)
    found = sags(places, length)
    np.testing.assert_allclose(found, sags(1.0 - places, length), atol=1e-9 * length)
    assert (found >= 0.0).all()
    assert (found <= SAG_PART * length * (1.0 + 1e-12)).all()
    assert (found[(places <= 0.0) | (places >= 1.0)] == 0.0).all()
    assert sags(np.array([0.5]), length)[0] == pytest.approx(SAG_PART * length)


def test_the_chord_of_an_arc_of_65_degrees_sags_as_much_as_is_allowed():
    half = np.radians(32.5)
    sagitta, chord = 1.0 - np.cos(half), 2.0 * np.sin(half)
    assert sagitta / chord == pytest.approx(SAG_PART, rel=0.05)


def test_reach_grows_with_the_surface_from_a_least_one_on():
    assert reach_of(plate(100.0)) == NEAR + ON_LIMIT
    large = plate(4000.0)
    assert reach_of(large) == pytest.approx(NEAR_PART * large.size)
    assert reach_of(large) > NEAR


def assert_far(found, place, distance):
    assert found is not None
    assert found[0] == place
    assert found[1] == distance


def test_the_point_that_lies_farthest_off_all_surfaces_is_told_with_its_distance():
    surfaces = [plate(1000.0), plate(1000.0, x=5000.0)]
    reach = reach_of(surfaces[0])
    near = [(500.0, 500.0, 0.9 * reach), (5500.0, 500.0, -0.9 * reach)]
    assert far_off(surfaces, np.array(near)) is None
    far = [*near, (500.0, 500.0, 1.1 * reach), (3000.0, 500.0, 0.0)]
    assert_far(far_off(surfaces, np.array(far)), 3, pytest.approx(2000.0))
    assert_far(far_off(surfaces, np.array(far[:3])), 2, pytest.approx(1.1 * reach))


def test_distances_count_to_the_nearest_face_of_a_surface():
    surface = surface_of(arc_face(1000.0, 0.0, 60.0), arc_face(1000.0, 60.0, 120.0))
    inside = np.array([(500.0, 700.0 * np.cos(1.5), 700.0 * np.sin(1.5))])
    assert_far(far_off([surface], inside), 0, pytest.approx(300.0))
