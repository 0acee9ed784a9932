"""The paper's algorithm goes downhill to where ours stands still, says so, and is the same each time."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from cadpanel.fitting.methods.annealing import Annealing, descend
from cadpanel.fitting.methods.local import fit_local
from cadpanel.fitting.methods.weighted import Weighted, weighted_objective
from cadpanel.fitting.settings import FitSettings, Weights
from cadpanel.solver.stop import Stop
from fixtures.arrays import reference
from fixtures.lips import Lip
from tests.known_panels import posed

WEIGHTS = Weights(drift=1e-2)
HOW = FitSettings(method="annealing", weights=WEIGHTS, tau=0.3)


@cache
def begun():
    lip = reference(Lip(panels=2, twist=(2.0, 3.0), radius=(300.0, 260.0)))
    problem, starts = posed(lip, HOW)
    return problem, fit_local(problem, lip, starts, HOW).unknowns, weighted_objective(problem, WEIGHTS, HOW)


def energy(unknowns):
    problem, _, model = begun()
    return float(2.0 * model.cost(unknowns).sum() * problem.place.length**2)


@cache
def fitted(**changes):
    problem, local, _ = begun()
    return Annealing().fit(problem, [local], replace(HOW, **changes))


def test_it_goes_downhill_and_never_below_what_ours_finds():
    problem, local, _ = begun()
    best = Weighted().fit(problem, [local], replace(HOW, method="concurrent"))
    ours, begin, first, second = map(energy, (best.unknowns, local, fitted(tau=1.0).unknowns, fitted().unknowns))
    assert ours * (1.0 - 1e-6) <= second < first < begin
    assert fitted().stopped is Stop.AT_REST


def test_a_step_is_along_the_gradient_whatever_its_length():
    _, local, model = begun()
    found = descend(model, local, replace(HOW, tau=1e3))
    assert (found.steps, found.stopped) == (1, Stop.AT_REST)
    assert np.array_equal(found.unknowns, local)
    _, normal = model.linearize(local)
    way, small = normal.gradient, 1e-7
    slope = (energy(local + small * way) - energy(local - small * way)) / (2.0 * small)
    assert slope == pytest.approx(2.0 * begun()[0].place.length ** 2 * float((way**2).sum()), rel=1e-4)


def test_perturbations_are_seeded_counted_and_left_out_where_the_energy_is_low_enough():
    problem, local, _ = begun()
    how = replace(HOW, restarts=1, tau=1.0)
    one, other = fitted(restarts=1, tau=1.0, seed=4), fitted(restarts=1, tau=1.0, seed=5)
    again = Annealing().fit(problem, [local], replace(how, seed=4))
    assert one.starts == again.starts == 2
    assert np.array_equal(one.unknowns, again.unknowns)
    assert one.iterations == again.iterations != other.iterations
    assert energy(one.unknowns) <= energy(fitted(tau=1.0).unknowns)
    assert fitted(restarts=5, tau=1.0, energy=2.0 * energy(fitted(tau=1.0).unknowns)).starts == 1


def test_whoever_is_told_may_end_it():
    problem, local, _ = begun()
    told = []

    def stop(step, excess, rms):
        told.append((step, excess, rms))
        return False

    found = Annealing().fit(problem, [local], replace(HOW, restarts=3), stop)
    assert (found.stopped, found.starts, len(told)) == (Stop.TOLD, 1, 1)
    assert told[0][2] > 0.0
