"""The gap and the kink of seams of every kind against a dense measure that is written apart from them."""

import numpy as np
import pytest

from cadpanel.geometry.end_curves import EndCurves, seam_gap
from tests.dense_seam_gap import FINE, QUICK, dense_seam_gap
from tests.seams import KINDS, chains, good
from tests.thorough import cases, thorough

SEED = 20
# Of each of the fifteen kinds: ten thousand seams together in a thorough run.
SEAMS = cases(60, 667)
CLOSE = 1e-3
# What the dense measure itself may be off: mm, and radians.
ROUNDING = np.array([1e-7, 1e-6, 1e-6, 1e-6])


# Parts are told within this share of the whole gap. Seen from an arc's middle its chord's closest point leaps from end
# to end, and curves that lean by decimetres have their largest step where one goes on past the end of the other.
PARTS = {"straight_against_curved": 0.05, "tilts": 0.005}


def agree(found, dense, parts=CLOSE):
    """(4, s) whether gaps, kinks, widths and steps (4, s) are the same within a thousandth, the parts of the gap."""
    gap, kink, *_ = np.asarray(dense)
    allowed = np.stack([CLOSE * gap, CLOSE * kink, parts * gap, parts * gap])
    return np.abs(np.subtract(found, dense)) <= allowed + ROUNDING[:, None]


@pytest.mark.parametrize("kind", cases([*KINDS][::3], [*KINDS]))
def test_gap_its_parts_and_kink_agree_with_a_dense_measure_within_a_thousandth(kind):
    parts = PARTS.get(kind, CLOSE)
    first, second = KINDS[kind](np.random.default_rng(SEED), SEAMS)
    found = np.array(seam_gap(first, second))
    dense = np.array(dense_seam_gap(first, second, QUICK))
    # Where they do not, the dense one may be at fault: it is asked again.
    doubtful = np.flatnonzero(~agree(found, dense, parts).all(axis=0))
    assert len(doubtful) <= 0.1 * SEAMS
    if len(doubtful):
        finely = dense_seam_gap(first.take(doubtful), second.take(doubtful), FINE)
        assert agree(found[:, doubtful], finely, parts).all()


def test_a_gap_that_is_off_by_a_five_hundredth_does_not_agree():
    first, second = good(np.random.default_rng(SEED), 20)
    dense = np.array(dense_seam_gap(first, second, FINE))
    assert not agree(dense * np.array([[1.002], [1.0], [1.0], [1.0]]), dense).all(axis=0).any()
    assert agree(dense, dense).all()


def test_the_dense_measure_knows_a_shift_and_a_turn():
    """Of a single segment both are plain; so are the gap and the kink."""
    turn = 0.1
    flat, corners = np.zeros((1, 1)), np.array([[[0.0, 0.0, 0.0], [800.0, 0.0, 0.0]]])
    along, up, lean = np.eye(3)[0], np.eye(3)[2], np.array([0.0, np.sin(turn), np.cos(turn)])

    def segment(normal, shift):
        rulings = np.tile(along, (1, 2, 1))
        at = corners + shift
        return EndCurves(at, at, rulings, np.tile(normal, (1, 2, 1)), flat, flat, flat, at[:, 0], along[None])

    pair = segment(up, np.zeros(3)), segment(lean, np.array([3.0, 4.0, 12.0]))
    # What is left of the shift along the segment, 3 mm, is neither width nor step.
    step = 4.0 * np.sin(0.5 * turn) + 12.0 * np.cos(0.5 * turn)
    for gap, kink, width, up_and_down in (dense_seam_gap(*pair, FINE), seam_gap(*pair)):
        assert gap == pytest.approx([13.0], rel=1e-6)
        assert kink == pytest.approx([turn], rel=1e-6)
        assert up_and_down == pytest.approx([step], rel=1e-6)
        assert width == pytest.approx([np.sqrt(160.0 - step**2)], rel=1e-6)


@pytest.mark.parametrize("kind", KINDS)
@thorough
def test_neither_order_nor_company_changes_what_is_found(kind):
    first, second = KINDS[kind](np.random.default_rng(SEED + 1), 12)
    together = np.array(seam_gap(first, second))
    assert np.array_equal(together, seam_gap(second, first))
    for i in range(12):
        alone = seam_gap(first.take(np.array([i])), second.take(np.array([i])))
        assert together[:, i] == pytest.approx(np.ravel(alone), rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("kinds", ["pcp", "pccp", "cpc", "p"])
def test_curves_that_are_the_same_have_neither_gap_nor_kink(kinds):
    curves = chains(np.random.default_rng(SEED), 50, kinds).curves()
    assert max(of.max() for of in seam_gap(curves, curves)) <= 1e-9


def test_no_seams_have_no_gaps():
    none = chains(np.random.default_rng(SEED), 0).curves()
    assert [len(of) for of in seam_gap(none, none)] == [0, 0, 0, 0]
