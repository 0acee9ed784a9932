"""Which way a strip runs is told by its normals first, then by its lengths; where it begins, by the axes of space."""

import numpy as np
import pytest

from cadpanel.brep.skin.strip_direction import ALIKE, STRAIGHT, turning_angles, way_along


@pytest.mark.parametrize(
    ("rates", "lengths", "along"),
    [
        ((1e-3, 2e-3), (100.0, 900.0), 0),  # u turns slowly, however short it is
        ((2e-3, 1e-3), (900.0, 100.0), 1),
        ((1e-3, 1e-3 * 0.99 * ALIKE), (100.0, 900.0), 1),  # alike, so the longer one
        ((1e-3, 1e-3 * 1.01 * ALIKE), (100.0, 900.0), 0),
        ((0.0, 0.99 * STRAIGHT), (100.0, 900.0), 1),  # both straight
        ((0.0, 1.01 * STRAIGHT), (100.0, 900.0), 0),
        ((0.0, 0.0), (500.0, 500.0), 0),
    ],
)
def test_a_strip_runs_where_normals_turn_slowly_or_the_longer_way(rates, lengths, along):
    assert way_along(rates, lengths) == along
    if rates[0] != rates[1]:
        assert way_along(rates[::-1], lengths[::-1]) == 1 - along


def test_normals_turn_by_the_angles_between_them():
    angles = np.array([0.0, 0.1, 0.4, 1.5, 1.5 + np.pi])
    normals = np.stack([np.cos(angles), np.sin(angles), np.zeros(5)], axis=-1)
    np.testing.assert_allclose(turning_angles(normals), np.diff(angles), atol=1e-12)
    np.testing.assert_allclose(
        turning_angles(np.stack([normals, normals[::-1]])), [np.diff(angles), np.diff(angles)[::-1]]
    )
