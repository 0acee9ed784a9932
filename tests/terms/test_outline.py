"""Outlines of some panels taken by themselves."""

import numpy as np

from cadpanel.terms.outline import Level


def test_level_points_of_some_panels_are_those_of_their_panels_counted_anew():
    """Also of the first panel and of one beyond all that have any."""
    level = Level(
        panels=np.array([0, 2, 2, 3]),
        points=np.array([4, 5, -1, 7]),
        normals=np.arange(12.0).reshape(4, 3),
        offsets=np.array([0.1, 0.2, 0.3, 0.4]),
    )
    some = level.take(np.array([5, 2, 0]))
    assert some.panels.tolist() == [2, 1, 1]
    assert some.points.tolist() == [4, 5, -1]
    assert some.normals.tolist() == level.normals[:3].tolist()
    assert some.offsets.tolist() == [0.1, 0.2, 0.3]
    assert level.take(np.array([1])).panels.tolist() == []
    assert level.take(np.zeros(0, dtype=np.intp)).panels.tolist() == []
