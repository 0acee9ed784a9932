"""Panels come back to their drift limits and to what the shop can make, each by itself."""

import numpy as np
import pytest

from cadpanel.fitting.methods.holding import MARGIN
from cadpanel.fitting.methods.local import fit_local
from cadpanel.fitting.methods.restoring import restored
from cadpanel.fitting.settings import FitSettings
from fixtures.arrays import reference
from fixtures.lips import Lip
from tests.known_panels import posed
from tests.thorough import thorough

TWISTED = Lip(panels=3, panel_length=600.0, twist=(7.0, -9.0), plan=(4.0, -3.0), radius=(200.0, 350.0))
FIRM = FitSettings(tilt="fixed", min_radius=150.0, drift_across=0.005, drift_along=0.01, seam_turn=90.0, evenness=0.5)


def used(problem, unknowns, settings=FIRM):
    """(panels,) the largest share of any limit that each panel uses up, less the margin."""
    state, share = problem.state(unknowns), np.zeros(problem.panels)
    for limit in problem.limits(settings, MARGIN):
        np.maximum.at(share, limit.blocks[0], limit.hold.ratio(limit.vectors(state)).max(axis=1))
    return share


@pytest.fixture(scope="module")
def case():
    problem, starts = posed(reference(TWISTED), FIRM)
    return problem, fit_local(problem, reference(TWISTED), starts, FIRM).unknowns, starts


def test_every_panel_keeps_every_limit_wherever_it_was(case):
    problem, local, starts = case
    assert used(problem, local).max() > 2.0
    found, steps = restored(problem, FIRM, np.arange(3), [local, *starts])
    assert used(problem, found).max() <= 1.0 + 1e-6
    assert steps > 0


@thorough
def test_panels_that_are_not_named_stay_where_the_first_start_has_them(case):
    problem, local, starts = case
    found, _ = restored(problem, FIRM, np.array([1]), [local, *starts])
    assert np.array_equal(found[[0, 2]], local[[0, 2]])
    whole, _ = restored(problem, FIRM, np.arange(3), [local, *starts])
    assert found[1] == pytest.approx(whole[1], abs=1e-9)


@thorough
def test_another_start_never_makes_it_deviate_more(case):
    problem, local, starts = case

    def cost(*begin):
        return problem.deviation.cost(problem.state(restored(problem, FIRM, np.arange(3), begin)[0]))

    assert np.all(cost(local, starts[0]) <= np.minimum(cost(local), cost(starts[0])) * (1.0 + 1e-9))


def test_panels_that_keep_their_limits_are_fitted_as_well_as_alone(case):
    _, local, _ = case
    wide = FitSettings(drift_across=0.4, drift_along=0.4)
    problem, starts = posed(reference(TWISTED), wide)
    alone = fit_local(problem, reference(TWISTED), starts, wide).unknowns
    found, _ = restored(problem, wide, np.arange(3), [alone])
    assert alone.shape != local.shape
    deviation = [problem.deviation.cost(problem.state(unknowns)) for unknowns in (found, alone)]
    assert deviation[0] == pytest.approx(deviation[1], rel=1e-2)
