"""The factorization by parts is that of the whole matrix."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.sparse import csr_array

from cadpanel.solver.blocks import Normal
from cadpanel.solver.dissection import dissect
from cadpanel.solver.multifrontal import Fronts
from tests.solver.models import grid, pattern, ring, strip

GRAPHS = {
    "grid": (9 * 8, grid(9, 8)),
    "strip": (90, strip(90)),
    "ring": (70, ring(70)),
    "nothing coupled": (50, []),
    "everything coupled": (30, [(i, j) for i in range(30) for j in range(i + 1, 30)]),
}


def case(what: str, size: int, seed: int) -> tuple[Normal, np.ndarray, Fronts]:
    """Blocks, the dense matrix that they are, and the fronts."""
    count, pairs = GRAPHS[what]
    random = np.random.default_rng(seed)
    ends = np.array(pairs, dtype=np.intp).reshape(-1, 2)
    normal = Normal.zero(count, size, len(ends))
    normal.coupling += random.normal(size=normal.coupling.shape)
    degree = np.bincount(ends.reshape(-1), minlength=count)
    root = random.normal(size=normal.diagonal.shape)
    normal.diagonal += root @ np.swapaxes(root, 1, 2) + (3.0 * size * (1 + degree))[:, None, None] * np.eye(size)
    dense = np.zeros((count, size, count, size))
    for k in range(count):
        dense[k, :, k] = normal.diagonal[k]
    for (i, j), block in zip(pairs, normal.coupling, strict=True):
        dense[i, :, j], dense[j, :, i] = block, block.T
    half = csr_array((np.ones(len(ends)), (ends[:, 0], ends[:, 1])), shape=(count, count))
    fronts = Fronts.of(dissect((half + half.T).tocsr()), size, ends, count)
    return normal, dense.reshape(count * size, count * size), fronts


@pytest.mark.parametrize("what", GRAPHS)
@settings(max_examples=5)
@given(seed=st.integers(0, 2**32 - 1), size=st.integers(1, 4))
def test_it_solves_what_a_dense_factorization_solves(what, seed, size):
    normal, dense, fronts = case(what, size, seed)
    factors = fronts.factorize(normal.diagonal, normal.coupling)
    assert factors is not None
    right = np.random.default_rng(seed).normal(size=(len(normal.diagonal), size))
    expected = np.linalg.solve(dense, right.reshape(-1)).reshape(right.shape)
    assert factors.solve(right) == pytest.approx(expected, abs=1e-11)


@pytest.mark.parametrize("block", [0, 35, 71])
def test_a_matrix_that_is_not_positive_definite_has_no_factors(block):
    normal, _, fronts = case("grid", 3, 1)
    normal.diagonal[block] *= -1.0
    assert fronts.factorize(normal.diagonal, normal.coupling) is None


def test_a_wide_grid_is_solved_alike_by_band_and_by_parts(monkeypatch):
    side = 12
    pairs = grid(side, side)
    random = np.random.default_rng(2)
    normal = Normal.zero(side * side, 2, len(pairs))
    normal.gradient += random.normal(size=normal.gradient.shape)
    normal.coupling += random.normal(size=normal.coupling.shape)
    normal.diagonal += 30.0 * np.eye(2)
    damping = random.uniform(0.0, 1.0, normal.gradient.shape)
    band = pattern(side * side, 2, pairs).solve(normal, damping)
    monkeypatch.setattr("cadpanel.solver.blocks._WIDE", side - 2)
    wide = pattern(side * side, 2, pairs).solve(normal, damping)
    assert wide is not None
    assert band is not None
    assert not np.array_equal(wide, band)  # another way
    assert wide == pytest.approx(band, abs=1e-13)
