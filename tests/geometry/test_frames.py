"""Laws of rotations, twists and the frames that they carry."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cadpanel.geometry.frames import cayley, cayley_rates, point_velocity, rotate_about, rotation_twist
from cadpanel.geometry.vectors import cross, dot

ROUNDING = 1e-13
STEP = 1e-6
# Central differences of a smooth function of size 1 with the step above.
DIFFERENCES = 1e-8

seeds = st.integers(0, 2**32 - 1)


def vectors(seed, *shape):
    return np.random.default_rng(seed).normal(size=(*shape, 3))


def units(seed, *shape):
    v = vectors(seed, *shape)
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def is_rotation(matrices, tolerance):
    identity = np.swapaxes(matrices, -1, -2) @ matrices
    return bool(np.all(np.abs(identity - np.eye(3)) <= tolerance) and np.all(np.linalg.det(matrices) > 0.0))


@given(seeds)
def test_products_are_those_of_numpy(seed):
    a, b = vectors(seed, 4, 5), vectors(seed + 1, 4, 5)
    assert np.array_equal(cross(a, b), np.cross(a, b))
    assert dot(a, b) == pytest.approx(np.sum(a * b, axis=-1), abs=ROUNDING)


@given(seeds, st.floats(1e-9, 1e3))
def test_cayley_is_a_rotation_however_large_the_vector(seed, size):
    assert is_rotation(cayley(size * units(seed, 8)), 10 * ROUNDING)


def test_a_matrix_that_is_off_by_a_little_is_no_rotation():
    assert not is_rotation(cayley(np.ones(3)) + 1e-10, 10 * ROUNDING)
    assert not is_rotation(-np.eye(3), ROUNDING)


@given(seeds, st.floats(-3.0, 3.0))
def test_cayley_turns_about_its_vector_by_twice_the_arctangent_of_half_its_length(seed, angle):
    axis, v = units(seed, 6), vectors(seed + 1, 6)
    turned = (cayley(2.0 * np.tan(0.5 * angle) * axis) @ v[..., None])[..., 0]
    assert turned == pytest.approx(rotate_about(axis, np.full(6, angle), v), abs=1e-11)


def test_no_turn_is_exactly_the_identity():
    assert np.array_equal(cayley(np.zeros((2, 3))), np.broadcast_to(np.eye(3), (2, 3, 3)))


@given(seeds)
def test_cayley_rates_agree_with_finite_differences(seed):
    w = 0.8 * vectors(seed, 5)
    rates, rotation = cayley_rates(w), cayley(w)
    for j in range(3):
        step = STEP * np.eye(3)[j]
        change = (cayley(w + step) - cayley(w - step)) / (2.0 * STEP)
        skew = change @ np.swapaxes(rotation, -1, -2)
        omega = np.stack([skew[:, 2, 1], skew[:, 0, 2], skew[:, 1, 0]], axis=-1)
        assert omega == pytest.approx(rates[..., j], abs=DIFFERENCES)


@given(seeds, st.floats(-6.0, 6.0), st.floats(-6.0, 6.0))
def test_turning_twice_about_one_axis_adds_the_angles(seed, one, other):
    axis, v = units(seed, 4), vectors(seed + 1, 4)
    twice = rotate_about(axis, np.full(4, other), rotate_about(axis, np.full(4, one), v))
    assert twice == pytest.approx(rotate_about(axis, np.full(4, one + other), v), abs=1e-12)
    assert dot(axis, twice) == pytest.approx(dot(axis, v), abs=1e-12)


@given(seeds)
def test_a_rotation_twist_gives_the_velocity_of_turning_about_its_line(seed):
    axis, centre, x = units(seed, 4), vectors(seed + 1, 4), vectors(seed + 2, 4)
    angle = np.full(4, STEP)
    moved = (rotate_about(axis, angle, x - centre) - rotate_about(axis, -angle, x - centre)) / (2.0 * STEP)
    velocity = point_velocity(rotation_twist(axis, centre)[..., None], x)[..., 0]
    assert velocity == pytest.approx(moved, abs=DIFFERENCES)


@given(seeds, st.floats(-100.0, 100.0))
def test_a_rotation_twist_knows_only_the_line_and_not_the_point_on_it(seed, along):
    axis, centre = units(seed, 4), vectors(seed + 1, 4)
    assert rotation_twist(axis, centre + along * axis) == pytest.approx(rotation_twist(axis, centre), abs=1e-12)


@given(seeds)
def test_points_on_the_axis_rest_and_others_do_not(seed):
    axis, centre = units(seed, 4), vectors(seed + 1, 4)
    twist = rotation_twist(axis, centre)[..., None]
    aside = units(seed + 2, 4)
    off = np.linalg.norm(cross(aside, axis), axis=-1)
    assert point_velocity(twist, centre - 2.0 * axis)[..., 0] == pytest.approx(0.0, abs=1e-13)
    speed = np.linalg.norm(point_velocity(twist, centre + aside)[..., 0], axis=-1)
    assert speed == pytest.approx(off, abs=1e-12)


@given(seeds)
def test_twists_add(seed):
    twists = np.random.default_rng(seed).normal(size=(4, 6, 2))
    x = vectors(seed + 1, 4)
    both = point_velocity(twists.sum(axis=2, keepdims=True), x)
    assert both[..., 0] == pytest.approx(point_velocity(twists, x).sum(axis=-1), abs=1e-13)


def test_a_turn_goes_from_the_first_axis_to_the_second_about_the_third():
    quarter = np.array([0.0, 0.0, 2.0])
    assert cayley(quarter) == pytest.approx(np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]))


@pytest.mark.parametrize("shape", [(), (4,), (4, 5)])
def test_points_of_any_arrangement_have_the_velocity_of_their_twists(shape):
    twists, x = np.random.default_rng(1).normal(size=(*shape, 6, 2)), vectors(2, *shape)
    turning, moving = np.moveaxis(twists[..., :3, :], -1, 0), np.moveaxis(twists[..., 3:, :], -1, 0)
    expected = np.moveaxis(moving + np.cross(turning, x), 0, -1)
    assert point_velocity(twists, x) == pytest.approx(expected, abs=ROUNDING)
