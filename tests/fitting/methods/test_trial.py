"""Trials show whether features will do, and nothing gives way in them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from cadpanel.brep.read import read_reference
from cadpanel.features.catalogue import feature
from cadpanel.fitting.measures.fit import measure
from cadpanel.fitting.methods.concurrent import Concurrent
from cadpanel.fitting.methods.local import fit_local
from cadpanel.fitting.methods.trial import Trial
from cadpanel.fitting.problem import pose
from cadpanel.fitting.settings import FitSettings
from cadpanel.fitting.shapes import panel_shapes
from cadpanel.solver.stop import Stop

STRIP = Path(__file__).parents[3] / "fixtures" / "kai_tak_nw.step"


@pytest.fixture(scope="module")
def strip():
    return read_reference(STRIP)


def tried(strip, method, *, tolerance=1.0, tilt="free"):
    settings = FitSettings(gap_tolerance=tolerance, tilt=tilt)
    problem, starts = pose(strip, [feature("plane-cone-plane", tilt=tilt)] * len(strip.panels))
    alone = fit_local(problem, strip, starts, settings)
    fitted = method.fit(problem, [alone.unknowns], settings)
    return fitted, measure(panel_shapes(problem, fitted.unknowns), strip)


def test_where_everything_can_be_held_a_trial_ends_as_the_whole_fit_does(strip):
    (trial, its), (whole, wholes) = (tried(strip, method) for method in (Trial(lambda _: False), Concurrent()))
    assert trial.stopped is whole.stopped is Stop.HELD
    assert its.max_seam_gap <= 1.0
    assert its.overall_rms == pytest.approx(wholes.overall_rms, rel=0.02)


def test_where_it_cannot_a_trial_says_so_and_gives_no_seam_away(strip):
    """Cuts that stay upright close these lips to 2 mm at best."""
    trial, its = tried(strip, Trial(lambda _: False), tilt="fixed")
    assert trial.stopped is Stop.STALLED
    assert its.max_seam_gap > 1.0


def test_seams_of_panels_that_deviate_too_far_are_not_tightened(strip):
    asked = []

    def too_far(shapes):
        asked.append(len(shapes))
        return True

    trial, its = tried(strip, Trial(too_far), tolerance=0.1)
    # It is asked only where seams part further between the points at which they are held.
    assert (trial.stopped is Stop.OPEN_BETWEEN) == bool(asked) == (its.max_seam_gap > 0.1)
    assert set(asked) <= {len(strip.panels)}


def test_a_trial_ends_where_it_is_told_to(strip):
    settings = FitSettings()
    problem, starts = pose(strip, [feature("plane-cone-plane")] * len(strip.panels))
    alone = fit_local(problem, strip, starts, settings).unknowns
    steps = []

    def tell(step, excess, rms):
        steps.append((step, excess, rms))
        return step < 3

    trial = Trial(lambda _: False).fit(problem, [alone], settings, tell)
    assert trial.stopped is Stop.TOLD
    assert [step for step, _, _ in steps] == [1, 2, 3]
    assert np.isfinite(trial.unknowns).all()
