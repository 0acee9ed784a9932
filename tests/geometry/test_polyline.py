"""Distances to curves of which only points are known."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cadpanel.geometry.polyline import distances_to_curves


def helix(parts, radius, turn, pitch):
    angle = turn * parts
    return np.stack([radius * np.cos(angle), radius * np.sin(angle), pitch * angle], axis=-1)


@given(
    radius=st.floats(50.0, 50_000.0),
    turn=st.floats(0.05, 2.5),
    slope=st.floats(0.0, 1.0),
    off=st.floats(1e-3, 1e-2),
    side=st.sampled_from([-1.0, 1.0]),
    even=st.floats(0.0, 0.2),
)
@settings(max_examples=100, deadline=None)
def test_distance_off_a_helix_is_what_it_was_moved_by_on_either_side(radius, turn, slope, off, side, even):
    """Where chords would be off by up to 2 % of the radius, and however unevenly the points lie."""
    parts = np.linspace(0.0, 1.0, 65)
    curve = helix(parts + even * parts * (1.0 - parts), radius, turn, slope * radius)
    inside = np.linspace(0.02, 0.98, 50)
    foot = helix(inside, radius, turn, slope * radius)
    outwards = np.stack([np.cos(turn * inside), np.sin(turn * inside), 0.0 * inside], axis=-1)
    found = distances_to_curves((foot + side * off * radius * outwards)[None], curve[None])
    np.testing.assert_allclose(found[0], off * radius, atol=1e-6 * radius)


def test_distance_beyond_an_end_is_to_the_end():
    line = np.linspace([0.0, 0.0, 0.0], [100.0, 0.0, 0.0], 9)
    assert distances_to_curves(np.array([[[103.0, 4.0, 0.0], [-3.0, 4.0, 0.0]]]), line[None])[0] == pytest.approx(5.0)


@pytest.mark.parametrize("turn", [30.0, 90.0, 150.0])
def test_no_curve_overshoots_a_corner(turn):
    way = np.array([np.cos(np.radians(turn)), np.sin(np.radians(turn)), 0.0])
    steps = np.arange(1.0, 9.0)[:, None]
    corner = np.concatenate([-steps[::-1] * [1.0, 0.0, 0.0], np.zeros((1, 3)), steps * way])
    between = 0.5 * (corner[1:] + corner[:-1])
    assert distances_to_curves(between[None], corner[None])[0] == pytest.approx(0.0, abs=1e-12)


def test_points_that_lie_on_each_other_are_met_by_chords():
    line = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [3.0, 0.0, 0.0]])
    assert distances_to_curves(np.array([[[1.0, 2.0, 0.0], [2.5, 2.0, 0.0]]]), line[None])[0] == pytest.approx(2.0)
