"""The best motion finds a motion that was made, lays a changed figure as near as can be, and never turns one over."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cadpanel.geometry.congruence import best_motion

FIGURE = np.array([[0.0, 0.0], [2000.0, 10.0], [1900.0, 900.0], [50.0, 1000.0]])


def turned(points, angle):
    return points @ np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])


@given(angle=st.floats(-4.0, 4.0), x=st.floats(-1e5, 1e5), y=st.floats(-1e5, 1e5))
def test_a_motion_is_found_again(angle, x, y):
    there = turned(FIGURE, angle) + np.array([x, y])
    assert best_motion(FIGURE, there).moved(FIGURE) == pytest.approx(there, abs=1e-8)


def test_no_motion_nearby_is_better():
    there = turned(FIGURE, 0.3) + np.random.default_rng(1).normal(size=FIGURE.shape)
    best = best_motion(FIGURE, there)

    def miss(points):
        return ((points - there) ** 2).sum()

    least = miss(best.moved(FIGURE))
    for shift in ([1e-3, 0.0], [0.0, -1e-3]):
        assert miss(best.moved(FIGURE) + shift) > least
    middle = there.mean(axis=0)
    for angle in (-1e-5, 1e-5):
        assert miss(turned(best.moved(FIGURE) - middle, angle) + middle) > least


def test_a_mirror_image_is_another_figure():
    mirrored = FIGURE * [1.0, -1.0]
    assert np.abs(best_motion(FIGURE, mirrored).moved(FIGURE) - mirrored).max() > 100.0


@pytest.mark.parametrize("size", [1e-6, 1e-3, 1.0])
def test_however_small_a_figure_is_it_is_turned(size):
    there = turned(size * FIGURE, 2.0)
    assert best_motion(size * FIGURE, there).moved(size * FIGURE) == pytest.approx(there, abs=1e-9 * size)


def test_a_point_is_laid_on_a_point():
    assert best_motion(np.zeros((2, 2)), np.ones((2, 2))).moved(np.zeros((2, 2))) == pytest.approx(np.ones((2, 2)))
