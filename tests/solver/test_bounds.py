"""Steps within bounds."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import lsq_linear

from cadpanel.solver.blocks import Normal
from cadpanel.solver.bounds import Bounds, bounded_step
from tests.solver.models import pattern, strip

few = settings(max_examples=15)
seeds = st.integers(0, 2**32 - 1)


def random_model(seed: int, count: int = 4, size: int = 3):
    """A strip's normal equations, and the dense matrix that they are."""
    random = np.random.default_rng(seed)
    root = np.zeros((count * size + 5, count * size))
    for k in range(count - 1):
        root[3 * k : 3 * k + 5, k * size : (k + 2) * size] += random.normal(size=(5, 2 * size))
    root[: count * size] += 0.5 * np.eye(count * size)
    dense = root.T @ root
    dense = dense * np.kron(np.abs(np.subtract.outer(range(count), range(count))) <= 1, np.ones((size, size)))
    dense += count * size * np.eye(count * size)
    blocks = dense.reshape(count, size, count, size)
    normal = Normal(
        random.normal(size=(count, size)),
        np.array([blocks[k, :, k] for k in range(count)]),
        np.array([blocks[k, :, k + 1] for k in range(count - 1)]),
    )
    return normal, dense, pattern(count, size, strip(count))


@few
@given(seed=seeds)
def test_without_bounds_in_the_way_the_step_solves_the_system_and_keeps_its_promise(seed):
    normal, dense, coupled = random_model(seed)
    at = np.zeros((4, 3))
    for bounds in (None, Bounds(at - 1e9, at + 1e9)):
        found = bounded_step(coupled, normal, np.zeros_like(at), at, bounds)
        assert found is not None
        step, gradient = found.step.reshape(-1), normal.gradient.reshape(-1)
        assert dense @ step == pytest.approx(-gradient, abs=1e-9)
        assert found.promised.sum() == pytest.approx(-step @ gradient - 0.5 * step @ dense @ step)
        assert not found.cut.any()


@few
@given(seed=seeds)
def test_a_step_never_leaves_the_bounds_and_promises_what_the_model_gives(seed):
    normal, dense, coupled = random_model(seed)
    random = np.random.default_rng(seed)
    at = np.zeros((4, 3))
    bounds = Bounds(-random.uniform(0.0, 0.1, at.shape) * random.integers(0, 2, at.shape), at + 0.05)
    found = bounded_step(coupled, normal, np.zeros_like(at), at, bounds)
    assert found is not None
    assert bounds.hold(at + found.step)
    step = found.step.reshape(-1)
    assert found.promised.sum() == pytest.approx(-step @ normal.gradient.reshape(-1) - 0.5 * step @ dense @ step)


@few
@given(seed=seeds)
def test_what_stands_on_a_bound_and_is_pushed_beyond_stays_there(seed):
    normal, dense, coupled = random_model(seed)
    at = np.zeros((4, 3))
    bounds = Bounds(at.copy(), at + np.inf)
    found = bounded_step(coupled, normal, np.zeros_like(at), at, bounds)
    assert found is not None
    assert np.all(found.blocked[normal.gradient > 0.0])
    assert np.all(found.step[found.blocked] == 0.0)
    # Of the step that the others take together none is cut, however many are held for it.
    assert not found.cut.any()
    # No better than the best step within the bounds, and no worse than none.
    root = np.linalg.cholesky(dense).T
    best = lsq_linear(root, -np.linalg.solve(root.T, normal.gradient.reshape(-1)), (0.0, np.inf)).x
    value = -best @ normal.gradient.reshape(-1) - 0.5 * best @ dense @ best
    assert found.promised.sum() <= value + 1e-9


def test_an_unknown_between_bounds_that_are_alike_is_fixed():
    bounds = Bounds(np.zeros((1, 2)), np.array([[0.0, 1.0]]))
    assert np.array_equal(bounds.blocked(np.zeros((1, 2)), np.array([[0.0, -1.0]])), [[True, False]])


def test_a_matrix_that_is_not_positive_definite_gives_no_step():
    normal, _, coupled = random_model(3)
    normal.diagonal[1] *= -1.0
    assert bounded_step(coupled, normal, np.zeros((4, 3)), np.zeros((4, 3)), None) is None


def test_only_steps_that_lead_beyond_a_bound_are_beyond_it_however_short():
    bounds = Bounds(np.zeros((1, 3)), np.ones((1, 3)))
    for at, way in ((0.0, -1.0), (1.0, 1.0)):
        unknowns = np.array([[at, at, 0.5]])
        for step, beyond in ((way * 1e-9, True), (0.0, False), (-way * 1e-9, False), (-way * 0.2, False)):
            assert bounds.beyond(unknowns, np.full((1, 3), step)).tolist() == [[beyond, beyond, False]]
        assert bounds.blocked(unknowns, np.full((1, 3), -way * 1e-9)).tolist() == [[True, True, False]]
        assert not bounds.blocked(unknowns, np.full((1, 3), way * 1e-9)).any()


def test_a_step_is_cut_at_the_bound_that_it_leads_to_and_not_at_the_opposite_one():
    """Each block by itself: one is cut, one is not, one stands on a bound and stays."""
    normal = Normal(np.array([[-3.0], [-0.5], [1.0]]), np.ones((3, 1, 1)), np.zeros((0, 1, 1)))
    alone, at = pattern(3, 1, []), np.zeros((3, 1))
    for lower in (-9.0, np.array([[-9.0], [-9.0], [0.0]])):
        found = bounded_step(alone, normal, at, at, Bounds(np.broadcast_to(lower, (3, 1)), at + 1.0))
        assert found is not None
        assert found.step.tolist() == [[1.0], [0.5], [-1.0 if np.ndim(lower) == 0 else 0.0]]
        assert found.cut.tolist() == [1.0, 0.0, 0.0]
