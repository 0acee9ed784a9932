"""Edges lie along each other across a gap up to the tolerance, over most of both, and only those of different faces."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cadpanel.brep.cutting.edges_across_gaps import bridges, points_along
from tests.drawn import circle, line

TOLERANCE = 1.0


def pair(gap, shift=0.0, length=1000.0):
    return [line((0, 0, 0), (length, 0, 0)), line((length + shift, gap, 0), (shift, gap, 0))]


@settings(max_examples=20)
@given(gap=st.floats(0.0, 3.0))
def test_edges_are_bridged_up_to_the_tolerance_whichever_way_they_run(gap):
    assert bridges(pair(gap), [1, 2], TOLERANCE) == ([(0, 1)] if gap <= TOLERANCE else [])


def test_edges_of_one_face_are_never_bridged():
    assert bridges(pair(0.1), [1, 1], TOLERANCE) == []
    assert bridges([*pair(0.1), line((0, 500, 0), (10, 500, 0))], [1, 1, 2], TOLERANCE) == []


@pytest.mark.parametrize(("shift", "bridged"), [(0.0, True), (40.0, True), (60.0, False), (600.0, False)])
def test_edges_that_are_shifted_along_each_other_belong_together_while_their_middles_are_near(shift, bridged):
    assert bool(bridges(pair(0.5, shift), [1, 2], TOLERANCE)) == bridged


def test_edges_that_cross_do_not_lie_along_each_other_and_points_are_no_edges():
    assert bridges([line((0, 0, 0), (1000, 0, 0)), line((500, -500, 0), (500, 500, 0))], [1, 2], TOLERANCE) == []
    short = [line((0, 0, 0), (0.5, 0, 0)), line((0, 0.1, 0), (0.5, 0.1, 0))]
    assert bridges(short, [1, 2], TOLERANCE) == []


def test_many_edges_are_paired_with_their_own():
    places = [(y, z) for y in (0, 100, 200, 300) for z in (0.0, 0.4)]
    edges = [line((0, y, z), (900, y, z)) for y, z in places]
    assert bridges(edges, [1, 2] * 4, TOLERANCE) == [(0, 1), (2, 3), (4, 5), (6, 7)]


def test_points_along_an_edge_are_even_and_reach_both_ends():
    points = points_along(circle((0.0, 0.0, 0.0), 300.0))
    np.testing.assert_allclose(np.linalg.norm(points, axis=1), 300.0)
    np.testing.assert_allclose(points[0], points[-1], atol=1e-9)
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    np.testing.assert_allclose(steps, steps[0])
