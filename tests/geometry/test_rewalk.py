"""Numbers that lost their last digits make a walk again, and the panel stays where it was."""

from dataclasses import replace

import numpy as np
import pytest

from cadpanel.errors import PanelError
from cadpanel.geometry.rewalk import rewalked
from tests.instances import random_polygon
from tests.shapes import moved, random_panel

FAR = (600_000.0, -80_000.0, 9000.0)


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("half_angle", [0.0, 0.03])
def test_a_chain_far_away_whose_last_digits_are_lost_can_be_built_again(seed, half_angle):
    shape = moved(random_panel(seed, half_angle=half_angle), FAR)
    noise = 1e-7 * np.random.default_rng(seed).standard_normal(shape.points.shape)
    blurred = replace(shape, points=shape.points + noise)
    with pytest.raises(PanelError, match="away from the next ruling"):
        blurred.check()
    again = rewalked(blurred)
    again.check()
    assert again.corners() == pytest.approx(shape.corners(), abs=2e-6)


def test_what_is_a_walk_stays_as_it_is():
    shape = random_panel(3, half_angle=0.03)
    assert rewalked(shape).corners() == pytest.approx(shape.corners(), abs=1e-9)
    flat = random_polygon(7, 5)
    assert rewalked(flat) is flat
