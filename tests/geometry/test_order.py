"""What comes first is the same however the numbers are rounded, also where symmetry leaves a tie."""

import numpy as np
import pytest

from cadpanel.geometry.order import EQUAL, first_way, goes_backwards, levels, order_in_space, principal_axes

DRAWS = 50
NOISE = 1e-12


def drawn(numbers):
    """The same numbers as other processors may round them."""
    numbers = np.asarray(numbers, dtype=float)
    random = np.random.default_rng(5)
    return [numbers, *(numbers + NOISE * random.normal(size=(DRAWS, *numbers.shape)))]


@pytest.mark.parametrize(
    ("way", "backwards"),
    [
        ((2.0, -1.0, 0.0), False),
        ((1.0, -2.0, 0.0), True),
        ((-1.0, 1.0, 0.0), True),
        ((1.0, -1.0, -1.0), False),
        ((0.0, 0.5, -0.5), False),
        ((1.0 - 2.0 * EQUAL, -1.0, 0.0), True),
        ((1.0 - 0.5 * EQUAL, -1.0, 0.0), False),
    ],
)
def test_way_goes_backwards_by_the_first_axis_that_it_follows_most(way, backwards):
    assert {goes_backwards(own) for own in drawn(way)} == {backwards}


def test_way_that_leads_nowhere_does_not_go_backwards():
    assert not any(goes_backwards(own, 1e-3) for own in drawn((0.0, 0.0, 0.0)))
    assert not goes_backwards(np.zeros(3))


@pytest.mark.parametrize(
    ("ways", "first"),
    [
        (((0.0, 1.0, 0.0), (-1.0, 0.0, 0.0)), 1),
        (((5.0, -5.0, 0.0), (1.0, 1.0, 0.0)), 1),
        (((1.0, 1.0, 0.0), (5.0, -5.0, 0.0)), 0),
        (((-1.0, -1.0, 0.0), (1.0, -1.0, 0.0)), 0),
        (((0.0, 0.0, 1.0), (0.0, 1.0, 0.0)), 1),
    ],
)
def test_first_way_is_told_by_the_axes_and_not_by_rounding(ways, first):
    assert {first_way(own) for own in drawn(ways)} == {first}


def assert_alike(found):
    for axes in found:
        assert axes @ axes.T == pytest.approx(np.eye(3), abs=1e-9)
        assert axes == pytest.approx(found[0], abs=1e-6)


@pytest.mark.parametrize("sides", [(3, 2, 1), (2, 2, 1), (3, 2, 2), (2, 2, 2), (3, 3, 0), (3, 0, 0), (2, 1, 1e-9)])
@pytest.mark.parametrize("turn", [0.0, 0.3, np.pi / 4])
def test_axes_of_a_box_do_not_hang_on_rounding(sides, turn):
    corners = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * np.array(sides)
    turned = np.array([[np.cos(turn), -np.sin(turn), 0.0], [np.sin(turn), np.cos(turn), 0.0], [0.0, 0.0, 1.0]])
    assert_alike([principal_axes(points) for points in drawn(corners @ turned.T)])


def test_axes_of_a_box_follow_its_sides_in_their_order():
    corners = np.array([(x, y, z) for x in (-1, 1) for y in (-2, 2) for z in (-3, 3)], dtype=float)
    assert principal_axes(corners) == pytest.approx(np.eye(3)[::-1], abs=1e-12)


@pytest.mark.parametrize("shift", [(5.0, -3.0, 8.0), (-100.0, 0.0, 20.0)])
def test_axes_are_the_same_wherever_the_points_stand_and_in_whatever_unit(shift):
    points = np.random.default_rng(2).normal(size=(20, 3)) * np.array([1.0, 2.0, 3.0])
    assert principal_axes(points + np.array(shift)) == pytest.approx(principal_axes(points), abs=1e-9)
    assert principal_axes(1e6 * points) == pytest.approx(principal_axes(points), abs=1e-9)


@pytest.mark.parametrize("count", [1, 2])
def test_one_point_or_two_have_axes_too(count):
    assert_alike([principal_axes(points) for points in drawn(np.eye(3)[:count])])


def test_values_on_either_side_of_a_half_share_a_level():
    for values in drawn([0.5, 1.5, 0.5, 2.5]):
        assert levels(values, 1e-3).tolist() == [0, 1, 0, 2]


def test_equal_values_share_a_level_where_nothing_is_tolerated():
    assert levels(np.array([2.0, 1.0, 2.0, 1.0 + 1e-15]), 0.0).tolist() == [2, 0, 2, 1]


def test_order_in_space_is_by_the_first_coordinate_that_differs():
    for points in drawn([(0.5, 1.0, 0.0), (0.5, 0.0, 2.0), (0.5, 0.0, 1.0), (0.0, 9.0, 9.0)]):
        assert order_in_space(points, 1e-3).tolist() == [3, 2, 1, 0]
