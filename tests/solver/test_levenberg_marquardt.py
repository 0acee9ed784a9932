"""Classic problems of least squares, alone and side by side."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import lsq_linear

from cadpanel.solver import levenberg_marquardt as method
from cadpanel.solver.bounds import Bounds, bounded_step
from cadpanel.solver.levenberg_marquardt import Stopping, levenberg_marquardt
from cadpanel.solver.nielsen import Nielsen
from cadpanel.solver.stop import Stop
from tests.solver.models import (
    LinearChain,
    Separate,
    SpringChain,
    pattern,
    powell,
    powell_jacobian,
    rosenbrock,
    rosenbrock_jacobian,
)

# Powell's function has no curvature at its minimum: the iteration halves the distance at every step.
TIGHT = Stopping(cost=1e-14, iterations=300)
few = settings(max_examples=10)


def side_by_side(residual, jacobian, starts, scale=None):
    count, size = starts.shape
    return Separate(residual, jacobian, pattern(count, size, []), np.ones(count) if scale is None else scale)


def test_rosenbrocks_valley_is_followed_to_its_end():
    start = np.array([[-1.2, 1.0]])
    solution = levenberg_marquardt(side_by_side(rosenbrock, rosenbrock_jacobian, start), start, TIGHT)
    assert solution.converged.all()
    assert solution.unknowns == pytest.approx(np.ones((1, 2)), abs=1e-8)
    assert solution.cost == pytest.approx(0.0, abs=1e-16)


def test_powells_singular_function_is_solved_where_its_jacobian_loses_rank():
    start = np.array([[3.0, -1.0, 0.0, 1.0]])
    solution = levenberg_marquardt(side_by_side(powell, powell_jacobian, start), start, TIGHT)
    assert solution.unknowns == pytest.approx(0.0, abs=1e-3)
    assert solution.cost == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize(
    ("residual", "jacobian", "start"),
    [(rosenbrock, rosenbrock_jacobian, [-1.2, 1.0]), (powell, powell_jacobian, [3.0, -1.0, 0.0, 1.0])],
)
@settings(max_examples=3)
@given(seed=st.integers(0, 2**32 - 1))
def test_each_component_goes_the_way_it_goes_alone(residual, jacobian, start, seed):
    random = np.random.default_rng(seed)
    starts = np.array(start) + random.normal(size=(6, len(start)))
    scale = 10.0 ** random.uniform(-3, 3, 6)
    together = levenberg_marquardt(side_by_side(residual, jacobian, starts, scale), starts, TIGHT)
    for k in range(6):
        one = starts[k : k + 1]
        alone = levenberg_marquardt(side_by_side(residual, jacobian, one, scale[k : k + 1]), one, TIGHT)
        assert together.unknowns[k] == pytest.approx(alone.unknowns[0], abs=1e-9)
        assert together.converged[k] == alone.converged[0]


@few
@given(seed=st.integers(0, 2**32 - 1))
def test_the_cost_never_rises(seed):
    starts = 2.0 * np.random.default_rng(seed).normal(size=(5, 2))
    model = side_by_side(rosenbrock, rosenbrock_jacobian, starts)
    before = model.cost(starts)
    for iterations in range(1, 12):
        after = levenberg_marquardt(model, starts, Stopping(iterations=iterations))
        assert np.all(after.cost <= before)
        assert after.cost == pytest.approx(model.cost(after.unknowns), rel=1e-12)
        before = after.cost


def test_a_linear_problem_of_coupled_blocks_is_solved_exactly():
    targets = np.random.default_rng(4).normal(size=(6, 3))
    chain = SpringChain(targets)
    solution = levenberg_marquardt(chain, np.zeros((6, 3)), TIGHT)
    _, there = chain.linearize(solution.unknowns)
    assert there.gradient == pytest.approx(0.0, abs=1e-7)
    assert solution.cost.shape == (1,)


def test_a_component_that_begins_at_its_minimum_stays_there():
    starts = np.array([[1.0, 1.0], [-1.2, 1.0]])
    solution = levenberg_marquardt(side_by_side(rosenbrock, rosenbrock_jacobian, starts), starts, TIGHT)
    assert np.array_equal(solution.unknowns[0], [1.0, 1.0])
    assert solution.unknowns[1] == pytest.approx([1.0, 1.0], abs=1e-8)


def test_at_a_cost_of_zero_there_is_nothing_to_gain_and_no_step_fails(monkeypatch):
    told = []
    damp = Nielsen.after

    def noted(rule, mu, growth, gain, failed):
        told.append((float(gain[0]), bool(failed[0])))
        return damp(rule, mu, growth, gain, failed)

    monkeypatch.setattr(Nielsen, "after", noted)
    start = np.array([[1.0, 1.0]])
    solution = levenberg_marquardt(side_by_side(rosenbrock, rosenbrock_jacobian, start), start, TIGHT)
    assert solution.converged.all()
    assert set(told) <= {(1.0, False)}
    assert told


def test_an_unknown_that_no_residual_sees_stays_where_it_was():
    def blind(u):
        return np.array([u[0] - 3.0])

    def blind_jacobian(_):
        return np.array([[1.0, 0.0]])

    start = np.array([[0.0, 5.0]])
    solution = levenberg_marquardt(side_by_side(blind, blind_jacobian, start), start, TIGHT)
    assert solution.unknowns[0] == pytest.approx([3.0, 5.0], abs=1e-6)


def test_running_out_of_iterations_is_told():
    start = np.array([[-1.2, 1.0]])
    solution = levenberg_marquardt(side_by_side(rosenbrock, rosenbrock_jacobian, start), start, Stopping(iterations=3))
    assert not solution.converged.any()
    assert solution.iterations == 3
    assert solution.stopped is Stop.STEP_LIMIT
    rested = levenberg_marquardt(side_by_side(rosenbrock, rosenbrock_jacobian, start), start, TIGHT)
    assert rested.stopped is Stop.AT_REST


def test_one_component_that_runs_out_of_iterations_is_told_of_all():
    starts = np.array([[1.0, 1.0], [-1.2, 1.0]])
    solution = levenberg_marquardt(
        side_by_side(rosenbrock, rosenbrock_jacobian, starts), starts, Stopping(iterations=3)
    )
    assert solution.converged.tolist() == [True, False]
    assert solution.stopped is Stop.STEP_LIMIT


def test_a_trial_that_makes_no_sense_is_refused():
    """A logarithm: the first full step leads to where it does not exist."""

    class Logarithm(Separate):
        def cost(self, unknowns):
            with np.errstate(invalid="ignore"):
                cost = 0.5 * np.log(unknowns[:, 0]) ** 2
            return np.where(np.isfinite(cost), cost, np.inf)

    start = np.array([[10.0]])
    model = Logarithm(lambda u: np.log(u), lambda u: np.diag(1.0 / u), pattern(1, 1, []), np.ones(1))
    solution = levenberg_marquardt(model, start, TIGHT)
    assert solution.unknowns == pytest.approx(np.ones((1, 1)), abs=1e-7)


@pytest.mark.parametrize("other", [2.0, 0.3, 1.0])
def test_a_trial_that_makes_no_sense_is_refused_beside_one_that_is_good(other):
    class Logarithm(Separate):
        def cost(self, unknowns):
            with np.errstate(invalid="ignore"):
                return 0.5 * np.log(unknowns[:, 0]) ** 2

    starts = np.array([[10.0], [other]])
    model = Logarithm(lambda u: np.log(u), lambda u: np.diag(1.0 / u), pattern(2, 1, []), np.ones(2))
    solution = levenberg_marquardt(model, starts, TIGHT)
    assert solution.unknowns == pytest.approx(np.ones((2, 1)), abs=1e-7)
    assert solution.converged.all()


def test_only_steps_that_gain_nothing_count_as_failed(monkeypatch):
    """Of one that gains a little less damping is not taken back."""
    told = []
    damp = Nielsen.after

    def noted(rule, mu, growth, gain, failed):
        told.append((gain, failed))
        return damp(rule, mu, growth, gain, failed)

    monkeypatch.setattr(Nielsen, "after", noted)
    for start in np.random.default_rng(1).uniform(-3.0, 3.0, (30, 1, 2)):
        levenberg_marquardt(side_by_side(rosenbrock, rosenbrock_jacobian, start), start, TIGHT)
    gains, failed = np.array(told)[:, :, 0].T
    assert np.array_equal(gains <= 0.0, failed)
    assert ((gains > 0.0) & (gains < 0.25)).any()
    assert (gains <= 0.0).any()


@pytest.mark.parametrize("reach", [0.1, 0.3, 1e9, None])
@pytest.mark.parametrize("damping", [1e-6, 1e-3, 10.0])
def test_of_a_linear_problem_every_step_gains_what_it_promises(monkeypatch, reach, damping):
    """Cut at bounds, within bounds that nothing touches, and without any."""
    gains = []
    damp = Nielsen.after

    def noted(rule, mu, growth, gain, failed):
        gains.append(float(gain[0]))
        return damp(rule, mu, growth, gain, failed)

    monkeypatch.setattr(Nielsen, "after", noted)
    chain: Any = LinearChain(np.random.default_rng(8), blocks=4, size=3)
    wide = np.full((4, 3), reach or 0.0)
    chain.bounds = Bounds(-wide, wide) if reach else None
    levenberg_marquardt(chain, np.zeros((4, 3)), Stopping(cost=1e-6, iterations=300), damping)
    # A step that a bound cuts may lead uphill, which is told by a gain of 0.
    assert np.array([gain for gain in gains if gain > 0.0]) == pytest.approx(1.0, rel=1e-4)
    assert max(gains) > 0.0


def test_bounds_that_nothing_touches_change_nothing():
    starts = np.random.default_rng(2).uniform(-3.0, 3.0, (8, 2))
    model = side_by_side(rosenbrock, rosenbrock_jacobian, starts)
    free = levenberg_marquardt(model, starts, TIGHT)
    model.bounds = Bounds(np.full((8, 2), -1e6), np.full((8, 2), 1e6))
    bound = levenberg_marquardt(model, starts, TIGHT)
    assert bound.iterations == free.iterations
    assert np.array_equal(bound.unknowns, free.unknowns)


def test_what_never_gets_better_comes_to_an_end():
    """A derivative of the wrong sign leads uphill, however short the step."""
    start = np.array([[3.0]])
    model = side_by_side(lambda u: u, lambda _: -np.eye(1), start)
    solution = levenberg_marquardt(model, start, Stopping(cost=1e-14, iterations=1000))
    assert solution.converged.all()
    assert solution.iterations < 100
    assert np.array_equal(solution.unknowns, start)


@pytest.mark.parametrize("unit", [1e-8, 1e-3, 1e5])
def test_the_unit_of_the_residuals_does_not_matter_within_bounds_either(unit):
    starts = np.array([[-1.2, 1.0], [0.3, 2.0]])

    def solved(scale):
        model = side_by_side(rosenbrock, rosenbrock_jacobian, starts, np.full(2, scale))
        model.bounds = Bounds(np.array([[-2.0, -0.5]] * 2), np.array([[0.7, 2.0], [1.5, 1.8]]))
        return levenberg_marquardt(model, starts, TIGHT)

    plain, scaled = solved(1.0), solved(unit)
    assert scaled.iterations == plain.iterations
    assert scaled.unknowns == pytest.approx(plain.unknowns, rel=1e-9)


@few
@given(seed=st.integers(0, 2**32 - 1))
def test_bounds_are_kept_and_end_where_a_bounded_linear_solver_ends(seed):
    """Coupled blocks with a linear residual against scipy's bounded-variable least squares."""
    random = np.random.default_rng(seed)
    chain = LinearChain(random, blocks=4, size=3)
    solution = levenberg_marquardt(chain, np.zeros((4, 3)), TIGHT)
    wanted = lsq_linear(chain.matrix, chain.right, (chain.bounds.lower.ravel(), chain.bounds.upper.ravel()), tol=1e-13)
    assert np.all((solution.unknowns >= chain.bounds.lower) & (solution.unknowns <= chain.bounds.upper))
    assert solution.cost.sum() == pytest.approx(wanted.cost, rel=1e-9)
    assert np.any((solution.unknowns == chain.bounds.lower) | (solution.unknowns == chain.bounds.upper))


def test_a_start_beyond_the_bounds_is_brought_within_them():
    start = np.array([[-1.2, 1.0]])
    model = side_by_side(rosenbrock, rosenbrock_jacobian, start)
    model.bounds = Bounds(np.array([[0.0, -np.inf]]), np.array([[0.5, np.inf]]))
    solution = levenberg_marquardt(model, start, TIGHT)
    assert solution.unknowns == pytest.approx(np.array([[0.5, 0.25]]), abs=1e-8)


def test_unknowns_on_their_bounds_are_within_them_and_just_beyond_they_are_not():
    bounds = Bounds(np.array([[-1.0, -np.inf]]), np.array([[2.0, 3.0]]))
    for within in ([[-1.0, 0.0]], [[2.0, 3.0]], [[0.0, -1e9]]):
        assert bounds.hold(np.array(within))
    for beyond in ([[np.nextafter(-1.0, -2.0), 0.0]], [[0.0, np.nextafter(3.0, 4.0)]]):
        assert not bounds.hold(np.array(beyond))
        assert bounds.hold(bounds.clip(np.array(beyond)))


def test_unknowns_are_blocked_on_a_bound_beyond_which_the_cost_would_fall_and_nowhere_else():
    """Where the cost does not change they are free to leave it, as between the bounds."""
    lower, upper = np.full((1, 3), -1.0), np.full((1, 3), 2.0)
    gradient = np.array([[1.0, 0.0, -1.0]])
    for unknowns, blocked in (
        (lower, [[True, False, False]]),
        (upper, [[False, False, True]]),
        (0.5 * lower, [[False] * 3]),
    ):
        assert Bounds(lower, upper).blocked(unknowns, gradient).tolist() == blocked


def test_where_a_system_cannot_be_solved_it_is_damped_more_and_more(monkeypatch):
    """As where rounding leaves a matrix that is not positive definite: by 2, then 4, then 8 times."""
    dampings = []

    def step(pattern, normal, scale, unknowns, bounds):
        dampings.append(float(scale.max()))
        return None if len(dampings) <= 3 else bounded_step(pattern, normal, scale, unknowns, bounds)

    monkeypatch.setattr(method, "bounded_step", step)
    start = np.array([[-1.2, 1.0]])
    solution = levenberg_marquardt(side_by_side(rosenbrock, rosenbrock_jacobian, start), start, TIGHT)
    assert np.array(dampings[1:4]) / dampings[:3] == pytest.approx([2.0, 4.0, 8.0])
    assert solution.unknowns == pytest.approx(np.ones((1, 2)), abs=1e-8)


@pytest.mark.parametrize("unit", [1e-8, 1e-3, 1e5])
def test_the_unit_of_the_residuals_does_not_matter(unit):
    """Also for the damping of an unknown that is hardly seen beside the other one."""

    def residual(u):
        return np.array([u[0] ** 3 - 8.0, 1e-7 * (u[1] - 5.0)])

    def jacobian(u):
        return np.array([[3.0 * u[0] ** 2, 0.0], [0.0, 1e-7]])

    start = np.array([[1.0, 0.0]])
    plain = levenberg_marquardt(side_by_side(residual, jacobian, start), start, TIGHT)
    scaled = levenberg_marquardt(side_by_side(residual, jacobian, start, np.array([unit])), start, TIGHT)
    assert scaled.iterations == plain.iterations
    assert scaled.unknowns == pytest.approx(plain.unknowns, rel=1e-9)


@pytest.mark.parametrize("least", [0, 1, 4])
def test_it_takes_as_many_steps_as_are_asked_for_at_least(least):
    start = np.array([[1.0, 1.0]])
    model = side_by_side(rosenbrock, rosenbrock_jacobian, start)
    assert levenberg_marquardt(model, start, Stopping(least=least)).iterations == max(least, 1)
