"""Rings: found whichever way their faces run, begun where they come first in space, cut into panels of equal length."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from OCP.TopoDS import TopoDS

from cadpanel.brep.skin.ring import find_ring
from cadpanel.brep.splitting.splitter import area_of
from tests.cuts import surface_of
from tests.known_faces import arc_face

RADIUS, LENGTH = 800.0, 400.0
ROUND = 2.0 * np.pi * RADIUS


def tube(*stops, length=LENGTH):
    return [arc_face(RADIUS, first, last, length) for first, last in pairwise(stops)]


@settings(max_examples=6)
@given(stops=st.lists(st.integers(2, 34), min_size=1, max_size=4, unique=True), count=st.integers(2, 7))
def test_a_ring_is_as_long_as_its_circle_and_its_panels_are_equally_long(stops, count):
    ring = find_ring(surface_of(*tube(0.0, *(10.0 * stop for stop in sorted(stops)), 360.0)))
    assert ring is not None
    assert len(ring.columns) == len(stops) + 1
    assert ring.length == pytest.approx(ROUND, rel=1e-9)
    assert ring.longest == pytest.approx(ROUND, rel=1e-9)
    assert ring.width == pytest.approx(LENGTH, rel=1e-9)
    areas = [sum(map(area_of, group)) for group in ring.cut(count, 1.0)]
    assert areas == pytest.approx([ROUND * LENGTH / count] * count, rel=1e-6)


@pytest.mark.parametrize("order", [(0, 1, 2), (2, 0, 1), (1, 2, 0)])
@pytest.mark.parametrize("reverse", [False, True])
def test_the_order_of_the_faces_and_the_side_of_their_normals_change_no_panel(order, reverse):
    faces = tube(20.0, 130.0, 250.0, 380.0)
    wanted = [middle(group) for group in ring_of(*faces).cut(4, 1.0)]
    turned = [TopoDS.Face_s(faces[k].Reversed()) if reverse else faces[k] for k in order]
    found = [middle(group) for group in ring_of(*turned).cut(4, 1.0)]
    np.testing.assert_allclose(found, wanted, atol=1e-6)


def ring_of(*faces):
    ring = find_ring(surface_of(*faces))
    assert ring is not None
    return ring


def middle(faces):
    surface = surface_of(*faces)
    return np.concatenate([face.samples.points for face in surface.faces]).mean(axis=0)


def test_a_ring_runs_counterclockwise_about_the_axis_that_it_turns_about():
    """Seen from where x, about which it turns, points to."""
    ring = ring_of(*tube(0.0, 120.0, 240.0, 360.0))
    angles = np.concatenate(
        [np.arctan2(*column.middles(np.linspace(0.0, 1.0, 20)).T[[2, 1]]) for column in ring.columns]
    )
    assert (np.diff(np.unwrap(angles)) >= -1e-9).all()


def test_a_cut_beside_a_joint_is_made_there_within_the_tolerance():
    """Half-way round is 1 degree, 14 mm, from where the two faces meet."""
    ring = ring_of(*tube(0.0, 181.0, 360.0))
    assert sorted(len(group) for group in ring.cut(2, 20.0)) == [1, 1]
    assert sorted(len(group) for group in ring.cut(2, 10.0)) == [1, 2]


@pytest.mark.parametrize("stops", [(0.0, 180.0, 350.0), (0.0, 340.0)])
def test_what_does_not_close_is_no_ring(stops):
    assert find_ring(surface_of(*tube(*stops))) is None
