"""Who gives way where not everything can be held, and by how much."""

from dataclasses import replace

import numpy as np
import pytest

from cadpanel.solver.ended import Ended, Limits
from cadpanel.solver.giving_way import HeldSolution, _holds, _Search, hold_or_give_way
from cadpanel.solver.held_model import Point
from cadpanel.solver.hold import Hold
from cadpanel.solver.interior_point import interior_point
from cadpanel.solver.stop import Stop
from tests.solver.models import HeldBatch, HeldTargets, held_chain, held_points, side_by_side
from tests.thorough import cases


def between(first: float, second: float, **second_is: bool) -> HeldTargets:
    """One point of the plane held to (-1, 0) and to (1, 0) at once, within these distances."""
    centres = [np.array([[[side, 0.0]]]) for side in (-1.0, 1.0)]
    holds = [
        Hold(np.array([[first]]), weight=0.0, gives_way=True),
        Hold(np.array([[second]]), weight=0.0, gives_way=second_is.get("gives_way", True)),
    ]
    batches = [HeldBatch(hold, centre, (np.arange(1),)) for hold, centre in zip(holds, centres, strict=True)]
    return HeldTargets(np.zeros((1, 2)), batches)


def solve(model: HeldTargets, **how) -> HeldSolution:
    return hold_or_give_way(model, model.targets.copy(), Limits(), **how)


def test_what_can_be_held_is_held():
    found = solve(between(1.5, 1.5))
    assert found.stopped == (Stop.HELD,)
    assert found.excess <= 1.0


def test_what_cannot_be_held_is_exceeded_by_the_least_share():
    found = solve(between(0.5, 0.5))
    assert found.stopped == (Stop.STALLED,)
    # In the middle both vectors have the length 1, twice what is asked for.
    assert found.excess == pytest.approx(2.0, rel=0.1)
    assert found.unknowns == pytest.approx(np.zeros((1, 2)), abs=0.1)


def test_what_is_told_counts_in_what_was_asked_for_also_while_more_is_allowed():
    told: list[float] = []

    def tell(_step, excess, _cost):
        told.append(excess)
        return True

    found = solve(between(0.05, 0.05), tell=tell)
    # In the middle both vectors are twenty times as long as asked for.
    assert min(told) >= 19.9
    assert found.excess == pytest.approx(20.0, rel=0.05)


def test_what_must_not_give_way_holds_and_the_other_gives_way():
    found = solve(between(0.5, 0.5, gives_way=False))
    assert found.unknowns[0, 0] >= 0.5 - 1e-6
    assert found.excess == pytest.approx(3.0, rel=0.1)
    assert found.unknowns[0, 0] == pytest.approx(0.5, abs=0.1)


def test_no_distance_is_worth_more_than_the_most_cost():
    targets, far = np.array([[3.0, 0.0]]), np.zeros((1, 2))
    found = solve(held_points(targets, far, np.array([1.0])), most_cost=0.5)
    assert found.stopped == (Stop.TOO_COSTLY,)
    # Half the square of the way is the cost: a way of 1 at the most, to 2 of 1.
    assert 2.0 <= found.excess <= 2.3


def test_what_a_run_that_was_too_short_misses_is_looked_for_and_held_whole():
    targets = np.random.default_rng(2).normal(size=(12, 2))
    model = held_chain(targets, 0.05)
    short = interior_point(model, targets.copy(), Limits(steps=2))
    assert short.best.excess > 1.0
    found = hold_or_give_way(model, targets.copy(), Limits(steps=2))
    assert found.stopped == (Stop.HELD,)
    assert found.excess <= 1.0 + 1e-6


def test_what_is_told_to_stop_says_so_and_keeps_what_must_hold():
    model = between(0.9, 0.5, gives_way=False)
    found = solve(model, tell=lambda *_: False)
    assert found.stopped == (Stop.TOLD,)
    assert np.linalg.norm(found.unknowns[0] - np.array([1.0, 0.0])) <= 0.5 + 1e-6


def test_steps_of_every_try_are_counted():
    told = []

    def tell(*args):
        told.append(args)
        return True

    assert solve(between(0.5, 0.5), tell=tell).iterations == len(told)


def pulled(ends: float, radius: float) -> HeldTargets:
    """A chain of three points, the outer ones held hard near places that are so far apart."""
    chain = held_chain(np.array([[-0.5 * ends, 0.0], [0.0, 1.0], [0.5 * ends, 0.0]]), radius)
    near = Hold(np.full((2, 1), 0.01), weight=0.0)
    chain.held += (HeldBatch(near, chain.targets[[0, 2]][:, None], (np.array([0, 2]),)),)
    return chain


def test_what_cannot_be_held_in_one_component_opens_nothing_in_another():
    """Beside a chain that is far too short, one a little too short, and one that holds: as if each were alone."""
    chains = [pulled(6.0, 0.5), pulled(1.2, 0.5), pulled(0.8, 0.5)]
    together = side_by_side(*chains)
    found = hold_or_give_way(together, together.targets.copy(), Limits())
    assert found.stopped == (Stop.STALLED, Stop.STALLED, Stop.HELD)
    assert found.excess == pytest.approx([6.0, 1.2, 1.0], rel=0.1)
    for component, chain in enumerate(chains):
        alone = solve(chain)
        own = found.unknowns[3 * component : 3 * component + 3]
        assert own == pytest.approx(alone.unknowns, abs=1e-8)
        assert found.stopped[component] == alone.stopped[0]
        assert found.excess[component] == pytest.approx(alone.excess[0], abs=1e-8)


def test_going_on_with_some_components_leaves_all_others_as_they_were():
    chains = [pulled(6.0, 0.5), pulled(0.8, 0.5)]
    together = side_by_side(*chains)
    before = hold_or_give_way(together, together.targets.copy(), Limits())
    together.held[0].hold.tighten(np.array([0.9] * 4))
    only = np.array([False, True])
    after = hold_or_give_way(together, before.unknowns, Limits(), only=only, after=before)
    assert np.array_equal(after.unknowns[:3], before.unknowns[:3])
    assert after.stopped == before.stopped == (Stop.STALLED, Stop.HELD)
    assert np.linalg.norm(np.diff(after.unknowns[3:], axis=0), axis=1).max() <= 0.45 + 1e-6
    assert after.iterations > before.iterations


class Outside(HeldBatch):
    """A point of a line held out of the middle, 1 - x^2 below a distance, whose slope vanishes in the middle."""

    def vectors(self, unknowns):
        return (1.0 - unknowns[self.blocks[0]] ** 2)[:, None]

    def slopes(self, unknowns):
        return (-2.0 * unknowns[self.blocks[0]][:, None, :, None],)


class AroundTheMiddle(HeldTargets):
    """A point that wants to be in the middle, where it must not be, and perhaps near a place beside it."""

    def at(self, unknowns):
        point = super().at(unknowns)
        slopes = tuple(
            batch.slopes(unknowns) if isinstance(batch, Outside) else batch.jacobians() for batch in self.held
        )
        return Point(point.unknowns, point.cost, point.normal, point.vectors, slopes)


def around_the_middle(*near: HeldBatch) -> HeldTargets:
    hold = Hold(np.array([[0.19]]), weight=0.0, one_sided=True, scale=np.ones((1, 1)))
    return AroundTheMiddle(np.zeros((1, 1)), [Outside(hold, np.zeros((1, 1, 1)), (np.arange(1),)), *near])


def test_what_must_hold_is_begun_elsewhere_where_it_does_not_come_to_hold():
    asked = []

    def elsewhere(blocks, now):
        asked.append((blocks.tolist(), now.tolist()))
        return np.array([[2.0]]), 5

    stuck = solve(around_the_middle())
    assert stuck.stopped == (Stop.STALLED,)
    assert stuck.excess > 1.1
    found = solve(around_the_middle(), elsewhere=elsewhere)
    assert asked == [([True], [[0.0]])]
    assert found.stopped == (Stop.HELD,)
    assert found.unknowns[0, 0] == pytest.approx(0.9, abs=0.01)
    # Whoever is told to stop keeps what must hold, too.
    told = solve(around_the_middle(), elsewhere=elsewhere, tell=lambda *_: False)
    assert told.stopped == (Stop.TOLD,)
    assert abs(told.unknowns[0, 0]) >= 0.9 - 1e-6


@pytest.mark.parametrize(("most_cost", "reached"), [(0.1, 1.2), (10.0, 0.0)])
def test_what_must_hold_may_cost_whatever_it_takes_and_the_rest_as_much_again(most_cost, reached):
    """A point that is to be at 2 and must be 0.9 off the middle: for twice what that costs it gets to 1.27."""
    near = Hold(np.array([[0.1]]), weight=0.0, gives_way=True)
    model = around_the_middle(HeldBatch(near, np.full((1, 1, 1), 2.0), (np.arange(1),)))
    found = hold_or_give_way(model, np.array([[1.5]]), Limits(), most_cost=most_cost)
    left = 2.0 - found.unknowns[0, 0]
    if reached:
        assert found.stopped == (Stop.TOO_COSTLY,)
        assert np.sqrt(2.0) * 0.9 * 0.9 <= found.unknowns[0, 0] <= np.sqrt(2.0) * 0.9 * 1.01
        assert found.excess == pytest.approx(left / 0.1, rel=1e-3)
    else:
        assert found.stopped == (Stop.HELD,)
        assert left <= 0.1 + 1e-6


@pytest.mark.parametrize("seed", range(cases(1, 3)))
def test_how_far_distances_are_exceeded_does_not_hang_on_what_was_asked_for(seed):
    """What holds narrow ones holds wide ones, and what holds none is exceeded by as much."""
    ends = float(np.random.default_rng(seed).uniform(3.0, 8.0))
    exceeded = []
    for radius in np.geomspace(0.01, 1.2 * ends, cases(5, 8)):
        model = pulled(ends, float(radius))
        found = hold_or_give_way(model, model.targets.copy(), Limits(least_cost=1e-6))
        if found.excess[0] > 1.0 + 1e-6:
            assert not found.held
            exceeded.append(radius * found.excess[0])
            assert radius < exceeded[0]
    assert len(exceeded) >= cases(3, 4)
    assert exceeded == pytest.approx([exceeded[0]] * len(exceeded), rel=1e-6)
    # Held at both ends, the middle is 0.01 nearer to either one.
    assert exceeded[0] == pytest.approx(0.5 * ends - 0.01, rel=0.06)


def ended(excess: float, ease: float = 1.0, firm: float = 0.0) -> Ended:
    """An end of one point that exceeds its distance, which is so many times as wide, so many times."""
    model = held_points(np.array([[3.0, 0.0]]), np.zeros((1, 2)), np.ones(1))
    end = interior_point(model, model.targets.copy(), Limits(steps=0))
    best = replace(end.best, firm=np.array([firm]), excess=np.array([excess]), unknowns=np.array([[excess, ease]]))
    return replace(end, best=best, ease=np.array([ease]), steps=7)


def searching() -> _Search:
    model = held_points(np.array([[3.0, 0.0]]), np.zeros((1, 2)), np.ones(1))
    return _Search(model, Limits(), np.inf, None, None)


@pytest.mark.parametrize(
    ("one", "other", "better"),
    [
        (ended(1.0, 4.0), ended(2.0, 1.0), True),
        (ended(1.0, 2.0), ended(3.0, 1.0), False),
        (ended(2.0), ended(9.0, firm=1.5), False),
        (ended(2.0, firm=1.5), ended(9.0, firm=1.2), True),
        (ended(2.0, firm=0.2), ended(1.9, firm=0.9), True),
        (ended(1.9, firm=0.9), ended(2.0, firm=0.2), False),
    ],
)
def test_better_is_what_holds_what_it_must_and_then_what_exceeds_what_was_asked_for_less(one, other, better):
    found = searching()._better(one, other, np.ones(1, dtype=bool))
    assert np.array_equal(found.best.unknowns, (other if better else one).best.unknowns)


@pytest.mark.parametrize(("excess", "ease", "holds"), [(0.4, 2.0, True), (0.6, 2.0, False), (1.5, 0.5, True)])
def test_what_was_widened_holds_where_it_would_without(excess, ease, holds):
    end = ended(excess, ease)
    assert _holds(end.best, end.ease).tolist() == [holds]
    stopped = (Stop.HELD,)
    assert HeldSolution(end, stopped, 1).excess.tolist() == [excess * ease]


def test_what_came_much_nearer_is_gone_on_with_and_what_hardly_did_not_is_not_asked_again(monkeypatch):
    """From 10 it tries 10 / 1.7; what comes to 7.6 without holding goes on from there, what comes to 9.8 does not."""
    for excess, following in ((1.3, 1.3 / 1.7 * 10.0 / 1.7), (1.66, np.sqrt(1.66) * 10.0 / 1.7)):
        search = searching()
        trials: list[float] = []

        def steps(_start, trial, *_, trials=trials, excess=excess, search=search):
            trials.append(float(trial[0]))
            search.told = len(trials) == 2
            return ended(excess)

        monkeypatch.setattr(search, "_steps_from", steps)
        search._narrowed(ended(10.0), np.ones(1, dtype=bool), np.zeros(1))
        assert trials == pytest.approx([10.0 / 1.7, following], rel=1e-12)


def test_linear_systems_of_all_that_was_tried_are_counted():
    """Also of what another solution took, and of what was done elsewhere."""
    one, other = (HeldSolution(ended(1.0), (Stop.HELD,), steps) for steps in (30, 12))
    assert one.mixed(other, np.ones(1, dtype=bool), searching()._blocks).iterations == 42
    counts = [
        solve(around_the_middle(), elsewhere=lambda *_, extra=extra: (np.array([[2.0]]), extra)).iterations
        for extra in (5, 1005)
    ]
    assert counts[1] - counts[0] == 1000


def test_where_nothing_can_give_way_what_must_hold_is_tried_once():
    """The same steps again would end at the same place; elsewhere is another matter."""
    stuck = solve(around_the_middle())
    once = interior_point(around_the_middle(), np.zeros((1, 1)), Limits())
    assert stuck.iterations == once.steps
    assert np.array_equal(stuck.unknowns, once.best.unknowns)
