"""The order of elimination: every block once, and halves that do not meet."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.sparse import csr_array

from cadpanel.solver.dissection import dissect, parted
from tests.solver.models import grid, ring, strip


def graph_of(count: int, pairs: list[tuple[int, int]]) -> csr_array:
    ends = np.array(pairs, dtype=np.intp).reshape(-1, 2)
    half = csr_array((np.ones(len(ends)), (ends[:, 0], ends[:, 1])), shape=(count, count))
    return (half + half.T).tocsr()


GRAPHS = {
    "grid": (16 * 11, grid(16, 11)),
    "strip": (200, strip(200)),
    "ring": (150, ring(150)),
    "nothing coupled": (60, []),
    "two strips": (120, [(k, k + 1) for k in range(119) if k != 50]),
    "star": (90, [(0, k) for k in range(1, 90)]),
    "everything coupled": (40, [(i, j) for i in range(40) for j in range(i + 1, 40)]),
    "few": (3, strip(3)),
}
every_graph = pytest.mark.parametrize("what", GRAPHS)


@every_graph
def test_every_block_is_eliminated_once(what):
    count, pairs = GRAPHS[what]
    parts = dissect(graph_of(count, pairs))
    assert sorted(np.concatenate([part.own for part in parts]).tolist()) == list(range(count))


@every_graph
def test_what_is_beyond_a_part_is_all_that_elimination_couples_it_with(what):
    """Eliminated one block after another, with all that this couples (a small case of the textbooks' game)."""
    count, pairs = GRAPHS[what]
    parts = dissect(graph_of(count, pairs))
    coupled: list[set[int]] = [set() for _ in range(count)]
    for i, j in pairs:
        coupled[i].add(j)
        coupled[j].add(i)
    for part in parts:
        met: set[int] = set()
        for block in part.own.tolist():
            later = coupled[block]
            for one in later:
                coupled[one].discard(block)
                coupled[one] |= later - {one}
            met |= later
        assert met - set(part.own.tolist()) == set(part.beyond.tolist())


@every_graph
def test_what_a_part_leaves_goes_to_one_that_comes_later_and_has_room_for_it(what):
    parts = dissect(graph_of(*GRAPHS[what]))
    adopted = [child for part in parts for child in part.children]
    assert sorted(adopted) == [number for number, part in enumerate(parts) if len(part.beyond)]
    for number, part in enumerate(parts):
        for child in part.children:
            assert child < number
            assert set(parts[child].beyond) <= {*part.own, *part.beyond}


@settings(max_examples=4)
@given(seed=st.integers(0, 2**32 - 1))
def test_a_square_grid_is_parted_by_few_blocks(seed):
    """Also if its blocks are numbered at random."""
    side = 30
    order = np.random.default_rng(seed).permutation(side * side)
    parts = dissect(graph_of(side * side, [(int(order[i]), int(order[j])) for i, j in grid(side, side)]))
    assert max(len(part.own) + len(part.beyond) for part in parts) <= 2 * side


def ladder(rungs: int, waist: int | None = None) -> list[tuple[int, int]]:
    """Rungs of two blocks each, one after the other; at the waist a single block, numbered last."""
    pairs = [(2 * k, 2 * k + 1) for k in range(rungs)]
    pairs += [(2 * k + side, 2 * k + 2 + side) for k in range(rungs - 1) if k + 1 != waist for side in (0, 1)]
    if waist is not None:
        pairs += [(2 * waist + side, 2 * rungs) for side in (-2, -1, 0, 1)]
    return pairs


@pytest.mark.parametrize("rungs", [20, 31, 60])
def test_a_long_grid_is_parted_in_its_middle(rungs):
    first, between, second = parted(graph_of(2 * rungs, ladder(rungs)))
    assert len(between) <= 2
    assert abs(len(first) - len(second)) <= 3
    assert sorted([*first, *between, *second]) == list(range(2 * rungs))


@pytest.mark.parametrize("waist", range(5, 26))
def test_a_waist_parts_only_if_it_leaves_a_third_on_both_sides(waist):
    first, between, second = parted(graph_of(61, ladder(30, waist)))
    halves = sorted([2 * waist, 60 - 2 * waist])
    if 3 * halves[0] >= 61:
        assert between.tolist() == [60]
        assert sorted([len(first), len(second)]) == halves
    else:
        assert len(between) == 2
        assert 3 * min(len(first), len(second)) >= 61


def test_what_is_not_coupled_is_parted_by_nothing():
    pairs = [(k, k + 1) for k in range(119) if k != 50]
    first, between, second = parted(graph_of(120, pairs))
    assert len(between) == 0
    assert sorted([len(first), len(second)]) == [51, 69]
