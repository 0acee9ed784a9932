"""Lengths, products and directions are those of NumPy and of Euclid, one pair at a time and many."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cadpanel.geometry.vectors import beside, cross, dot, norm, side_of, unit

seeds = st.integers(0, 2**32 - 1)
shapes = st.sampled_from([(), (1,), (5,), (2, 3)])


def drawn(seed, shape, count, size=3):
    return np.random.default_rng(seed).normal(size=(count, *shape, size))


@given(seeds, shapes)
def test_products_and_lengths_are_those_of_the_library_for_one_pair_and_for_many(seed, shape):
    first, second = drawn(seed, shape, 2)
    assert cross(first, second) == pytest.approx(np.cross(first, second), abs=1e-12)
    assert dot(first, second) == pytest.approx(np.sum(first * second, axis=-1), abs=1e-12)
    assert norm(first) == pytest.approx(np.linalg.norm(first, axis=-1), rel=1e-12)


@pytest.mark.parametrize("shape", [(2,), (2, 3), (2, 6, 4)])
@pytest.mark.parametrize("count", [1, 3])
def test_arrays_beside_each_other_are_those_of_the_library(shape, count):
    parts = list(np.random.default_rng(7).normal(size=(count, *shape)))
    assert np.array_equal(beside(parts), np.stack(parts, axis=1))


@given(seeds)
def test_one_vector_is_crossed_with_many(seed):
    many = drawn(seed, (4,), 1)[0]
    assert cross(many[0], many) == pytest.approx(np.cross(many[0], many), abs=1e-12)


@given(seeds, shapes, st.sampled_from([1e-12, 1.0, 1e9]))
def test_directions_keep_their_way_and_have_length_one(seed, shape, size):
    vectors = size * drawn(seed, shape, 1)[0]
    assert norm(unit(vectors)) == pytest.approx(1.0, rel=1e-12)
    assert norm(vectors)[..., None] * unit(vectors) == pytest.approx(vectors, rel=1e-12, abs=1e-12 * size)


def test_what_has_no_length_has_no_direction():
    assert np.array_equal(unit(np.array([[0.0, 0.0, 0.0], [0.0, 3.0, 4.0]])), [[0.0, 0.0, 0.0], [0.0, 0.6, 0.8]])


@given(seeds, shapes)
def test_the_left_of_a_way_is_where_turning_it_by_a_right_angle_leads(seed, shape):
    """The number is the area that the way and the way to the point span, and none in line with it."""
    starts, ways, along = drawn(seed, shape, 3, size=2)
    left = np.stack([-ways[..., 1], ways[..., 0]], axis=-1)
    share, off = along[..., 0], along[..., 1]
    points = starts + share[..., None] * ways + off[..., None] * left
    wanted = off * np.sum(ways**2, axis=-1)
    assert side_of(starts, starts + ways, points) == pytest.approx(wanted, rel=1e-9, abs=1e-9)
