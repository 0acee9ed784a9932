"""What a millimetre of gap costs, and that who holds a narrow gap holds a wide one."""

from itertools import pairwise

import numpy as np
import pytest

import cadpanel as cp
from cadpanel.fitting.measures.verdict import limits_of
from fixtures.arrays import reference
from fixtures.lips import Lip
from tests.thorough import cases, thorough


def lip(twist: float = 3.0) -> cp.Reference:
    return reference(Lip(panels=6, twist=(twist, -twist)))


@pytest.mark.parametrize("tolerance", [1.0, 4.0])
def test_the_price_of_a_gap_is_what_another_millimetre_saves(tolerance):
    near, far = (held(lip(), t) for t in (tolerance, 1.1 * tolerance))
    assert near.gap_price is not None
    saved = (near.measures.overall_rms - far.measures.overall_rms) / (0.1 * tolerance)
    assert near.gap_price == pytest.approx(saved, rel=0.5, abs=0.05)
    assert near.gap_price > 0.05


def held(of: cp.Reference, gap: float) -> cp.FitResult:
    """Gaps alone: seams may turn and drift as they like."""
    return cp.fit(of, gap_tolerance=gap, seam_turn=90.0, evenness=0.5, drift_along=0.05)


def test_gaps_that_cost_nothing_have_no_price():
    wide = held(lip(0.0), 100.0)
    assert wide.gap_price == pytest.approx(0.0, abs=1e-3)
    assert cp.fit(lip(), method="local").gap_price is None


@pytest.mark.parametrize("twist", cases([3.0], [1.0, 3.0, 4.5]))
def test_what_holds_a_narrow_gap_holds_a_wide_one_at_no_more_deviation(twist):
    results = [cp.fit(lip(twist), gap_tolerance=t) for t in (0.5, 1.0, 2.0, 5.0)]
    met = [result.tolerance_met for result in results]
    assert met == sorted(met)
    rms = [result.measures.overall_rms for result in results]
    for narrow, wide in pairwise(rms):
        assert wide <= 1.01 * narrow


@pytest.mark.parametrize("seed", cases([], [2, 6]))
def test_what_holds_a_narrow_gap_holds_a_wide_one_also_where_gaps_give_way(seed):
    """However narrow a gap is asked for that cannot be held, it stays as wide; whatever is wider is held."""
    random = np.random.default_rng(seed)
    twisted = reference(Lip(panels=2, panel_length=1200.0, twist=tuple(random.uniform(-8.0, 8.0, 2)), plan=(3.0, -1.0)))
    least = widest_gap(cp.fit(twisted, tilt="fixed", gap_tolerance=0.01))
    assert least > 0.011
    for share in (0.7, 1.02):
        found = cp.fit(twisted, tilt="fixed", gap_tolerance=share * least)
        assert widest_gap(found) <= max(least, share * least) * (1.0 + 1e-6)
        assert found.tolerance_met or share < 1.0


@thorough
@pytest.mark.parametrize("twist", [(7.0, -9.0)])
def test_limits_hold_however_far_gaps_must_open_for_them(twist):
    """Upright ends, a roof edge that may hardly move, and wide bends: less would be left of the limits than of gaps."""
    hard = Lip(panels=3, panel_length=600.0, twist=twist, plan=(4.0, -3.0), radius=(200.0, 350.0))
    found = cp.fit(
        reference(hard),
        tilt="fixed",
        min_radius=150.0,
        drift_across=0.005,
        drift_along=0.01,
        gap_tolerance=0.5,
        seam_turn=90.0,
        evenness=0.5,
    )
    assert not found.tolerance_met
    for limit, allowed in limits_of(found.settings):
        assert limit.kept(found.measures, allowed).all()
    assert widest_gap(found) > 0.5


def widest_gap(found: cp.FitResult) -> float:
    return float(max(found.measures.max_corner_gap, found.measures.max_seam_gap))
