"""Which way a strip runs is told by its normals first, then by its lengths; where it begins, by the axes of space."""

import numpy as np
import pytest
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace
from OCP.gp import gp_Pln

from cadpanel.brep.faces.inside_test import InsideTest
from cadpanel.brep.skin.strip_direction import ALIKE, STRAIGHT, runs_back, turning_angles, way_along


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


@pytest.mark.parametrize("axis", range(3))
def test_a_way_against_the_axis_that_it_follows_most_runs_back(axis):
    way = np.array([0.3, 0.3, 0.3])
    way[axis] = 1.0
    assert not runs_back(way)
    assert runs_back(-way)
    assert not runs_back(-way, slack=1.5)


def test_normals_turn_by_the_angles_between_them():
    angles = np.array([0.0, 0.1, 0.4, 1.5, 1.5 + np.pi])
    normals = np.stack([np.cos(angles), np.sin(angles), np.zeros(5)], axis=-1)
    np.testing.assert_allclose(turning_angles(normals), np.diff(angles), atol=1e-12)
    np.testing.assert_allclose(
        turning_angles(np.stack([normals, normals[::-1]])), [np.diff(angles), np.diff(angles)[::-1]]
    )


def test_the_inside_of_a_face_far_along_its_parameters_is_told_as_closely_as_near_their_origin():
    """What counts as on the border hangs on how wide the range is, and not on where it lies."""
    for far in (0.0, 1e6):
        face = BRepBuilderAPI_MakeFace(gp_Pln(), far, far + 1.0, 0.0, 1.0).Face()
        test = InsideTest(face, np.array([[far, far + 1.0], [0.0, 1.0]]))
        places = np.array([[far + 0.5, 0.5], [far + 0.5, 1e-4], [far + 0.5, 0.0], [far + 0.5, -1e-4]])
        assert test.inside(places).tolist() == [True, True, False, False]
        assert test.encloses(places).tolist() == [True, True, True, False]
