"""Vectors held within distances: problems whose constrained optimum is known."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import NonlinearConstraint, minimize

from cadpanel.arrays import Array
from cadpanel.solver.bounds import Bounds
from cadpanel.solver.ended import Limits
from cadpanel.solver.hold import Hold
from cadpanel.solver.interior_point import _Run, interior_point
from tests.solver.models import HeldBatch, HeldTargets, held_chain, held_points, side_by_side
from tests.thorough import thorough

few = settings(max_examples=10)
seeds = st.integers(0, 2**32 - 1)
# What the barrier leaves, as a share of the cost.
LEFT = 1e-2


@few
@given(seed=seeds)
def test_held_points_end_at_their_projections_onto_the_balls(seed):
    random = np.random.default_rng(seed)
    targets, centres = random.normal(size=(2, 6, 3))
    radius = random.uniform(0.05, 1.0, 6)
    model = held_points(targets, centres, radius)
    # Points whose targets lie inside their balls cost nothing.
    end = interior_point(model, targets.copy(), Limits(least_cost=1e-9))
    out = targets - centres
    length = np.linalg.norm(out, axis=1)
    expected = centres + out * np.minimum(1.0, radius / length)[:, None]
    assert end.settled.all()
    assert np.all(end.best.excess <= 1.0 + 1e-9)
    assert model.free_cost(end.best.unknowns) == pytest.approx(model.free_cost(expected), rel=LEFT, abs=1e-9)


@few
@given(seed=seeds)
def test_multipliers_are_the_weights_that_hold_the_vectors(seed):
    """Karush, Kuhn, Tucker: where a vector touches its distance, target - x = weight (x - centre)."""
    random = np.random.default_rng(seed)
    centre, way = random.normal(size=(2, 1, 2))
    end = interior_point(held_points(centre + way, centre, 0.5 * np.linalg.norm(way, axis=1)), centre + way, Limits())
    # Halfway to the target the pull of the target and that of the centre are equal; the barrier leaves a part of it.
    assert end.multipliers[0] == pytest.approx(1.0, rel=0.2)


def test_a_distance_that_does_not_bind_needs_no_multiplier():
    targets = np.array([[1.0, 0.0], [3.0, 0.0]])
    end = interior_point(held_points(targets, np.zeros((2, 2)), np.array([2.0, 2.0])), targets.copy(), Limits())
    assert end.multipliers[0][0, 0] < 5e-3
    assert end.multipliers[0][1, 0] == pytest.approx(0.5, rel=0.01)


@few
@given(seed=seeds, radius=st.sampled_from([0.02, 0.2, 0.8]))
def test_a_held_chain_reaches_the_constrained_minimum(seed, radius):
    targets = np.random.default_rng(seed).normal(size=(4, 2))
    model = held_chain(targets, radius)
    end = interior_point(model, targets.copy(), Limits())

    def cost(x: Array) -> float:
        return model.free_cost(x.reshape(4, 2))

    limits = NonlinearConstraint(lambda x: np.sum(np.diff(x.reshape(4, 2), axis=0) ** 2, axis=1), -np.inf, radius**2)
    exact: Any = minimize(cost, np.tile(targets.mean(axis=0), 4), constraints=limits, method="SLSQP")
    assert exact.success
    assert model.free_cost(end.best.unknowns) == pytest.approx(exact.fun, rel=LEFT)


@few
@given(seed=seeds, unit=st.sampled_from([1e-3, 1.0, 1e3]))
def test_the_unit_of_lengths_does_not_matter(seed, unit):
    targets = np.random.default_rng(seed).normal(size=(5, 2))
    # Steps have about a length of their own in radians and panel lengths, so the way may differ, the end not.
    ends = [held_chain(size * targets, 0.3 * size) for size in (1.0, unit)]
    costs = [m.free_cost(interior_point(m, m.targets.copy(), Limits()).best.unknowns) for m in ends]
    assert costs[1] / unit**2 == pytest.approx(costs[0], rel=2.0 * LEFT)


def numbers_below(most: float) -> HeldTargets:
    """A point at 3 on a line that may be at `most` at the most."""
    hold = Hold(np.array([[most]]), weight=0.0, one_sided=True, scale=np.ones((1, 1)))
    return HeldTargets(np.array([[3.0]]), [HeldBatch(hold, np.zeros((1, 1, 1)), (np.arange(1),))])


def test_a_number_stays_below_what_it_may_reach_and_as_far_below_as_it_likes():
    held = interior_point(numbers_below(2.0), np.zeros((1, 1)), Limits())
    assert held.best.unknowns[0, 0] == pytest.approx(2.0, abs=0.01)
    assert held.best.firm <= 1.0 + 1e-9
    free = numbers_below(2.0)
    free.targets = np.array([[-50.0]])
    assert interior_point(free, np.zeros((1, 1)), Limits()).best.unknowns[0, 0] == pytest.approx(-50.0, rel=1e-3)


def test_unknowns_keep_to_their_bounds():
    model = held_chain(np.array([[0.0, 0.0], [2.0, 1.0]]), 0.5)
    model.bounds = Bounds(np.array([[0.0, 0.0], [-9.0, -9.0]]), np.array([[0.0, 0.0], [9.0, 9.0]]))
    end = interior_point(model, np.array([[0.0, 0.0], [2.0, 1.0]]), Limits())
    assert np.all(end.best.unknowns[0] == 0.0)
    assert end.best.unknowns[1] == pytest.approx(0.5 * np.array([2.0, 1.0]) / np.sqrt(5.0), rel=1e-2)


def test_every_step_is_told_and_anybody_may_end_it():
    model = held_chain(np.random.default_rng(1).normal(size=(6, 2)), 0.1)
    told: list[tuple[int, float, Array]] = []

    def tell(*args):
        told.append(args)
        return len(told) < 3

    end = interior_point(model, model.targets.copy(), Limits(), tell=tell)
    assert end.told_to_stop
    assert not end.settled
    assert [step for step, _, _ in told] == [1, 2, 3]
    assert told[-1][2].sum() == model.free_cost(end.now.unknowns)


def test_going_on_with_its_multipliers_takes_fewer_steps():
    targets = np.random.default_rng(3).normal(size=(30, 3))
    model = held_chain(targets, 0.1)
    first = interior_point(model, targets.copy(), Limits())
    narrower = held_chain(targets, 0.099)
    cold = interior_point(narrower, targets.copy(), Limits())
    warm = interior_point(narrower, first.best.unknowns, Limits(), after=first)
    costs: list[float] = []

    def tell(*args):
        costs.append(args[2].sum())
        return True

    interior_point(held_chain(targets, 0.099), first.best.unknowns, Limits(), after=first, tell=tell)
    assert max(costs) <= 1.05 * first.best.cost
    assert warm.settled
    assert warm.steps < cold.steps
    assert narrower.free_cost(warm.best.unknowns) == pytest.approx(narrower.free_cost(cold.best.unknowns), rel=LEFT)


def test_wider_distances_are_those_of_what_gives_way_alone():
    targets = np.array([[3.0, 0.0], [0.0, 3.0]])
    for gives_way, reached in ((True, 2.0), (False, 1.0)):
        model = held_points(targets, np.zeros((2, 2)), np.ones(2), gives_way=gives_way)
        end = interior_point(model, targets.copy(), Limits(), ease=2.0)
        assert np.linalg.norm(end.best.unknowns, axis=1) == pytest.approx(reached, rel=1e-2)


@few
@given(seed=seeds)
@thorough
def test_each_component_goes_the_way_that_it_goes_alone(seed):
    """Straight chains and chains that bend far, long and short ones, with their own distances."""
    random = np.random.default_rng(seed)
    chains = [
        held_chain(bend * random.normal(size=(count, 2)), radius)
        for count, bend, radius in ((4, 5.0, 0.5), (3, 0.1, 0.5), (6, 1.0, 0.05))
    ]
    together = side_by_side(*chains)
    end = interior_point(together, together.targets.copy(), Limits())
    first = 0
    for component, chain in enumerate(chains):
        alone = interior_point(chain, chain.targets.copy(), Limits())
        count = len(chain.targets)
        assert end.best.unknowns[first : first + count] == pytest.approx(alone.best.unknowns, abs=1e-8)
        assert end.settled[component] == alone.settled[0]
        assert end.mu[component] == pytest.approx(alone.mu[0])
        first += count


def test_what_is_not_to_move_stays_where_it_stands_and_holds_up_nothing():
    chains = [held_chain(np.random.default_rng(seed).normal(size=(4, 2)), 0.2) for seed in (1, 2)]
    together = side_by_side(*chains)
    end = interior_point(together, together.targets.copy(), Limits(), only=np.array([False, True]))
    assert np.array_equal(end.best.unknowns[:4], chains[0].targets)
    assert end.settled.tolist() == [False, True]
    alone = interior_point(chains[1], chains[1].targets.copy(), Limits())
    assert end.best.unknowns[4:] == pytest.approx(alone.best.unknowns, abs=1e-8)


class Uphill(HeldTargets):
    """A model whose slope points the wrong way, and whose curvature is this many times what it is."""

    curvature = 1.0

    def at(self, unknowns):
        point = super().at(unknowns)
        point.normal.gradient *= -1.0
        point.normal.diagonal *= self.curvature
        return point


def uphill(curvature: float) -> Uphill:
    model = held_points(np.array([[3.0, 0.0]]), np.zeros((1, 2)), np.ones(1))
    wrong = Uphill(model.targets, model.held)
    wrong.curvature = curvature
    return wrong


def test_where_nothing_helps_it_begins_anew_three_times_and_no_more(monkeypatch):
    begun = []
    begin_anew = _Run._begin_anew

    def noted(run, where):
        begun.append(where.tolist())
        begin_anew(run, where)

    monkeypatch.setattr(_Run, "_begin_anew", noted)
    interior_point(uphill(1e-6), np.array([[2.0, 0.0]]), Limits(steps=100))
    assert begun == [[True]] * 3


def test_what_cannot_be_solved_is_damped_ten_times_as_heavily_until_that_helps_no_more():
    """From 0.03 to a million in 8 steps; before, it begins anew after 7 of them, three times."""
    end = interior_point(uphill(-1e12), np.array([[2.0, 0.0]]), Limits(steps=100))
    assert end.steps == 3 * 7 + 8
    assert end.damping.tolist() == [1e6]
    assert not end.settled.any()


@pytest.mark.parametrize(("firm", "waits"), [(0.9995, 0), (1.0009, 0), (1.0011, 1), (1.49, 1), (1.51, 0)])
def test_what_may_give_way_waits_while_what_must_hold_exceeds_its_distance_by_a_little(firm, waits):
    model = held_points(np.array([[3.0, 0.0]]), np.zeros((1, 2)), np.ones(1))
    run = _Run(model, model.targets.copy(), Limits(patience=5), 1.0, None, None)
    run.now = replace(run.now, firm=np.array([firm]))
    widest, nothing = run.widest.copy(), np.zeros(1, dtype=bool)
    run._narrow(nothing, nothing, np.ones(1), np.ones(1))
    assert run.waited.tolist() == [waits]
    assert (run.widest < widest).tolist() == [not waits]


@pytest.mark.parametrize("idle", [5, 12])
def test_what_comes_no_nearer_to_holding_is_given_up_and_what_holds_goes_on(idle):
    """A chain whose ends must be too far apart; beside it what can be held ends where it would without."""
    chains = []
    for apart in (6.0, 0.8):
        chain = held_chain(np.array([[-0.5 * apart, 0.0], [0.5 * apart, 0.0]]), 1.0)
        near = Hold(np.full((2, 1), 0.01), weight=0.0)
        chain.held += (HeldBatch(near, chain.targets[:, None], (np.arange(2),)),)
        chains.append(chain)
    both = side_by_side(*chains)
    most, few = (interior_point(both, both.targets.copy(), Limits(least_cost=1e-9, idle=i)) for i in (np.inf, idle))
    assert idle < few.steps < most.steps
    assert few.settled.tolist() == most.settled.tolist() == [False, True]
    assert few.best.excess[0] > 1.0
    assert few.best.unknowns[2:] == pytest.approx(most.best.unknowns[2:], abs=1e-9)
