"""Where folds begin, and how far reliefs keep them from each other."""

from __future__ import annotations

import numpy as np
import pytest

from cadpanel.geometry.tray_plan import Bed, plan_tray
from tests.trays import RULE, THICKNESS, tray


def test_a_square_with_upright_walls_is_folded_as_far_inside_as_radius_and_sheet_are_thick() -> None:
    corners = np.array([[0.0, 0.0, 0.0], [400.0, 0.0, 0.0], [400.0, 400.0, 0.0], [0.0, 400.0, 0.0]])
    up = np.array([0.0, 0.0, 1.0])
    bed = Bed(name="S", corners=corners, posts=np.tile(up, (4, 1)), normal=up, thickness=3.0, skin_side="outer")
    plan = plan_tray(bed, np.array([True, True, True, False]), RULE)
    reach = RULE.inner_radius + THICKNESS
    inside = [[0.0, reach], [400.0 - reach, reach], [400.0 - reach, 400.0 - reach], [0.0, 400.0 - reach]]
    assert plan.corners[:, :2] == pytest.approx(np.array(inside), abs=1e-9)
    assert plan.legs == pytest.approx(RULE.length - reach)
    assert plan.reliefs == pytest.approx(THICKNESS)
    assert plan.lengths == pytest.approx(np.array([394.5, 389.0, 394.5, 389.0]) - 2.0 * THICKNESS)
    assert plan.angles == pytest.approx(0.5 * np.pi)
    assert plan.radius == reach


@pytest.mark.parametrize("leans", [(0.0, 0.0, 0.0), (0.2, 0.1, -0.2, 0.3), (-0.3,) * 5])
def test_legs_keep_as_far_apart_at_corners_as_the_sheet_is_thick(leans: tuple[float, ...]) -> None:
    shape = tray(leans)
    plan, count = shape.plan, len(leans)
    # Of both faces where legs begin and where they end, at the start and the stop of every edge.
    corners = np.stack([shape.offset(lift).vertices() for lift in (0.0, -THICKNESS)])
    legs = corners[:, 2 * count :].reshape(2, 2, 2, count, 3)
    for edge in range(count):
        after = (edge + 1) % count
        own, other = legs[:, :, 1, edge].reshape(-1, 3), legs[:, :, 0, after].reshape(-1, 3)
        way = plan.walls[edge] - plan.walls[after]
        way /= np.linalg.norm(way)
        assert (own @ way).min() - (other @ way).max() >= THICKNESS - 1e-9
    assert plan.reliefs.min() >= THICKNESS
