"""Panels that no seam connects are fitted as if each were alone, whatever stands beside them."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import cadpanel as cp
from cadpanel.fitting.settings import FitKeywords
from cadpanel.solver.stop import Stop
from fixtures.arrays import reference
from fixtures.lips import Lip
from tests.known_panels import moved
from tests.thorough import thorough

# What rounding leaves, mm.
SAME = 1e-6

GENTLE = Lip(panels=3, twist=(2.0, 3.0))
TWISTED = Lip(panels=2, twist=(14.0, 14.0), panel_length=1300.0)
SMALL = Lip(
    panels=2,
    panel_length=150.0,
    radius=(25.0, 22.0),
    lower=(50.0, 45.0),
    upper=(60.0, 55.0),
    crown=0.3,
    twist=(5.0, 2.0),
)
ALONE = Lip(panels=1)

# Gaps as a whole, and seams that may lean: not everything can be held.
MILLIMETRE: FitKeywords = {"gap_tolerance": 1.0, "seam_turn": 90.0, "evenness": 0.5}


@cache
def strips(*lips: Lip) -> tuple[cp.Reference, ...]:
    """Each by itself, as far apart as the second file of a job may be."""
    return tuple(
        moved(reference(lip), np.eye(3), np.array([0.0, 9000.0 * place, 0.0])) for place, lip in enumerate(lips)
    )


def beside(references: tuple[cp.Reference, ...]) -> cp.Reference:
    """All of them as one."""
    panels: list[cp.PanelReference] = []
    seams: list[cp.Seam] = []
    for place, one in enumerate(references):
        first = len(panels)
        panels += [replace(panel, name=f"{place}-{panel.name}") for panel in one.panels]
        seams += [replace(seam, panels=(first + seam.panels[0], first + seam.panels[1])) for seam in one.seams]
    return replace(references[0], panels=tuple(panels), seams=tuple(seams))


@pytest.mark.parametrize(
    ("lips", "how", "held"),
    [
        ((GENTLE, TWISTED), {}, (True, True)),
        pytest.param((GENTLE, SMALL, ALONE), {}, (True, True, True), marks=thorough),
        ((GENTLE, SMALL, ALONE), MILLIMETRE, (True, True, True)),
        pytest.param((TWISTED, GENTLE, ALONE), {"tilt": "fixed", **MILLIMETRE}, (True, False, True), marks=thorough),
        pytest.param((GENTLE, SMALL), {"method": "two_stage", **MILLIMETRE}, (False, False), marks=thorough),
    ],
)
def test_what_stands_beside_a_strip_changes_nothing_of_it_however_hopeless_it_is(lips, how, held):
    own = strips(*lips)
    together = cp.fit(beside(own), **how)
    first = 0
    for one, holds in zip(own, held, strict=True):
        alone, last = cp.fit(one, **how), first + len(one.panels)
        assert alone.tolerance_met is holds
        # What a search for the least gap ends at hangs on the last bit, alone as well: it has steps enough to wander.
        if holds or alone.stopped is not Stop.STALLED:
            for shape, other in zip(alone.shapes, together.shapes[first:last], strict=True):
                assert np.abs(shape.corners() - other.corners()).max() <= SAME
        first = last
    assert together.tolerance_met is all(held)


def test_the_price_of_a_gap_is_that_of_the_whole_deviation():
    """Of two strips, from what each pays by itself: squares of deviations add up by area."""
    own = strips(GENTLE, SMALL)
    together, *alone = (cp.fit(one, **MILLIMETRE) for one in (beside(own), *own))
    areas = [sum(float(panel.weights.sum()) for panel in one.panels) for one in own]
    slopes = [area * one.measures.overall_rms * (one.gap_price or 0.0) for area, one in zip(areas, alone, strict=True)]
    assert together.gap_price == pytest.approx(sum(slopes) / sum(areas) / together.measures.overall_rms, rel=1e-6)
