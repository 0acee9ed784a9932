"""Panels without a seam between them are set back where their sheets would meet, and only there."""

from typing import Any

import numpy as np
import pytest

from cadpanel.geometry.corner_parting import Walls, part_at_corners
from cadpanel.geometry.joints import cut_to_seams, seam_planes, walls_of
from tests.joined import SIDE, polygon, quadrilaterals, seams, turned


def between(one: Any, other: Any, depth: float) -> float:
    """How wide a layer of space there is between two sheets, square to some wall of either, mm; negative for none."""
    corners = [np.concatenate([panel.outline, panel.offset(depth).outline]) for panel in (one, other)]
    best = -np.inf
    for panel, own, others in ((one, *corners), (other, *corners[::-1])):
        for edge in range(len(panel.outline)):
            up = panel.posts[edge] if panel.posts is not None else panel.normal
            along = panel.outline[(edge + 1) % len(panel.outline)] - panel.outline[edge]
            way = np.cross(along, up) / np.linalg.norm(np.cross(along, up))
            best = max(best, float((others @ way).min() - (own @ way).max()))
    return best


@pytest.mark.parametrize("depth", [-3.0, -20.0, 20.0])
@pytest.mark.parametrize("skew", [0.0, 0.3])
def test_opposite_panels_in_a_corner_are_parted_by_a_wall_and_were_not_before(depth, skew):
    panels = quadrilaterals(2, sags=(300.0, 250.0), skew=skew)
    own = seams(panels)
    walls = walls_of(4, own, seam_planes(panels, own), 0.0)
    before = [panel.cut_back(wall, depth) for panel, wall in zip(panels, walls, strict=True)]
    opposite = [(0, 3), (1, 2)]
    assert min(between(before[i], before[j], depth) for i, j in opposite) < -1e-4
    after: Any = cut_to_seams(panels, own, 0.0, depth).shapes
    assert min(between(after[i], after[j], depth) for i, j in opposite) > -1e-8
    set_back = [np.abs(one.corners() - other.corners()).max() for one, other in zip(before, after, strict=True)]
    assert 0.0 < max(set_back) < 0.5 * abs(depth)


def test_a_joint_that_is_wider_leaves_nothing_to_part():
    panels = quadrilaterals(2, sags=(300.0, 250.0))
    own = seams(panels)
    walls = walls_of(4, own, seam_planes(panels, own), 10.0)
    plain = [panel.cut_back(wall, -20.0) for panel, wall in zip(panels, walls, strict=True)]
    for one, other in zip(plain, cut_to_seams(panels, own, 10.0, -20.0).shapes, strict=True):
        assert np.array_equal(one.corners(), other.corners())


def square(name, shift, rise=0.0):
    corners = SIDE * np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, rise], [0.0, 1.0, rise]])
    return polygon(name, corners + shift)


def test_panels_that_meet_without_a_seam_are_set_back_along_a_free_edge():
    # The second one rises from the first one's edge, half a panel farther on: their sheets cross under it.
    panels = [square("A", [0.0, 0.0, 0.0]), square("B", [500.0, SIDE, 0.0], rise=0.3)]
    walls: list[Walls] = [{}, {}]
    cut: list[Any] = list(panels)
    assert between(cut[0], cut[1], 20.0) < -1.0
    part_at_corners(cut, panels, walls, [], 20.0)
    assert between(cut[0], cut[1], 20.0) > -1e-8
    assert [sorted(own) for own in walls] == [["edge 2"], ["edge 0"]]


@pytest.mark.parametrize("way", [1.0, -1.0])
@pytest.mark.parametrize("lean", [0.3, -0.3])
def test_panels_that_pass_each_other_are_left_as_they_are_though_none_is_beyond_a_wall_of_the_other(way, lean):
    """One reaches over the other by 1 mm, 50 mm above it; both lean, so that their boxes meet."""
    rotation = np.array([[1.0, 0.0, 0.0], [0.0, np.cos(lean), -np.sin(lean)], [0.0, np.sin(lean), np.cos(lean)]])
    flat = [square("A", [0.0, 0.0, 0.0]), square("B", [way * (SIDE - 1.0), 0.0, 50.0])]
    panels = [turned(panel, rotation, np.array([5000.0, -3000.0, 0.0])) for panel in flat]
    cut: list[Any] = list(panels)
    part_at_corners(cut, panels, [{}, {}], [], -3.0)
    assert cut[0] is panels[0]
    assert cut[1] is panels[1]


def test_panels_that_cover_each_other_are_left_as_they_are():
    panels = [square("A", [0.0, 0.0, 0.0]), square("B", [500.0, 500.0, 1.0])]
    cut: list[Any] = list(panels)
    part_at_corners(cut, panels, [{}, {}], [], -3.0)
    assert cut[0] is panels[0]
    assert cut[1] is panels[1]
