"""Laws of the distance to a cone: it is Euclidean, it is smooth through the cylinder, its derivatives are exact."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cadpanel.geometry.cone import INNER, Skins, beyond, cone_distance, plane_distance, skin_rows
from cadpanel.geometry.frames import point_velocity, rotate_about
from cadpanel.geometry.vectors import cross, dot

ROUNDING = 1e-12
STEP = 1e-6
DIFFERENCES = 1e-8
# Half angles through 0, as a fit passes them.
SMALL = [0.0] + [sign * 10.0**-k for k in range(12, 1, -2) for sign in (1.0, -1.0)]

many = settings(max_examples=40)
seeds = st.integers(0, 2**32 - 1)
radii = st.floats(0.1, 2.0).flatmap(lambda r: st.sampled_from([r, -r]))
half_angles = st.sampled_from(SMALL) | st.floats(-0.5, 0.5)


def ruling(seed, count):
    """Frames p, b, t, n (count, 3) anywhere."""
    random = np.random.default_rng(seed)
    axes, _ = np.linalg.qr(random.normal(size=(count, 3, 3)))
    t, n = axes[..., 0], axes[..., 1]
    return random.normal(size=(count, 3)), cross(t, n), t, n


def surface(p, t, n, radius, half_angle, angle, along):
    """Points of the cone, and its normals: a generatrix turned about the axis."""
    axis = math.cos(half_angle) * t - math.sin(half_angle) * n
    centre = p - radius * n
    points = centre + rotate_about(axis, angle, p + along[..., None] * t - centre)
    return points, rotate_about(axis, angle, n)


def place(seed, radius, half_angle, count=6):
    """Feet on the part of the cone that has not passed its apex, their normals, and the cone's arguments."""
    p, _, t, n = ruling(seed, count)
    random = np.random.default_rng(seed + 1)
    reach = abs(radius / math.tan(half_angle)) if abs(half_angle) > 1e-3 else 2.0
    along = random.uniform(-0.6, 0.6, count) * min(reach, 2.0)
    feet, normals = surface(p, t, n, radius, half_angle, random.uniform(-3.0, 3.0, count), along)
    # How far the surface's other sheet is: the distance along the normal to the axis.
    room = np.abs(radius + along * math.tan(half_angle))
    return feet, normals, room, (p, t, n, np.full(count, radius), np.full(count, half_angle))


def columns(points):
    """Points (count, 3) as one sample of each of `count` panels."""
    return points.T[:, :, None]


@many
@given(seeds, radii, half_angles)
def test_points_of_the_cone_have_no_distance(seed, radius, half_angle):
    feet, _, _, cone = place(seed, radius, half_angle)
    assert cone_distance(columns(feet), *cone) == pytest.approx(0.0, abs=ROUNDING)


@many
@given(seeds, radii, half_angles, st.floats(-0.9, 3.0))
def test_distance_is_the_length_of_the_normal_to_the_surface(seed, radius, half_angle, share):
    feet, normals, room, cone = place(seed, radius, half_angle)
    # Towards the axis only up to the axis; away from it as far as one likes.
    height = share * room * np.sign(radius)
    distance = cone_distance(columns(feet + height[:, None] * normals), *cone)
    assert distance[:, 0] == pytest.approx(height, abs=1e-11)


@many
@given(seeds, radii, half_angles)
def test_no_point_of_the_surface_is_nearer_than_the_distance_says(seed, radius, half_angle):
    feet, normals, room, cone = place(seed, radius, half_angle)
    p, t, n = (values[0] for values in cone[:3])
    x = feet[0] + 0.5 * room[0] * normals[0]
    angle, along = np.meshgrid(np.linspace(-math.pi, math.pi, 181), np.linspace(-3.0, 3.0, 121))
    points, _ = surface(p, t, n, radius, half_angle, angle.ravel(), along.ravel())
    nearest = np.linalg.norm(points - x, axis=-1).min()
    distance = abs(float(cone_distance(columns(x[None]), *(values[:1] for values in cone))[0, 0]))
    # The grid's spacing bounds how far its nearest point may be from the foot.
    assert distance - 1e-12 <= nearest <= distance + 0.15 * (1.0 + abs(radius))


@many
@given(seeds, radii, half_angles)
def test_the_normal_is_the_gradient_and_has_unit_length(seed, radius, half_angle):
    feet, normals, room, cone = place(seed, radius, half_angle)
    x = columns(feet + (0.3 * room * np.sign(radius))[:, None] * normals)
    computed = Skins.of_panels(*cone).normals(x)
    assert computed == pytest.approx(columns(normals), abs=1e-10)
    _, inner = Skins.of_panels(*cone).distance_inner(x)
    assert -inner[3:6] == pytest.approx(columns(normals), abs=1e-10)


@many
@given(seeds, radii, half_angles)
def test_derivatives_by_radius_and_half_angle_agree_with_finite_differences(seed, radius, half_angle):
    feet, normals, room, (p, t, n, r, g) = place(seed, radius, half_angle)
    x = columns(feet + (0.3 * room * np.sign(radius))[:, None] * normals)
    distance, inner = Skins.of_panels(p, t, n, r, g).distance_inner(x)
    assert np.array_equal(distance, cone_distance(x, p, t, n, r, g))
    assert len(inner) == INNER
    by_radius = (cone_distance(x, p, t, n, r + STEP, g) - cone_distance(x, p, t, n, r - STEP, g)) / (2.0 * STEP)
    by_angle = (cone_distance(x, p, t, n, r, g + STEP) - cone_distance(x, p, t, n, r, g - STEP)) / (2.0 * STEP)
    # The second derivative grows with how near the axis is.
    allowed = DIFFERENCES * (1.0 + 1.0 / room.min())
    assert inner[6] == pytest.approx(by_radius, abs=allowed)
    assert inner[7] == pytest.approx(by_angle, abs=allowed)


def moved_by(twist, p, *vectors):
    """A frame after a small motion along a twist (6,): points and vectors."""
    columns_ = np.broadcast_to(twist[:, None], (len(p), 6, 1))
    point = p + point_velocity(columns_, p)[..., 0]
    omega = np.broadcast_to(twist[:3], p.shape)
    angle = np.linalg.norm(omega, axis=-1)
    axis = omega / np.maximum(angle, 1e-300)[:, None]
    return [point, *(rotate_about(axis, angle, v) for v in vectors)]


@many
@given(seeds, radii, half_angles)
def test_derivatives_by_the_twist_agree_with_finite_differences(seed, radius, half_angle):
    feet, normals, room, (p, t, n, r, g) = place(seed, radius, half_angle)
    x = columns(feet + (0.3 * room * np.sign(radius))[:, None] * normals)
    _, inner = Skins.of_panels(p, t, n, r, g).distance_inner(x)
    planes = skin_rows(p.T, t.T, n.T, np.zeros(len(p)), np.zeros(len(p)))[:, :, None]
    _, flat = Skins(planes, curved=False).distance_inner(x)
    allowed = DIFFERENCES * (1.0 + 1.0 / room.min()) * 30.0
    for j in range(6):
        step = STEP * np.eye(6)[j]
        ahead, behind = moved_by(step, p, t, n), moved_by(-step, p, t, n)
        apart = [cone_distance(x, p_, t_, n_, r, g) for p_, t_, n_ in (ahead, behind)]
        change = (apart[0] - apart[1]) / (2.0 * STEP)
        assert inner[j] == pytest.approx(change, abs=allowed)
        change = (plane_distance(x, ahead[0], ahead[2]) - plane_distance(x, behind[0], behind[2])) / (2.0 * STEP)
        assert flat[j] == pytest.approx(change, abs=allowed)


@many
@given(seeds, radii)
def test_the_distance_is_smooth_through_half_angle_zero(seed, radius):
    feet, normals, room, (p, t, n, r, zero) = place(seed, radius, 0.0)
    x = columns(feet + (0.3 * room * np.sign(radius))[:, None] * normals)
    at_zero, inner = Skins.of_panels(p, t, n, r, zero).distance_inner(x)
    for half_angle in SMALL:
        g = np.full_like(r, half_angle)
        distance, there = Skins.of_panels(p, t, n, r, g).distance_inner(x)
        # Second order: what is left after the tangent is a square, down to rounding.
        bound = 50.0 * half_angle**2 / min(1.0, room.min()) + ROUNDING
        assert distance == pytest.approx(at_zero + half_angle * inner[7], abs=bound)
        assert there == pytest.approx(inner, abs=100.0 * abs(half_angle) / min(1.0, room.min()) + ROUNDING)


@many
@given(seeds, radii)
def test_half_angle_zero_is_exactly_the_cylinder(seed, radius):
    feet, normals, room, (p, t, n, r, zero) = place(seed, radius, 0.0)
    x = feet + (0.3 * room * np.sign(radius))[:, None] * normals
    aside = cross(x - (p - r[:, None] * n), t)
    expected = np.sign(radius) * np.linalg.norm(aside, axis=-1) - radius
    assert cone_distance(columns(x), p, t, n, r, zero)[:, 0] == pytest.approx(expected, abs=ROUNDING)


@many
@given(seeds, radii, half_angles, st.floats(-1.0, 1.0))
def test_any_generatrix_describes_the_same_cone(seed, radius, half_angle, angle):
    feet, normals, room, (p, t, n, r, g) = place(seed, radius, half_angle)
    x = columns(feet + (0.3 * room)[:, None] * normals)
    axis = math.cos(half_angle) * t - math.sin(half_angle) * n
    turn = np.full(len(p), angle)
    other_n = rotate_about(axis, turn, n)
    other = (p - radius * n + radius * other_n, rotate_about(axis, turn, t), other_n)
    assert cone_distance(x, *other, r, g) == pytest.approx(cone_distance(x, p, t, n, r, g), abs=1e-11)


@many
@given(seeds, half_angles)
def test_a_very_large_radius_is_nearly_the_plane(seed, half_angle):
    p, _, t, n = ruling(seed, 5)
    random = np.random.default_rng(seed + 1)
    x = columns(p + 0.1 * random.normal(size=(5, 3)))
    flat = plane_distance(x, p, n)
    for radius in (1e4, -1e4):
        bent = cone_distance(x, p, t, n, np.full(5, radius), np.full(5, half_angle))
        assert bent == pytest.approx(flat, abs=1e-4)


@many
@given(seeds)
def test_beyond_tells_the_two_sides_of_a_ruling(seed):
    p, b, t, n = ruling(seed, 5)
    aside = np.random.default_rng(seed + 1).uniform(1e-6, 1.0, 5)[:, None] * b
    anywhere = 3.0 * t - 2.0 * n
    assert beyond(columns(p + aside + anywhere), p, b).all()
    assert not beyond(columns(p - aside + anywhere), p, b).any()
    assert dot(b, t) == pytest.approx(0.0, abs=ROUNDING)
