"""Curves of points reach as far as the curves that the points lie on."""

import numpy as np
import pytest

from cadpanel.geometry.sampled_curves import POINTS, reach


def test_curves_reach_as_far_between_their_points_as_circles_do():
    turns = np.linspace(0.0, 1.0, POINTS)
    curves = np.stack([900.0 * np.stack([np.cos(turns), np.sin(turns), 0.0 * turns], axis=-1)] * 2)
    curves[1, :, 2] += 5.0
    angles = np.random.default_rng(1).uniform(-np.pi, np.pi, 200)
    ways = np.stack([np.cos(angles), np.sin(angles), np.full(200, 0.3)], axis=-1)
    least, greatest = reach(curves, ways)
    ends = 900.0 * np.stack([np.cos(angles), np.cos(angles - 1.0)])
    top = np.where((angles > 0.0) & (angles < 1.0), 900.0, ends.max(axis=0))
    low = np.where((angles > -np.pi) & (angles < 1.0 - np.pi), -900.0, ends.min(axis=0))
    assert greatest[:, 0] == pytest.approx(top, abs=1e-8)
    assert least[:, 0] == pytest.approx(low, abs=1e-8)
    assert greatest[:, 1] == pytest.approx(top + 1.5, abs=1e-8)
    assert (greatest[:, 0] > 899.0).any()


def test_of_no_curves_there_is_nothing():
    assert reach(np.empty((0, POINTS, 3)), np.eye(3))[0].shape == (3, 0)


def test_a_curve_square_to_a_direction_reaches_just_as_far_as_it_lies():
    turns = np.linspace(0.0, 1.0, POINTS)
    curve = np.stack([np.cos(turns), np.sin(turns), np.full(POINTS, 7.0)], axis=-1)
    assert np.ravel(reach(curve[None], np.array([[0.0, 0.0, 1.0]]))).tolist() == [7.0, 7.0]
