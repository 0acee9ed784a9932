"""The blank about an outline: no rectangle is smaller, and turning the outline changes nothing."""

import math
from dataclasses import replace

import numpy as np
import pytest

from cadpanel.geometry.smallest_rectangle import smallest_rectangle


def turned(points, angle):
    c, s = math.cos(angle), math.sin(angle)
    return points @ np.array([[c, s], [-s, c]])


@pytest.mark.parametrize("angle", [0.0, 0.3, 1.2, 2.5])
def test_a_turned_rectangle_is_its_own_blank(angle):
    blank = smallest_rectangle(turned(np.array([[0, 0], [3, 0], [3, 2], [0, 2], [1, 1]], dtype=float), angle))
    assert (blank.length, blank.width) == pytest.approx((3.0, 2.0))
    assert abs(blank.direction @ turned(np.array([1.0, 0.0]), angle)) == pytest.approx(1.0)


@pytest.mark.parametrize("seed", range(10))
def test_no_turned_box_is_smaller(seed):
    points = np.random.default_rng(seed).normal(size=(30, 2)) * [3.0, 1.0]
    blank = smallest_rectangle(points)
    boxes = [np.ptp(turned(points, angle), axis=0) for angle in np.linspace(0.0, math.pi, 721)]
    smallest = min(float(box.prod()) for box in boxes)
    assert blank.length * blank.width <= smallest
    assert blank.length * blank.width >= 0.99 * smallest


def test_a_part_fits_a_sheet_either_way_round_and_not_a_hair_beyond():
    blank = smallest_rectangle(np.array([[0, 0], [3, 0], [3, 2], [0, 2]], dtype=float))
    assert blank.fits(3.0, 2.0)
    assert blank.fits(2.0, 3.0)
    assert not blank.fits(2.999, 2.5)
    assert not blank.fits(1.999, 5.0)
    # What a millionth of a millimetre is too long or too wide fits as it stands.
    for length, width in ((3.0 + 1e-6, 2.0), (3.0, 2.0 + 1e-6)):
        assert replace(blank, length=length, width=width).fits(3.0, 2.0)
        assert not replace(blank, length=length + 1e-9, width=width + 1e-9).fits(3.0, 2.0)
