"""A kink that cannot be held costs no more than it is worth: whatever exceeds least what is asked for is kept."""

from __future__ import annotations

import numpy as np

import cadpanel as cp
from cadpanel.fitting.methods.concurrent import seams_held
from cadpanel.fitting.methods.holding import MARGIN, seam_excess
from cadpanel.fitting.methods.kinks import less_kinked
from cadpanel.fitting.methods.local import fit_local
from cadpanel.fitting.objective import HeldObjective
from cadpanel.fitting.problem import pose
from cadpanel.fitting.settings import FitSettings
from cadpanel.solver.ended import Limits
from cadpanel.solver.giving_way import HeldSolution
from cadpanel.solver.interior_point import interior_point
from cadpanel.solver.stop import Stop
from fixtures.arrays import reference
from fixtures.make_fixtures import FIXTURES
from tests.benchmarks.holding import random_lip
from tests.thorough import thorough


def largest(problem, unknowns, settings):
    return max(float(over.max()) for over in seam_excess(problem, unknowns, settings).values())


@thorough
def test_what_comes_nearer_to_what_is_asked_for_is_kept_and_what_must_hold_holds():
    lip, settings = reference(random_lip(5, 3)), FitSettings(max_kink=1.0)
    problem, begin = pose(lip, [settings.feature_for(4)] * 3)
    limits = problem.limits(settings, MARGIN)
    start = fit_local(problem, lip, begin, settings).unknowns
    model = HeldObjective(problem, [problem.deviation], [*seams_held(problem, settings, start), *limits])
    asked = [term.hold.radius.copy() for term in model.held]
    stuck = HeldSolution(interior_point(model, model.starting_from(start), Limits(steps=0)), (Stop.STALLED,), 7)
    everywhere = np.ones(1, dtype=bool)
    found = less_kinked(problem, model, stuck, start, asked, start, settings, everywhere)
    assert largest(problem, found.unknowns, settings) < 0.9 * largest(problem, stuck.unknowns, settings)
    assert found.end.best.firm.max() <= 1.0 + 1e-5
    assert found.stopped == (Stop.STALLED,)
    assert found.iterations > stuck.iterations
    # What is asked for is the same as before, and what was found is no worse than itself.
    assert all(np.array_equal(term.hold.radius, radius) for term, radius in zip(model.held, asked, strict=True))
    again = less_kinked(problem, model, found, start, asked, start, settings, ~everywhere)
    assert np.array_equal(again.unknowns, found.unknowns)


@thorough
def test_a_kink_that_can_be_held_is_held_along_the_arcs_as_well_as_at_corners():
    measures = cp.fit(reference(random_lip(5, 3)), max_kink=2.0).measures
    assert np.degrees(measures.kink.max()) <= 2.0
    assert measures.seam_width.max() <= FitSettings().gaps["width"]


@thorough
def test_no_kink_is_worth_panels_that_are_no_approximation_any_more():
    """The lip came out 314 mm off, at 40 times the deviation of its local fits, for a kink that it then held."""
    lip = next(fixture.lip for fixture in FIXTURES if fixture.prefix == "SE-S")
    result = cp.fit(reference(lip), FitSettings(gap_tolerance=1.0, max_kink=2.0))
    local = result.baselines.local.overall_rms
    mean = float(np.mean([panel.length for panel in reference(lip).panels]))
    assert result.measures.overall_rms <= 1.01 * max(5.0 * float(local), 0.05 * mean)
