"""The nearest points of polylines."""

import numpy as np

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
