"""Where folds begin, and how far reliefs keep them from each other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from cadpanel.arrays import BoolArray
from cadpanel.geometry.sheet_checks import SkinSide
from cadpanel.geometry.tray_plan import Bed, foldable, plan_tray
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


UP = np.array([0.0, 0.0, 1.0])


def square(leans: Sequence[float], skin_side: SkinSide) -> Bed:
    """A square of 400 mm whose walls lean out by so much for one mm upwards."""
    corners = np.array([[0.0, 0.0, 0.0], [400.0, 0.0, 0.0], [400.0, 400.0, 0.0], [0.0, 400.0, 0.0]])
    low, right, high, left = leans
    posts = np.array([[-left, -low, 1.0], [right, -low, 1.0], [right, high, 1.0], [-left, high, 1.0]])
    return Bed(name="S", corners=corners, posts=posts, normal=UP, thickness=THICKNESS, skin_side=skin_side)


@pytest.mark.parametrize(("lean", "back"), [(0.2, 0.6), (0.0, 0.0), (-0.2, 0.0)])
def test_an_edge_that_is_not_folded_ends_with_the_shorter_face_of_its_leaning_wall(lean: float, back: float) -> None:
    # The sheet lies below: where the wall leans out upwards its other face is the shorter one.
    plan = plan_tray(square((0.0, lean, 0.0, 0.0), "outer"), np.array([True, False, False, False]), RULE)
    assert plan.corners[1:3, 0] == pytest.approx(400.0 - back)
    assert plan.wall_points[1] == pytest.approx(plan.corners[1])
    assert plan.walls[1] == pytest.approx([1.0, 0.0, 0.0])


@pytest.mark.parametrize("lean", [0.0, 0.3, -0.2])
def test_a_skin_inside_is_folded_so_that_the_outer_face_stands_in_the_wall(lean: float) -> None:
    plan = plan_tray(square((lean, 0.0, 0.0, 0.0), "inner"), np.array([True, False, False, False]), RULE)
    assert plan.wall_points[0] == pytest.approx([0.0, -lean * THICKNESS, THICKNESS])
    assert plan.walls[0] == pytest.approx(np.array([0.0, -1.0, -lean]) / np.hypot(1.0, lean))
    reach = (RULE.inner_radius + THICKNESS) * np.tan(0.5 * plan.angles[0])
    assert plan.corners[0, 1] == pytest.approx(-lean * THICKNESS + reach)
    assert plan.radius == RULE.inner_radius


@pytest.mark.parametrize("skin_side", ["outer", "inner"])
@pytest.mark.parametrize("folded", [(1, 1, 1, 1), (1, 0, 1, 0), (1, 1, 0, 0), (0, 0, 0, 1)])
@pytest.mark.parametrize("leans", [(0.0,) * 4, (0.3, 0.3, 0.3, 0.3), (0.1, -0.25, 0.2, 0.4), (-0.3, -0.1, -0.3, 0.2)])
def test_a_relief_is_as_small_as_legs_walls_and_sheet_allow(
    leans: Sequence[float], folded: Sequence[int], skin_side: SkinSide
) -> None:
    bed, folds = square(leans, skin_side), np.array(folded, dtype=bool)
    plan = plan_tray(bed, folds, RULE)
    lifts = (bed.outer, bed.outer - THICKNESS)
    bent = plan.radius * (plan.away - plan.normal)
    tips = bent + plan.legs[:, None] * plan.onwards
    for corner in range(4):
        edges = ((corner - 1) % 4, corner)  # one stops there, the other starts
        assert (plan.reliefs[corner] > 0.0) == folds[list(edges)].any()
        spare = [plan.reliefs[corner] - THICKNESS]
        for own, other, ends in ((*edges, plan.stops), (*edges[::-1], plan.starts)):
            if not folds[own]:
                continue
            levels = np.concatenate([lift * np.array([plan.normal, plan.away[own], plan.away[own]]) for lift in lifts])
            leg = ends[own] + np.tile([np.zeros(3), bent[own], tips[own]], (2, 1)) + levels
            wall, beside = bed.walls[own], bed.walls[other]
            if folds[other]:  # half a sheet's thickness from the plane between both walls
                away = (beside - wall) / np.linalg.norm(beside - wall)
                spare.append(-((leg - bed.outer_corners[corner]) @ away).max() - 0.5 * THICKNESS)
            else:
                spare.append(-((leg - bed.outer_corners[corner]) @ beside).max())
        if len(spare) > 1:
            assert min(spare) == pytest.approx(0.0, abs=1e-9)


def test_a_plan_counts_the_seams_and_walls_of_its_sheet() -> None:
    plan = plan_tray(square((0.0,) * 4, "outer"), np.array([True, True, False, False]), RULE)
    assert plan.seams == 16
    assert plan.wall_kinds == ("plane",) * (4 + 2 * 4) + ("cylinder",) * 3


def test_edges_as_long_as_their_legs_are_folded_and_shorter_ones_are_not() -> None:
    def lengths(width: float) -> tuple[BoolArray, float]:
        bed = square((0.0,) * 4, "outer")
        bed = replace(bed, corners=bed.corners * [width / 400.0, 1.0, 1.0])
        folded, _ = foldable(bed, RULE)
        return folded, float(plan_tray(bed, np.ones(4, dtype=bool), RULE).lengths[0])

    narrow = RULE.length + 2.0 * (RULE.inner_radius + 2.0 * THICKNESS)
    folded, length = lengths(narrow + 0.01)
    assert folded.all()
    assert length == pytest.approx(RULE.length + 0.01)
    folded, _ = lengths(narrow - 0.01)
    assert folded.tolist() == [False, True, False, True]
