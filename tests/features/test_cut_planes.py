"""How the ends of a chain may be cut, and what each way of cutting promises."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cadpanel.features.cut_planes import cut_planes
from cadpanel.features.feature import Feature
from cadpanel.features.patches import Cone, Cylinder, Patch, Plane
from cadpanel.geometry.vectors import cross, dot
from tests.chains import random_values

ROUNDING = 1e-12
PATCHES: dict[str, tuple[Patch, ...]] = {
    "plane": (Plane(turn=0.0),),
    "cylinder": (Cylinder(),),
    "plane-cone-plane": (Plane(), Cone(), Plane()),
    "cone-plane": (Cone(), Plane()),
}
few = settings(max_examples=5)
seeds = st.integers(0, 10_000)
every_chain = pytest.mark.parametrize("name", sorted(PATCHES))


def walked_cuts(name, cuts, seed):
    """The walk, and unit normals (panels, 2, 3) and places (panels, 2) of its cut planes."""
    of = Feature(*PATCHES[name], cuts=cuts)
    walked = of.walk(random_values(of, seed), derivatives=False)
    m, s = cut_planes(walked)
    size = np.linalg.norm(m, axis=-1)
    return walked, m / size[..., None], s / size


@every_chain
@few
@given(seed=seeds)
def test_parallel_cuts_have_one_normal(name, seed):
    _, m, s = walked_cuts(name, "parallel", seed)
    assert np.linalg.norm(cross(m[:, 0], m[:, 1]), axis=-1) == pytest.approx(0.0, abs=ROUNDING)
    assert np.all(s[:, 1] > s[:, 0])


@every_chain
@few
@given(seed=seeds)
def test_square_cuts_stand_square_on_the_anchor_ruling(name, seed):
    walked, m, _ = walked_cuts(name, "square", seed)
    t = np.broadcast_to(walked.anchor.t[:, :1], m.shape)
    assert np.linalg.norm(cross(m, t), axis=-1) == pytest.approx(0.0, abs=ROUNDING)


def test_a_square_cut_is_as_far_from_the_anchor_as_its_position_says():
    walked, m, s = walked_cuts("plane-cone-plane", "square", 4)
    for end in (0, 1):
        position = walked.values[:, walked.feature.cut_numbers[end, 0]]
        assert s[:, end] - dot(m[:, end], walked.anchor.p[:, 0]) == pytest.approx(position, abs=ROUNDING)


def test_corners_at_square_cuts_follow_the_numbers():
    """A sheet 2 wide: its ends are 1 behind and 3 ahead of a ruling that leads along it, through (5, 0, 7)."""
    of = Feature(Plane(turn=0.0), cuts="square")
    place = {number.name: i for i, number in enumerate(of.numbers)}
    values = np.zeros((1, len(place)))
    values[0, :2] = 5.0, 7.0
    values[0, [place["patch 0: width"], place["cut 0: position"], place["cut 1: position"]]] = 2.0, -1.0, 3.0
    corners = of.corners(of.walk(values, derivatives=True))
    assert corners.position[0] == pytest.approx(np.array([(4, -1, 7), (6, -1, 7), (4, 3, 7), (6, 3, 7)]))
    assert corners.jacobian is not None
    # A point on the ruling at `along` and `across` of it goes with whatever moves the ruling.
    for corner, (x, y, z) in enumerate(corners.position[0]):
        rates = corners.jacobian[0, corner].T
        assert rates[:2] == pytest.approx(np.array([(1.0, 0.0, 0.0), (0.0, 0.0, 1.0)]))
        assert rates[2:5] == pytest.approx(np.cross(np.eye(3), (x - 5.0, y, z - 7.0)))
        end = corner // 2
        assert rates[place[f"cut {end}: position"]] == pytest.approx((0.0, 1.0, 0.0))
        assert rates[place[f"cut {1 - end}: position"]] == pytest.approx(0.0)


def test_a_corner_runs_along_its_ruling_until_it_meets_the_cut_that_moved():
    """Where a ruling leads aslant, by as much more as the cut goes ahead."""
    of = Feature(Plane(), cuts="square")
    place = {number.name: i for i, number in enumerate(of.numbers)}
    values = np.zeros((1, len(place)))
    values[0, [place["patch 0: width"], place["patch 0: turn"]]] = 2.0, 0.8
    corners = of.corners(of.walk(values, derivatives=True))
    assert corners.jacobian is not None
    for corner, slant in enumerate((0.4, -0.4, 0.4, -0.4)):
        rate = corners.jacobian[0, corner, :, place[f"cut {corner // 2}: position"]]
        assert rate == pytest.approx((np.tan(slant), 1.0, 0.0))


@every_chain
@few
@given(seed=seeds)
def test_upright_cuts_do_not_lean_out_of_the_panel(name, seed):
    _, m, _ = walked_cuts(name, "upright", seed)
    assert np.array_equal(m[..., 2], np.zeros(m.shape[:2]))


@pytest.mark.parametrize("name", ["cylinder", "plane-cone-plane", "cone-plane"])
def test_mitred_cuts_are_none_of_these(name):
    walked, m, _ = walked_cuts(name, "mitre", 1)
    assert np.abs(m[..., 2]).min() > 0.0
    assert np.linalg.norm(cross(m[:, 0], m[:, 1]), axis=-1).min() > 1e-6
    assert np.linalg.norm(cross(m, np.broadcast_to(walked.anchor.t[:, :1], m.shape)), axis=-1).min() > 1e-6


def test_tilting_about_its_own_line_does_nothing_to_a_flat_panel():
    mitred, upright = (Feature(Plane(), cuts=cuts) for cuts in ("mitre", "upright"))
    assert [number.fixed for number in mitred.numbers] == [number.fixed for number in upright.numbers]
    assert np.array_equal(mitred.free, upright.free)


@pytest.mark.parametrize(("cuts", "count"), [("mitre", 6), ("upright", 4), ("parallel", 4), ("square", 2)])
def test_each_way_of_cutting_has_its_count_of_numbers(cuts, count):
    of = Feature(Plane(), Cone(), Plane(), cuts=cuts)
    assert sum(of.numbers[i].name.startswith("cut") for i in of.free) == count


def test_a_rectangle_has_four_right_angles():
    of = Feature(Plane(turn=0.0), cuts="square")
    corners = of.corners(of.walk(random_values(of, 3), derivatives=False)).position
    along, across = corners[:, 2] - corners[:, 0], corners[:, 1] - corners[:, 0]
    opposite = corners[:, 3] - corners[:, 1]
    assert dot(along, across) == pytest.approx(0.0, abs=ROUNDING)
    assert along == pytest.approx(opposite, abs=ROUNDING)
    skewed = Feature(Plane(turn=0.0), cuts="upright")
    corners = skewed.corners(skewed.walk(random_values(skewed, 3), derivatives=False)).position
    assert np.abs(dot(corners[:, 2] - corners[:, 0], corners[:, 1] - corners[:, 0])).min() > 1e-6
