"""Panels are looked at from outside, and a building from where its panels face."""

from dataclasses import replace

import numpy as np
import pytest

from cadpanel.delivery.pages.folded_view import panel_view, view_from, whole_view
from cadpanel.geometry.shape import PolygonShape
from tests.shapes import random_panel

SQUARE = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]]) * 1000.0


def polygon(outline, normal):
    return PolygonShape(name="p", feature="planar-polygon", outline=outline, normal=np.array(normal))


def test_a_view_is_a_rotation_that_looks_against_its_direction():
    view = view_from(np.array([1.0, -2.0, 0.5]), np.array([0.0, 0.0, 1.0]))
    assert view.rows @ view.rows.T == pytest.approx(np.eye(3))
    assert np.linalg.det(view.rows) == pytest.approx(1.0)
    places, near = view.seen(np.array([[0.0, 0.0, 0.0], [1.0, -2.0, 0.5], [0.0, 0.0, 1.0]]))
    assert places[1] == pytest.approx([0.0, 0.0])
    assert near[1] > near[0]
    assert places[2, 0] == pytest.approx(0.0)
    assert places[2, 1] > 0.0


@pytest.mark.parametrize("seed", range(4))
def test_a_panel_is_seen_from_outside_with_its_end_0_below(seed):
    panel = random_panel(seed)
    view = panel_view(panel)
    _, _, normals = panel.rulings()
    assert view.rows[2] @ normals.mean(axis=0) > 0.0
    places, _ = view.seen(panel.corners())
    assert (places[0, :, 1] < places[1, :, 1]).all()


def test_all_panels_are_seen_from_where_they_face_and_a_ring_from_a_corner():
    roof, floor = polygon(SQUARE, [0.0, 0.0, 1.0]), polygon(SQUARE[::-1], [0.0, 0.0, -1.0])
    wall = polygon(SQUARE[:, [2, 0, 1]], [1.0, 0.0, 0.0])
    assert whole_view([roof]).rows[2] == pytest.approx([0.0, 0.0, 1.0])
    assert whole_view([wall]).rows[2] @ [1.0, 0.0, 0.0] > 0.9
    box = [roof, floor, wall, replace(wall, outline=wall.outline[::-1], normal=-wall.normal)]
    assert whole_view(box).rows[2] @ [1.0, -1.0, 0.8] > 1.6
