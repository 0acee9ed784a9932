"""The nearest points of polylines."""

import numpy as np
import pytest

from cadpanel.geometry.line_feet import line_feet

LINE = np.array([[[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [2.0, 2.0, 0.0]]])


def test_feet_are_on_the_segment_or_corner_that_is_nearest() -> None:
    points = np.array([[[1.0, 0.5, 3.0], [3.0, -1.0, 0.0], [5.0, 1.5, 0.0], [-1.0, 0.0, 0.0], [2.0, 9.0, 0.0]]])
    feet, ways = line_feet(points, LINE)
    assert feet[0].tolist() == [[1, 0, 0], [2, 0, 0], [2, 1.5, 0], [0, 0, 0], [2, 2, 0]]
    assert ways[0].tolist() == [[1, 0, 0], [0, 0, 0], [0, 1, 0], [0, 0, 0], [0, 0, 0]]


def test_no_point_of_a_line_is_nearer_than_its_foot() -> None:
    random = np.random.default_rng(1)
    lines, points = random.normal(size=(3, 6, 3)), random.normal(size=(3, 8, 3))
    off = np.linalg.norm(points - line_feet(points, lines)[0], axis=2)
    share = np.linspace(0.0, 1.0, 501)[:, None, None, None]
    dense = ((1.0 - share) * lines[:, :-1] + share * lines[:, 1:]).transpose(1, 0, 2, 3).reshape(3, -1, 3)
    least = np.linalg.norm(points[:, :, None] - dense[:, None], axis=3).min(axis=2)
    assert (off <= least).all()
    assert np.allclose(off, least, atol=0.02)


def test_feet_grow_with_the_unit_of_length_and_ways_stay():
    random = np.random.default_rng(2)
    lines, points = random.normal(size=(3, 6, 3)), random.normal(size=(3, 8, 3))
    feet, ways = line_feet(points, lines)
    assert set(np.round(np.linalg.norm(ways, axis=2), 9).ravel()) == {0.0, 1.0}
    for size in (1e-3, 1e3):
        found, same = line_feet(size * points, size * lines)
        assert np.allclose(found, size * feet, rtol=1e-9, atol=0.0)
        assert np.allclose(same, ways, atol=1e-9)


@pytest.mark.parametrize(("corners", "asked"), [(40, 50), (2, 3000)])
def test_many_lines_have_the_feet_that_each_of_them_has(corners, asked):
    random = np.random.default_rng(3)
    lines, points = random.normal(size=(9, corners, 3)), random.normal(size=(9, asked, 3))
    feet, ways = line_feet(points, lines)
    for i in range(9):
        own = line_feet(points[i : i + 1], lines[i : i + 1])
        assert np.array_equal(own[0][0], feet[i])
        assert np.array_equal(own[1][0], ways[i])


def test_a_line_that_stands_still_has_a_foot_and_no_way():
    feet, ways = line_feet(np.array([[[1.0, 2.0, 3.0]]]), np.ones((1, 3, 3)))
    assert feet.tolist() == [[[1.0, 1.0, 1.0]]]
    assert ways.tolist() == [[[0.0, 0.0, 0.0]]]
