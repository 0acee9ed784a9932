"""Cones that are all but cylinders are made cylinders."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cadpanel.geometry.patches import ConePatch
from tests.shapes import CHAINS, random_panel


@given(
    st.integers(0, 1000),
    st.sampled_from([name for name in sorted(CHAINS) if "cone" in name]),
    st.sampled_from([5e-6, -5e-6, 1e-6, 1e-9, -1e-12]),
)
def test_a_tiny_half_angle_becomes_a_cylinder_without_moving_the_panel_visibly(seed, chain, half_angle):
    shape = random_panel(seed, chain=chain, half_angle=half_angle, length=4000.0)
    result = shape.straightened()
    result.shape.check()
    cones = [patch for patch in result.shape.patches if isinstance(patch, ConePatch)]
    assert len(result.patches) == len(cones)
    assert all(patch.half_angle == 0.0 and patch.kind == "cylinder" for patch in cones)
    assert result.largest_move < 0.02 * len(cones)
    moves = np.linalg.norm(result.shape.corners() - shape.corners(), axis=-1)
    assert result.largest_move == pytest.approx(moves.max(), rel=1e-12)


@pytest.mark.parametrize("half_angle", [0.0, 5.1e-6, -5.1e-6, 1e-2])
def test_other_panels_stay_as_they_are(half_angle):
    shape = random_panel(3, half_angle=half_angle)
    result = shape.straightened()
    assert result.shape is shape
    assert result.patches == ()
    assert result.largest_move == 0.0


def test_straightening_twice_changes_nothing_more():
    once = random_panel(3, half_angle=1e-6).straightened().shape
    assert once.straightened().shape is once
