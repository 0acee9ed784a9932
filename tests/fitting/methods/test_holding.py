"""What a millimetre of gap costs, and that who holds a narrow gap holds a wide one."""

from itertools import pairwise

import pytest

import cadpanel as cp
from fixtures.arrays import reference
from fixtures.lips import Lip


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


@pytest.mark.parametrize("twist", [1.0, 3.0, 4.5])
def test_what_holds_a_narrow_gap_holds_a_wide_one_at_no_more_deviation(twist):
    results = [cp.fit(lip(twist), gap_tolerance=t) for t in (0.5, 1.0, 2.0, 5.0)]
    met = [result.tolerance_met for result in results]
    assert met == sorted(met)
    rms = [result.measures.overall_rms for result in results]
    for narrow, wide in pairwise(rms):
        assert wide <= 1.01 * narrow
