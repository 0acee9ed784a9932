"""Strips at one or two of whose seams tolerances are hard to hold: everything that can be held is, in few steps."""

from dataclasses import replace

import pytest

import cadpanel as cp
from cadpanel.reference.model import Reference
from fixtures.arrays import reference
from tests.benchmarks.strips import uneven_lip

# A seed of a strip of 500 panels, and some of its panels that took hundreds of steps while the barrier was lowered
# before anything held: the search for what can be held ended at wide gaps, or at panels far from the reference.
HARD = ((10, 5, 41), (10, 0, 50), (1, 80, 130), (4, 160, 210), (8, 0, 60))
STEPS = 100


def between(whole: Reference, first: int, last: int) -> Reference:
    """Neighbouring panels of a strip."""
    seams = tuple(
        replace(seam, panels=(seam.panels[0] - first, seam.panels[1] - first))
        for seam in whole.seams
        if first <= min(seam.panels) and max(seam.panels) < last
    )
    return replace(whole, panels=whole.panels[first:last], seams=seams)


@pytest.mark.parametrize(("number", "first", "last"), HARD)
def test_a_hard_spot_is_held_in_few_steps(number, first, last):
    strip = reference(uneven_lip(500, number, 1))
    result = cp.fit(between(strip, first, last))
    assert result.tolerance_met
    assert result.iterations <= STEPS
