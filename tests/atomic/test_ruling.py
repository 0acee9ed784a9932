"""Laws of the two bending numbers: distance as by radius and half angle, exact derivatives, no singular point."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cadpanel.atomic.ruling import (
    CONE,
    CYLINDER,
    PLANE,
    Rulings,
    anchored,
    distance_rows,
    distances,
    moved,
    normals,
    passed_apex,
    passed_apex_rows,
)
from cadpanel.geometry.cone import cone_distance
from tests.atomic.known_samples import rotation

STEP = 1e-6
SMALL = [0.0, 1e-12, -1e-12, 1e-6, -1e-6, 1e-2, -1e-2]

many = settings(max_examples=40, derandomize=True)
seeds = st.integers(0, 2**32 - 1)
curvatures = st.sampled_from(SMALL) | st.floats(-1.5, 1.5)
tapers = st.sampled_from(SMALL) | st.floats(-0.4, 0.4)


def some(seed, curvature, taper, count=3):
    """Rulings and samples (count, 8, 3) about them."""
    random = np.random.default_rng(seed)
    rulings = Rulings(
        points=random.normal(size=(count, 3)),
        frames=np.stack([rotation(random) for _ in range(count)]),
        curvature=np.full(count, curvature),
        taper=np.full(count, taper),
    )
    q = random.uniform(-1.0, 1.0, (count, 8, 3))
    return rulings, rulings.points[:, None] + q @ np.swapaxes(rulings.frames, 1, 2)


@many
@given(seeds, st.floats(0.3, 3.0), st.sampled_from([1.0, -1.0]), st.floats(-1.2, 1.2))
def test_the_distance_is_that_by_radius_and_half_angle(seed, size, sign, half_angle):
    radius = sign * size
    rulings, x = some(seed, 1.0 / radius, math.tan(half_angle) / radius)
    q = rulings.local(x)
    t, n = rulings.frames[:, :, 1], rulings.frames[:, :, 2]
    expected = cone_distance(np.moveaxis(x, -1, 0), rulings.points, t, n, np.full(3, radius), np.full(3, half_angle))
    assert distances(rulings, q) == pytest.approx(expected, abs=1e-12)


@many
@given(seeds, st.floats(3.0, 12.0))
def test_a_very_large_radius_loses_no_digits(seed, exponent):
    rulings, x = some(seed, 10.0**-exponent, 0.0)
    u, v, w = rulings.local(x)
    # The next term of the series is smaller by the curvature.
    assert distances(rulings, np.stack([u, v, w])) - w == pytest.approx(
        0.5 * u * u * 10.0**-exponent, rel=3.0 * 10.0**-exponent + 1e-3, abs=1e-15
    )


@many
@given(seeds, tapers)
def test_curvature_zero_is_the_plane_whatever_the_taper(seed, taper):
    rulings, x = some(seed, 0.0, taper)
    q = rulings.local(x)
    assert np.array_equal(distances(rulings, q), q[2])


@many
@given(seeds, curvatures, tapers)
def test_derivatives_agree_with_finite_differences(seed, curvature, taper):
    rulings, x = some(seed, curvature, taper)
    distance, rows = distance_rows(rulings, rulings.local(x), CONE)
    assert np.array_equal(distance, distances(rulings, rulings.local(x)))
    # Near the axis the distance has an edge, and differences near it tell nothing.
    reach = 1.0 + curvature * rulings.local(x)[2] + taper * rulings.local(x)[1]
    clear = np.hypot(reach, np.hypot(curvature, taper) * rulings.local(x)[0]) > 0.05
    for i in range(len(CONE)):
        step = np.zeros((3, 6))
        step[:, i] = STEP
        ahead, behind = moved(rulings, step, CONE), moved(rulings, -step, CONE)
        change = (distances(ahead, ahead.local(x)) - distances(behind, behind.local(x))) / (2.0 * STEP)
        assert rows[:, i][clear] == pytest.approx(change[clear], abs=2e-7)
    for unknowns in (PLANE, CYLINDER):
        assert np.array_equal(distance_rows(rulings, rulings.local(x), unknowns)[1], rows[:, list(unknowns)])


@many
@given(seeds, curvatures, st.floats(0.8, 2.0), st.sampled_from([1.0, -1.0]))
def test_derivatives_beyond_the_apex_agree_with_finite_differences(seed, curvature, size, sign):
    rulings, x = some(seed, curvature, sign * size)
    q = rulings.local(x)
    passed, rows = passed_apex_rows(rulings, q)
    reach = 1.0 + curvature * q[2] + sign * size * q[1]
    clear = (passed > 1e-3) & (np.hypot(reach, np.hypot(curvature, size) * q[0]) > 0.1)
    for i in range(len(CONE)):
        step = np.zeros((3, 6))
        step[:, i] = STEP
        ahead, behind = moved(rulings, step, CONE), moved(rulings, -step, CONE)
        change = (passed_apex(ahead, ahead.local(x)) - passed_apex(behind, behind.local(x))) / (2.0 * STEP)
        assert rows[:, i][clear] == pytest.approx(change[clear], abs=1e-6)
    assert np.all(rows[np.broadcast_to((passed == 0.0)[:, None], rows.shape)] == 0.0)


@many
@given(seeds, st.floats(0.2, 1.2), st.floats(0.5, 1.5))
def test_beyond_the_apex_the_apex_is_as_far_as_distance_and_way_say(seed, half_angle, taper):
    rulings, x = some(seed, taper / math.tan(half_angle), taper)
    q = rulings.local(x)
    passed = passed_apex(rulings, q)
    apex = rulings.points - rulings.frames[:, :, 1] / taper
    to_apex = np.linalg.norm(x - apex[:, None], axis=-1)
    beyond = passed > 0.0
    assert np.hypot(distances(rulings, q), passed)[beyond] == pytest.approx(to_apex[beyond], abs=1e-12)


@many
@given(seeds, curvatures, tapers)
def test_the_normal_is_the_gradient(seed, curvature, taper):
    rulings, x = some(seed, curvature, taper)
    q = rulings.local(x)
    normal = normals(rulings, q)
    assert np.sum(normal**2, axis=0) == pytest.approx(1.0, abs=1e-12)
    _, rows = distance_rows(rulings, q, (3,))
    assert -rows[:, 0] == pytest.approx(normal[2], abs=1e-12)


@many
@given(seeds, curvatures, tapers)
def test_anchoring_tells_the_same_surface_by_the_ruling_under_the_centre(seed, curvature, taper):
    rulings, x = some(seed, curvature, taper)
    centres = x[:, 0]
    q = rulings.local(centres[:, None])
    again = anchored(rulings, centres)
    # Beyond the apex there is no ruling to slide to.
    reached = 1.0 + taper * q[1] > 0.05
    there = again.local(centres[:, None])
    off_axis = np.hypot(1.0 + curvature * q[2] + taper * q[1], np.hypot(curvature, taper) * q[0]) > 0.05
    assert there[0][reached & off_axis] == pytest.approx(0.0, abs=1e-9)
    clear = (reached & off_axis)[:, 0]
    before, after = distances(rulings, rulings.local(x)), distances(again, again.local(x))
    assert after[clear] == pytest.approx(before[clear], abs=1e-9)
    assert np.swapaxes(again.frames, 1, 2) @ again.frames == pytest.approx(
        np.broadcast_to(np.eye(3), (3, 3, 3)), abs=1e-12
    )
