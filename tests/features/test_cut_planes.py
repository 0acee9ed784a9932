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
        position = walked.values[:, walked.feature.cut_slice(end).start]
        assert s[:, end] - dot(m[:, end], walked.anchor.p[:, 0]) == pytest.approx(position, abs=ROUNDING)


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
