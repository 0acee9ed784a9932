"""What the limits on seams and on parts of gaps do to whole fits: no zigzag, straight rows, small steps."""

from __future__ import annotations

from functools import cache
from itertools import pairwise

import numpy as np
import pytest

import cadpanel as cp
from cadpanel.fitting.settings import SHIFT, STEP, WIDTH
from fixtures.arrays import reference
from fixtures.lips import Lip
from tests.instances import random_polygon
from tests.known_panels import alone
from tests.thorough import thorough

LENGTH = 18_000.0
ANY_TURN = {"seam_turn": 90.0, "evenness": 0.5, "drift_along": 0.05}


def lip(panels: int) -> cp.Reference:
    """A lip of 18 m that twists, in so many panels; its flanges are flat across and its blend is an arc."""
    share = 9.0 / panels
    return reference(
        Lip(
            panels=panels,
            panel_length=LENGTH / panels,
            twist=tuple(share * twist for twist in (0.9, 1.5, 1.2)),
            fold=(100.0, 94.0, 90.0),
            radius=(420.0, 350.0, 300.0),
            plan=(6.0 * share,),
            rise=(share,),
            lower=(520.0, 430.0),
            upper=(640.0, 540.0),
            crown=0.0,
            fullness=1.0,
        )
    )


@cache
def usual(panels: int) -> cp.FitResult:
    return cp.fit(lip(panels))


@pytest.mark.parametrize("panels", [9, 18])
def test_by_default_seams_hardly_turn_and_steps_stay_small(panels: int) -> None:
    result = usual(panels)
    m = result.measures
    assert result.tolerance_met
    assert m.seam_width.max() <= WIDTH
    assert m.seam_step.max() <= STEP
    assert m.seam_shift.max() <= SHIFT
    assert np.degrees(m.turn.max()) <= 3.0
    assert (m.uneven <= 0.0025 * m.lengths[m.seam_panels].max(axis=1)).all()


def test_without_limits_on_seams_they_turn_left_and_right() -> None:
    """There was something to do: the drift limits alone let seams lean and zigzag to hold a step."""
    free = cp.fit(lip(9), seam_turn=90.0, evenness=0.5, drift_along=0.05, gap_tolerance=3.0).measures
    assert np.degrees(free.turn.max()) > 6.0


@thorough
def test_more_panels_mean_a_closer_skin() -> None:
    """With joints of 20 +- 5 mm and steps of 5 mm."""
    rms = [
        cp.fit(lip(panels), joint_tolerance=5.0, step=5.0, shift=5.0).measures.overall_rms for panels in (9, 18, 36, 72)
    ]
    assert all(finer < coarser for coarser, finer in pairwise(rms))
    assert rms[-1] <= 0.1 * rms[0]


def test_each_part_of_a_gap_is_limited_by_itself() -> None:
    tight = cp.fit(lip(9), step=1.0, joint_tolerance=6.0, shift=2.0)
    assert tight.tolerance_met
    assert tight.measures.seam_step.max() <= 1.0
    assert tight.measures.seam_width.max() <= 6.0
    assert tight.measures.seam_shift.max() <= 2.0
    assert tight.measures.overall_rms > usual(9).measures.overall_rms


def test_polygons_without_seams_have_nothing_that_may_not_turn() -> None:
    shapes = [random_polygon(seed, corners) for seed, corners in ((7, 5), (8, 5))]
    result = cp.fit(alone(*shapes), feature="planar-polygon")
    assert result.tolerance_met
    assert result.measures.turn.max() == 0.0
    assert result.measures.overall_rms <= 1e-6


def test_a_kink_is_limited_where_it_is_asked_for() -> None:
    """By a little less than the widest: the drawing bends by nearly so much from panel to panel."""
    most = 0.97 * float(np.degrees(usual(9).measures.kink.max()))
    flat = cp.fit(lip(9), max_kink=most)
    assert np.degrees(flat.measures.kink.max()) <= most
    assert flat.tolerance_met


@thorough
def test_rulings_that_cannot_turn_give_way_with_the_gaps_and_not_drift() -> None:
    """Cylinders between sides that are not parallel: their seams must turn, and their corners stay within bounds."""
    tapering = Lip(panels=4, lower=(650.0, 350.0), upper=(800.0, 400.0))
    result = cp.fit(reference(tapering), feature="cylinder-parallel", seam_turn=0.1)
    m = result.measures
    assert (m.drift_along <= 0.02 * m.lengths).all()
    assert (m.drift_across <= 0.02 * m.lengths).all()


@pytest.mark.parametrize("held", ["gap", "step"])
def test_what_is_held_has_a_price_and_the_rest_has_none(held: str) -> None:
    result = cp.fit(lip(9), gap_tolerance=2.0) if held == "gap" else usual(9)
    assert result.prices[held] > 0.05
    assert result.prices["min_radius"] == 0.0
    assert set(result.prices) == set(result.settings.gaps) | set(result.settings.allowed)
    assert sum(result.seam_prices) == pytest.approx(sum(result.prices[part] for part in result.settings.gaps))
