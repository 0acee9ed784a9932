"""Boxes meet where every two of their sides do."""

import numpy as np
import pytest

from cadpanel.geometry.boxes import meeting


@pytest.mark.parametrize("seed", range(5))
def test_the_sweep_finds_the_pairs_that_asking_all_of_them_finds(seed):
    rng = np.random.default_rng(seed)
    least = rng.uniform(0.0, 10.0, (60, 3))
    greatest = least + rng.uniform(0.1, 3.0, (60, 3))
    wanted = {
        (i, j)
        for i in range(60)
        for j in range(i + 1, 60)
        if (least[i] < greatest[j]).all() and (least[j] < greatest[i]).all()
    }
    found = list(meeting(least, greatest, 0.0))
    assert set(found) == wanted
    assert len(found) == len(wanted)


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("way", [1.0, -1.0])
@pytest.mark.parametrize(("touch", "shared", "met"), [(0.0, 0.0, 0), (0.25, 0.125, 0), (0.25, 0.25, 0), (0.25, 0.5, 1)])
def test_boxes_meet_that_share_more_than_a_layer(axis, way, touch, shared, met):
    """Two boxes beside each other that share a layer along one axis, in either order; fractions are exact."""
    least = np.zeros((2, 3))
    least[1, axis] = way * (4.0 - shared)
    assert len(list(meeting(least, least + 4.0, touch))) == met


def test_boxes_that_only_touch_do_not_meet():
    least = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.999, 0.0, 0.0]])
    assert list(meeting(least, least + 1.0, 1e-6)) == [(0, 2), (1, 2)]
    assert list(meeting(np.empty((0, 3)), np.empty((0, 3)), 1e-6)) == []
