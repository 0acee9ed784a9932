"""Held vectors: convex problems whose constrained optimum is known."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import NonlinearConstraint, minimize

from cadpanel.arrays import Array
from cadpanel.solver.constrained import Schedule, hold_tolerances
from cadpanel.solver.stop import Stop
from cadpanel.solver.tolerance_weights import Hold
from tests.solver.models import HeldChain, HeldPoints

# The balance ends where the free cost is at rest within this share and no vector is further out than this share.
AT_REST, SLACK = 1e-5, 1e-4
TIGHT = Schedule(balance=200, stationarity=AT_REST, feasibility=SLACK)
# The weight of a vector that all but touches its distance fades slowly: so far off may its point be in the end.
NEARLY_BINDING = 0.02
few = settings(max_examples=10)
seeds = st.integers(0, 2**32 - 1)


def solve(model, start, schedule=TIGHT, progress=None):
    return hold_tolerances(model, [model], model.free_cost, start, schedule, progress=progress)


@few
@given(seed=seeds)
def test_held_points_end_at_their_projections_onto_the_balls(seed):
    random = np.random.default_rng(seed)
    targets, centres = random.normal(size=(2, 6, 3))
    radius = random.uniform(0.05, 1.0, 6)
    model = HeldPoints(targets, centres, radius)
    found = solve(model, targets.copy())
    out = targets - centres
    length = np.linalg.norm(out, axis=1)
    expected = centres + out * np.minimum(1.0, radius / length)[:, None]
    assert found.unknowns == pytest.approx(expected, abs=NEARLY_BINDING)
    assert model.free_cost(found.unknowns) == pytest.approx(model.free_cost(expected), rel=2e-3)
    assert found.excess <= 1.0 + SLACK


@few
@given(seed=seeds)
def test_weights_are_the_multipliers_of_the_distances(seed):
    """Karush, Kuhn, Tucker: where a vector touches its distance, target - x = weight (x - centre)."""
    random = np.random.default_rng(seed)
    targets, centres = random.normal(size=(2, 4, 2))
    distance = np.linalg.norm(targets - centres, axis=1)
    model = HeldPoints(targets, centres, 0.5 * distance)
    solve(model, targets.copy())
    # Halfway to the target the pull of the target and that of the centre are equal.
    assert model.hold.weight == pytest.approx(1.0, rel=0.02)


def test_a_distance_that_does_not_bind_lets_its_weight_go():
    targets = np.array([[1.0, 0.0], [3.0, 0.0]])
    model = HeldPoints(targets, np.zeros((2, 2)), np.array([2.0, 2.0]))
    found = solve(model, targets.copy())
    assert found.unknowns == pytest.approx(np.array([[1.0, 0.0], [2.0, 0.0]]), abs=2e-3)
    assert model.hold.weight[0, 0] < 1e-3
    assert model.hold.weight[1, 0] == pytest.approx(0.5, rel=0.01)


@few
@given(seed=seeds, radius=st.sampled_from([0.02, 0.2, 0.8]))
def test_a_held_chain_reaches_the_constrained_minimum(seed, radius):
    targets = np.random.default_rng(seed).normal(size=(4, 2))
    model = HeldChain(targets, radius)
    found = solve(model, targets.copy())

    def cost(x: Array) -> float:
        return model.free_cost(x.reshape(4, 2))

    limits = NonlinearConstraint(lambda x: np.sum(np.diff(x.reshape(4, 2), axis=0) ** 2, axis=1), -np.inf, radius**2)
    start = np.tile(targets.mean(axis=0), 4)
    exact: Any = minimize(cost, start, constraints=limits, method="SLSQP")
    assert exact.success
    assert model.free_cost(found.unknowns) == pytest.approx(exact.fun, rel=5e-3)


@few
@given(seed=seeds, weight=st.sampled_from([1e-3, 1.0, 1e3]))
def test_where_the_distances_can_be_held_they_are(seed, weight):
    random = np.random.default_rng(seed)
    targets, centres = random.normal(size=(2, 6, 3))
    model = HeldPoints(targets, centres, random.uniform(0.001, 0.5, 6), weight=weight)
    # No slack: the rounds go on until nothing is out at all.
    found = solve(model, targets.copy(), Schedule())
    assert found.excess <= 1.0 + Schedule().feasibility
    strict = solve(model, found.unknowns, Schedule(balance=0, feasibility=0.0))
    assert strict.excess <= 1.0


def test_what_cannot_be_held_is_told_by_an_excess_above_one():
    """One point held to two places at once, further apart than both distances together."""

    class TwoHolds(HeldPoints):
        def vectors_at(self, unknowns):
            return np.stack([unknowns - self.centres, unknowns + self.centres], axis=1)

        def cost(self, unknowns):
            squares = np.sum(self.vectors_at(unknowns) ** 2, axis=-1)
            return 0.5 * np.sum((unknowns - self.targets) ** 2, axis=1) + 0.5 * np.sum(
                self.hold.weight * squares, axis=1
            )

        def linearize(self, unknowns):
            _, normal = super().linearize(unknowns)
            weights = self.hold.weight
            pulls = np.sum(weights[..., None] * self.vectors_at(unknowns), axis=1)
            normal.gradient[:] = unknowns - self.targets + pulls
            normal.diagonal[:] = (1.0 + weights.sum(axis=1))[:, None, None] * np.eye(unknowns.shape[1])
            return self.cost(unknowns), normal

    model = TwoHolds(np.zeros((1, 2)), np.array([[1.0, 0.0]]), np.array([0.9]))
    model.hold = Hold(np.array([[0.9, 0.9]]), weight=1.0, least=1e-9)
    told = []
    found = solve(
        model, np.zeros((1, 2)), Schedule(balance=20, close=10, patience=30), lambda round_, _: told.append(round_)
    )
    assert told == list(range(1, 31))
    assert found.stopped is Stop.STEP_LIMIT
    told.clear()
    sooner = solve(model, np.zeros((1, 2)), Schedule(patience=3), lambda round_, _: told.append(round_))
    assert len(told) < 30
    assert sooner.stopped is Stop.STALLED
    # In the middle both vectors have the length 1.
    assert found.excess == pytest.approx(1.0 / 0.9, rel=1e-3)


def test_each_end_says_why_it_is_the_end():
    targets = np.array([[3.0, 0.0]])
    held = solve(HeldPoints(targets, np.zeros((1, 2)), np.array([1.0])), targets)
    assert held.stopped is Stop.HELD
    model = HeldPoints(targets, np.zeros((1, 2)), np.array([1.0]))
    dear = hold_tolerances(model, [model], model.free_cost, targets, TIGHT, most_cost=0.1)
    assert dear.stopped is Stop.TOO_COSTLY
    assert dear.excess > 1.0
    short = solve(HeldPoints(targets, np.zeros((1, 2)), np.array([1.0])), targets, Schedule(balance=1, close=0))
    assert short.stopped is Stop.STEP_LIMIT
    assert short.rounds == 1


def test_every_round_is_told():
    targets = np.array([[3.0, 0.0]])
    told = []
    found = solve(
        HeldPoints(targets, np.zeros((1, 2)), np.array([1.0])), targets, progress=lambda *args: told.append(args)
    )
    assert [round_ for round_, _ in told] == list(range(1, found.rounds + 1))
    assert told[-1][1] == found.excess


def test_without_held_vectors_there_is_no_excess():
    hold = Hold(np.ones((0, 4)), weight=1.0, least=1e-9)
    assert hold.excess(np.zeros((0, 4, 3))) == 0.0


def test_tightening_shrinks_distances_and_keeps_weights():
    hold = Hold(np.ones((2, 3)), weight=2.0, least=1e-9)
    hold.tighten(np.array([0.5, 1.0]))
    assert np.all(hold.radius == [[0.5], [1.0]])
    assert np.all(hold.weight == 2.0)
    assert np.all(hold.roots() == np.sqrt(2.0))


def test_weights_rise_where_vectors_are_long_and_sink_where_they_are_short():
    hold = Hold(np.ones((1, 3)), weight=1.0, least=1e-9)
    vectors = np.array([[[2.0, 0.0], [1.0, 0.0], [0.0, 0.5]]])
    hold.adapt(vectors, only_grow=False)
    assert hold.weight[0, 0] > 1.0
    assert hold.weight[0, 1] == pytest.approx(1.0)
    assert hold.weight[0, 2] < 1.0
    closing = Hold(np.ones((1, 3)), weight=1.0, least=1e-9)
    closing.adapt(vectors, only_grow=True)
    assert closing.weight[0, 2] == 1.0


def test_no_weight_leaves_its_bounds():
    hold = Hold(np.ones((1, 2)), weight=1.0, least=1e-3)
    for _ in range(100):
        hold.adapt(np.array([[[1e6], [1e-9]]]), only_grow=False)
    assert hold.weight[0, 0] == pytest.approx(1e5)
    assert hold.weight[0, 1] == pytest.approx(1e-3)


@pytest.mark.parametrize("balance", [1, 3])
def test_the_last_round_of_the_balance_is_still_one_of_it(balance):
    """What holds from the start counts as done once the cost is at rest or the balance is over, not before."""
    targets = np.array([[1.0, 0.0], [3.0, 0.0]])
    model = HeldPoints(targets, np.zeros((2, 2)), np.array([9.0, 9.0]))
    found = solve(model, targets.copy(), Schedule(balance=balance, close=5, stationarity=0.0))
    assert found.rounds == balance + 1


def test_the_balance_ends_once_the_cost_is_at_rest():
    """Long before its last round, where all holds from the start."""
    targets = np.array([[1.0, 0.0], [3.0, 0.0]])
    model = HeldPoints(targets, np.zeros((2, 2)), np.array([9.0, 9.0]))
    assert solve(model, targets.copy(), Schedule(balance=60, close=5, patience=60)).rounds < 50


def test_of_all_that_holds_the_last_one_below_the_most_cost_is_kept():
    """The later, the more settled; what costs too much is no answer, however well it holds."""
    targets = np.array([[1.0, 0.0], [3.0, 0.0]])
    model = HeldPoints(targets, np.zeros((2, 2)), np.array([9.0, 9.0]))
    costs = iter([1.0, 2.0, 3.0, 100.0])
    how = Schedule(balance=20, close=5, stationarity=0.0)
    found = hold_tolerances(model, [model], lambda _: next(costs), targets.copy(), how, most_cost=50.0)
    assert found.rounds == 3


def test_what_just_reaches_its_distance_is_held():
    class Touching:
        hold = SimpleNamespace(excess=lambda _: 1.0, violation=lambda _: 0.0, adapt=lambda *_, **__: None)

        def vectors_at(self, unknowns: Array) -> Array:
            return unknowns[:, None]

    targets = np.array([[1.0, 0.0]])
    model = HeldPoints(targets, np.zeros((1, 2)), np.array([9.0]))
    touching: Any = Touching()
    how = Schedule(balance=1, close=5, stationarity=0.0)
    assert hold_tolerances(model, [touching], model.free_cost, targets.copy(), how).rounds == 2


def test_a_cost_that_has_come_to_nothing_is_at_rest():
    """There is no share of it by which it could change."""
    targets = np.array([[1.0, 0.0]])
    model = HeldPoints(targets, np.zeros((1, 2)), np.array([9.0]))
    found = hold_tolerances(model, [model], lambda _: 0.0, targets, Schedule(balance=20, close=5, stationarity=1e-6))
    assert (found.rounds, found.stopped) == (2, Stop.HELD)
