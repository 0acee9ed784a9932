"""What held vectors add to a step: the slope and curvature of their penalties."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cadpanel.solver.barrier import Barriers
from cadpanel.solver.blocks import Normal
from cadpanel.solver.central_path import central_weight
from cadpanel.solver.held_rows import HeldRows, Rowed
from cadpanel.solver.hold import Hold
from tests.solver.models import HeldBatch

few = settings(max_examples=15)
seeds = st.integers(0, 2**32 - 1)
MU, MOST = 0.05, 7.0
EVERYWHERE = np.ones(4, dtype=bool)


def case(
    seed: int, *, one_sided: bool = False, weight: float = 0.3, ties: float = 1.0
) -> tuple[Barriers, HeldBatch, np.ndarray]:
    """A barrier of four vectors between three points, on its central path there."""
    random = np.random.default_rng(seed)
    size = 1 if one_sided else 3
    hold = Hold(random.uniform(0.5, 2.0, (2, 2)), weight=weight, one_sided=one_sided, gives_way=True, ties=ties)
    first = np.arange(2)
    batch = HeldBatch(hold, random.normal(size=(2, 2, size)), (first, first + 1), first)
    at = random.normal(size=(3, size))
    barrier = Barriers(HeldRows.of_batches([batch], [batch.vectors(at)], 3, 2), most=MOST, ease=1.0)
    barrier.weight = central_weight(barrier.numbers(rowed(barrier, batch, at)), MU, barrier.most)
    return barrier, batch, at


def rowed(barrier: Barriers, batch: HeldBatch, at: np.ndarray) -> Rowed:
    """The vectors at unknowns."""
    return barrier.held.measured([batch.vectors(at)])


@few
@given(seed=seeds, one_sided=st.booleans())
def test_on_the_central_path_the_gradient_is_the_slope_of_the_penalties(seed, one_sided):
    barrier, batch, at = case(seed, one_sided=one_sided)
    normal = Normal.zero(3, at.shape[1], 2)
    barrier.add_to(normal, rowed(barrier, batch, at), [batch.jacobians()], MU, np.zeros(3))
    numeric = np.zeros_like(at)
    for k in np.ndindex(at.shape):
        step = np.zeros_like(at)
        step[k] = 1e-6
        ahead, behind = (barrier.cost(rowed(barrier, batch, at + side * step), MU).sum() for side in (1.0, -1.0))
        numeric[k] = (ahead - behind) / 2e-6
    assert normal.gradient == pytest.approx(numeric, rel=1e-5, abs=1e-7)


@few
@given(seed=seeds)
def test_the_matrix_is_that_of_the_penalties_where_vectors_follow_unknowns_evenly(seed):
    """Then nothing is left out: Newton's own matrix."""
    barrier, batch, at = case(seed)
    normal = Normal.zero(3, 3, 2)
    barrier.add_to(normal, rowed(barrier, batch, at), [batch.jacobians()], MU, np.zeros(3))
    along = np.random.default_rng(seed + 1).normal(size=at.shape)

    def slope(where: np.ndarray) -> np.ndarray:
        there = Normal.zero(3, 3, 2)
        barrier.weight = central_weight(barrier.numbers(rowed(barrier, batch, where)), MU, barrier.most)
        barrier.add_to(there, rowed(barrier, batch, where), [batch.jacobians()], MU, np.zeros(3))
        return there.gradient

    numeric = (slope(at + 1e-6 * along) - slope(at - 1e-6 * along)) / 2e-6
    product = np.einsum("bij,bj->bi", normal.diagonal, along)
    for pair in range(2):
        product[pair] += normal.coupling[pair] @ along[pair + 1]
        product[pair + 1] += normal.coupling[pair].T @ along[pair]
    assert product == pytest.approx(numeric, rel=1e-4, abs=1e-6)


@few
@given(seed=seeds)
def test_a_bend_is_the_gradient_of_rows_whose_vectors_are_off(seed):
    barrier, batch, at = case(seed, weight=0.0)
    normal = Normal.zero(3, 3, 2)
    work = barrier.add_to(normal, rowed(barrier, batch, at), [batch.jacobians()], MU, np.zeros(3))
    move = np.random.default_rng(seed + 2).normal(size=at.shape)
    gradient = np.zeros_like(at)
    barrier.bend(gradient, work, barrier.moved([batch.jacobians()], move))
    product = np.einsum("bij,bj->bi", normal.diagonal, move)
    for pair in range(2):
        product[pair] += normal.coupling[pair] @ move[pair + 1]
        product[pair + 1] += normal.coupling[pair].T @ move[pair]
    assert gradient == pytest.approx(product, abs=1e-9)


def test_distances_narrow_and_never_widen_and_the_pull_stays():
    barrier, batch, at = case(4)
    vectors = 9.0 * batch.vectors(at)

    def times(share: float) -> Rowed:
        return barrier.held.measured([share * vectors])

    barrier.open(times(1.0), 0.0, 0.8, MU)
    wide, pull = barrier.tau.copy(), barrier.weight / barrier.tau
    assert np.all(wide >= 0.8 * np.linalg.norm(vectors, axis=-1).reshape(-1) - 1e-12)
    barrier.follow(times(0.5), 0.0, 0.8, EVERYWHERE)
    assert np.all(barrier.tau < wide)
    assert barrier.weight / barrier.tau == pytest.approx(pull)
    narrow = barrier.tau.copy()
    barrier.follow(times(20.0), 0.0, 0.8, EVERYWHERE)
    assert np.array_equal(barrier.tau, narrow)
    barrier.follow(times(0.0), 0.0, 0.8, EVERYWHERE)
    assert np.array_equal(barrier.tau, batch.hold.radius.reshape(-1))
    assert np.all(barrier.lagging == 1.0)


def test_only_what_is_pressed_may_pull_harder():
    barrier, batch, where = case(5)
    vectors = batch.vectors(where)
    vectors[0] = 3.0 * batch.hold.radius[0][:, None]
    vectors[1] = 0.0
    barrier.weight = np.full(4, 0.9 * MOST)
    at = barrier.held.measured([vectors])
    barrier.raise_most(at, EVERYWHERE, 3.0)
    assert barrier.most.tolist() == [3.0 * MOST] * 2 + [MOST] * 2
    barrier.raise_most(at, ~EVERYWHERE, 3.0)
    assert barrier.most.tolist() == [3.0 * MOST] * 2 + [MOST] * 2


def test_multipliers_stay_between_nothing_and_the_greatest():
    barrier, batch, at = case(6)
    work = barrier.add_to(Normal.zero(3, 3, 2), rowed(barrier, batch, at), [batch.jacobians()], MU, np.zeros(3))
    for size in (-1e9, 1e9):
        barrier.renew(work, size * work.u, EVERYWHERE)
        assert np.all((barrier.weight > 0.0) & (barrier.weight < MOST))
    before = barrier.weight.copy()
    barrier.renew(work, np.ones(12), ~EVERYWHERE)
    assert np.array_equal(barrier.weight, before)


@pytest.mark.parametrize("ties", [1.0, 0.25])
def test_damping_ties_vectors_to_where_they_are(ties):
    """Each block by its own, in the metric of the vectors, and as heavily as they are to be tied."""
    barrier, batch, at = case(7, ties=ties)
    damping = np.array([0.0, 3.0, 5.0])
    free, damped = Normal.zero(3, 3, 2), Normal.zero(3, 3, 2)
    barrier.add_to(free, rowed(barrier, batch, at), [batch.jacobians()], MU, np.zeros(3))
    barrier.add_to(damped, rowed(barrier, batch, at), [batch.jacobians()], MU, damping)
    # Two vectors a group, each the difference of two points; a group is damped as its first block is.
    assert damped.coupling - free.coupling == pytest.approx(
        np.array([0.0, -2.0 * 3.0 * ties])[:, None, None] * np.eye(3), abs=1e-9
    )
    assert damped.gradient == pytest.approx(free.gradient)


def test_who_goes_on_with_narrower_distances_pulls_as_hard():
    before, batch, at = case(8)
    before.open(rowed(before, batch, at), 0.0, 0.8, MU)
    batch.hold.radius = 0.4 * batch.hold.radius
    after = Barriers(before.held, most=1.0, ease=1.0)
    after.resume(before)
    assert after.weight / after.tau == pytest.approx(before.weight / before.tau)
    assert np.array_equal(after.most, before.most)
    numbers, batch, at = case(9, one_sided=True)
    after = Barriers(numbers.held, most=1.0, ease=1.0)
    after.resume(numbers)
    assert np.array_equal(after.weight, numbers.weight)


def test_distances_that_may_give_way_begin_wider_and_multipliers_halfway():
    """A multiplier counts |v|^2 / tau^2, and in the cost |v|^2 / 2."""
    _, batch, at = case(10)
    hard = HeldBatch(Hold(np.full((2, 2), 3.0), weight=0.0), batch.offset, batch.blocks, batch.pair)
    held = HeldRows.of_batches([batch, hard], [batch.vectors(at)] * 2, 3, 2)
    barrier = Barriers(held, most=MOST, ease=4.0)
    assert barrier.goal == pytest.approx([*(4.0 * batch.hold.radius).reshape(-1), *[3.0] * 4])
    assert barrier.tau.tolist() == barrier.goal.tolist()
    assert barrier.weight.tolist() == [0.5 * MOST] * 8
    assert barrier.multipliers[1] == pytest.approx(np.full((2, 2), 0.5 * MOST / 9.0))


def test_batches_of_the_same_blocks_add_what_each_adds_by_itself():
    """Two of pairs, and two of single blocks one of which has its vectors in groups of their own."""
    random, first, each = np.random.default_rng(11), np.arange(2), np.arange(3)
    at = random.normal(size=(3, 3))

    def batch(groups: int, vectors: int, *where: np.ndarray, pair: np.ndarray | None = None) -> HeldBatch:
        hold = Hold(random.uniform(0.5, 2.0, (groups, vectors)), weight=0.2)
        return HeldBatch(hold, random.normal(size=(groups, vectors, 3)), where, pair)

    batches = [batch(2, 2, first, first + 1, pair=first), batch(3, 2, each), batch(2, 1, first, first + 1, pair=first)]
    batches.append(batch(6, 1, np.repeat(each, 2)))

    def added(own: list[HeldBatch]) -> list[np.ndarray]:
        vectors = [one.vectors(at) for one in own]
        held, normal, gradient = HeldRows.of_batches(own, vectors, 3, 2), Normal.zero(3, 3, 2), np.zeros((3, 3))
        row = held.measured(vectors)
        work = Barriers(held, most=MOST, ease=1.0).add_to(normal, row, [one.jacobians() for one in own], MU, np.ones(3))
        Barriers(held, most=MOST, ease=1.0).bend(gradient, work, row.rows)
        return [normal.gradient, normal.diagonal, normal.coupling, gradient]

    assert len(HeldRows.of_batches(batches, [one.vectors(at) for one in batches], 3, 2).bundles) == 2
    for together, *alone in zip(added(batches), *(added([one]) for one in batches), strict=True):
        assert together == pytest.approx(sum(alone), rel=1e-12)
