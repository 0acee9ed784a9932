"""The sparse solve is the dense solve, whatever is coupled to what and however the blocks are numbered."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cadpanel.solver.blocks import Normal
from tests.solver.models import grid, pattern, ring, shuffled, strip

# Relative to the largest entry of the step; the matrices' condition is that of a damped model.
SAME_STEP = 1e-10

few = settings(max_examples=10)
COUPLINGS = {
    "nothing coupled": (5, []),
    "one block": (1, []),
    "strip": (7, strip(7)),
    "ring": (6, ring(6)),
    "two blocks": (2, ring(2)[:1]),
    "grid": (12, grid(3, 4)),
    "two strips and a block alone": (7, [(0, 1), (1, 2), (4, 5), (5, 6)]),
    "everything coupled": (4, [(i, j) for i in range(4) for j in range(i + 1, 4)]),
}
every_coupling = pytest.mark.parametrize("what", COUPLINGS)


def random_model(count, size, pairs, seed):
    """A positive semidefinite model made of residuals that see one block, or two coupled ones."""
    random = np.random.default_rng(seed)
    normal = Normal.zero(count, size, len(pairs))
    for i in range(count):
        rows = random.normal(size=(2, size))
        normal.diagonal[i] += rows.T @ rows
    for k, (i, j) in enumerate(pairs):
        left, right = random.normal(size=(2, 3, size))
        normal.diagonal[i] += left.T @ left
        normal.diagonal[j] += right.T @ right
        normal.coupling[k] += left.T @ right
    normal.gradient += random.normal(size=(count, size))
    return normal


def dense_step(normal, pairs, damping):
    count, size = normal.gradient.shape
    full = np.zeros((count, size, count, size))
    for i in range(count):
        full[i, :, i] = normal.diagonal[i] + np.diag(damping[i])
    for (i, j), block in zip(pairs, normal.coupling, strict=True):
        full[i, :, j], full[j, :, i] = block, block.T
    return np.linalg.solve(full.reshape(count * size, -1), -normal.gradient.reshape(-1)).reshape(count, size)


@every_coupling
@few
@given(seed=st.integers(0, 2**32 - 1), size=st.integers(1, 6), mixed=st.booleans())
def test_the_step_is_that_of_a_dense_solve(what, seed, size, mixed):
    count, pairs = COUPLINGS[what]
    if mixed:
        pairs = shuffled(pairs, count, seed)
    normal = random_model(count, size, pairs, seed)
    damping = np.random.default_rng(seed + 1).uniform(0.1, 1.0, (count, size))
    step = pattern(count, size, pairs).solve(normal, damping)
    expected = dense_step(normal, pairs, damping)
    assert step is not None
    assert np.abs(step - expected).max() <= SAME_STEP * np.abs(expected).max()


@every_coupling
def test_solving_leaves_the_model_as_it_was(what):
    count, pairs = COUPLINGS[what]
    normal = random_model(count, 3, pairs, 1)
    before = [part.copy() for part in (normal.gradient, normal.diagonal, normal.coupling)]
    pattern(count, 3, pairs).solve(normal, np.ones((count, 3)))
    for one, other in zip(before, (normal.gradient, normal.diagonal, normal.coupling), strict=True):
        assert np.array_equal(one, other)


@every_coupling
def test_a_model_that_is_not_positive_definite_has_no_step(what):
    count, pairs = COUPLINGS[what]
    normal = random_model(count, 3, pairs, 1)
    blocks = pattern(count, 3, pairs)
    assert blocks.solve(normal, np.full((count, 3), 1.0)) is not None
    damping = np.full((count, 3), 1.0)
    damping[-1, 0] = -2.0 * normal.diagonal[-1, 0, 0] - 1.0
    assert blocks.solve(normal, damping) is None


def test_components_are_told_apart():
    count, pairs = COUPLINGS["two strips and a block alone"]
    blocks = pattern(count, 2, pairs)
    assert blocks.components == 3
    labels = blocks.component
    assert len(set(labels[:3])) == len(set(labels[4:])) == 1
    assert len({labels[0], labels[3], labels[4]}) == 3


def test_the_band_of_a_shuffled_strip_is_no_wider_than_that_of_the_strip():
    straight, mixed = pattern(50, 4, strip(50)), pattern(50, 4, shuffled(strip(50), 50, 3))
    assert mixed._width == straight._width


@pytest.mark.parametrize("pairs", [[(1, 0)], [(0, 0)], [(0, 1), (0, 1)]])
def test_pairs_that_stand_twice_or_the_wrong_way_round_are_refused(pairs):
    with pytest.raises(ValueError, match="unique, the lower index first"):
        pattern(2, 1, pairs)
