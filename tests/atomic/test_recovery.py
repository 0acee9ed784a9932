"""Samples of known surfaces give the surfaces back, whatever their bend, side, size and place."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import cadpanel as cp
from cadpanel.atomic.cone import fit_cones
from cadpanel.atomic.cylinder import fit_cylinders
from cadpanel.atomic.plane import fit_planes
from tests.atomic.known_samples import between, known_cone, rotation

EPS = float(np.finfo(float).eps)
ANGLE = 1e-10
RADIUS = 1e-9

many = settings(max_examples=30, derandomize=True, deadline=None)
seeds = st.integers(0, 2**32 - 1)


def rounding(points):
    """What the last digit of the coordinates is worth, mm."""
    return EPS * float(np.max(np.abs(points)))


@many
@given(seeds, st.floats(0.05, 20.0))
def test_samples_of_a_plane_give_the_plane(seed, slimness):
    random = np.random.default_rng(seed)
    turn, offset = rotation(random), 1e3 * random.normal(size=3)
    flat = np.column_stack([random.uniform(-1.0, 1.0, (20, 2)) * [500.0 * slimness, 500.0], np.zeros(20)])
    fit = cp.fit_plane(flat @ turn.T + offset)
    assert between(fit.normal, turn[:, 2]) < ANGLE
    assert abs((fit.point - offset) @ turn[:, 2]) < 1e-9
    assert fit.converged
    assert fit.rms <= fit.max < 20.0 * rounding(flat + np.max(np.abs(offset)))


@many
@given(seeds, st.floats(math.radians(20.0), 2.0 * math.pi), st.floats(0.3, 5.0), st.booleans(), st.booleans())
def test_samples_of_a_cylinder_give_the_cylinder(seed, arc, slimness, with_normals, concave):
    random = np.random.default_rng(seed)
    known = known_cone(random, radius=1000.0, arc=arc, length=1000.0 * min(arc, 2.0) * slimness)
    side = -1.0 if concave else 1.0
    fit = cp.fit_cylinder(known.points, side * known.normals if with_normals else None)
    assert fit.converged
    assert fit.radius == pytest.approx(side * known.radius if with_normals else known.radius, rel=RADIUS)
    assert between(fit.axis, known.axis) < ANGLE
    assert fit.max < 1e-9


@many
@given(
    seeds,
    st.floats(math.radians(40.0), 2.0 * math.pi),
    st.floats(0.0, 1.2),
    st.floats(0.3, 1.5),
    st.booleans(),
    st.booleans(),
)
def test_samples_of_a_cone_give_the_cone(seed, arc, half_angle, share, with_normals, concave):
    random = np.random.default_rng(seed)
    length = min(2000.0, share * 1000.0 / max(math.tan(half_angle), 1e-9))
    known = known_cone(random, radius=1000.0, half_angle=half_angle, arc=arc, length=length)
    side = -1.0 if concave else 1.0
    fit = cp.fit_cone(known.points, side * known.normals if with_normals else None)
    assert fit.converged
    # A short arc of a wide cone tells its numbers less sharply than it tells the surface.
    slack = max(1.0, (1000.0 / length) ** 2) * 10.0
    assert fit.half_angle == pytest.approx(half_angle, abs=slack * ANGLE)
    assert between(fit.axis, known.axis) < slack * ANGLE
    if known.apex is not None and half_angle > 1e-2:
        assert fit.apex == pytest.approx(known.apex, abs=1e-4)
    assert math.copysign(1.0, fit.radius) == (side if with_normals else 1.0)
    assert fit.max < 1e-9


@pytest.mark.parametrize("half_angle", [0.0, 1e-12, 1e-10, 1e-8, 1e-6, 1e-4, 1e-3, 1e-2])
def test_the_half_angle_may_go_to_zero(half_angle):
    random = np.random.default_rng(7)
    known = known_cone(random, radius=800.0, half_angle=half_angle, arc=math.radians(100.0), length=2000.0)
    fit = cp.fit_cone(known.points)
    assert fit.converged
    assert fit.half_angle == pytest.approx(half_angle, abs=1e-14 * 10.0)
    assert between(fit.axis, known.axis) < ANGLE
    # The ruling under the samples' mean is not the one in the middle, where the radius is known.
    assert fit.radius == pytest.approx(known.radius, rel=RADIUS + 2.0 * math.tan(half_angle))


@pytest.mark.parametrize("ratio", [0.3, 1.0, 10.0, 1e2, 1e3, 1e4, 1e5, 1e6])
@pytest.mark.parametrize("fit_one", [cp.fit_cylinder, cp.fit_cone])
def test_a_radius_from_a_third_to_a_million_of_the_panel(fit_one, ratio):
    random = np.random.default_rng(3)
    radius = 1000.0 * ratio
    arc = min(2.0 * math.pi, 1.0 / ratio)
    known = known_cone(random, radius=radius, arc=arc, length=1000.0)
    fit = fit_one(known.points)
    assert fit.converged
    # The rise of the arc carries all there is to know of the radius; the coordinates' last digit blurs it.
    rise = radius * 2.0 * math.sin(0.25 * arc) ** 2
    blur = 20.0 * rounding(known.points) / rise
    assert 1.0 / fit.curvature == pytest.approx(radius, rel=RADIUS + blur)
    # The ruling stays sharp; a cone's axis leans with the half angle, which is the taper times the far radius.
    assert between(fit.frame[:, 1], known.axis) < ANGLE + 10.0 * blur
    assert fit.rms <= 2.0 * rounding(known.points)


def test_samples_of_a_plane_are_a_cylinder_and_a_cone_without_curvature():
    random = np.random.default_rng(5)
    flat = np.column_stack([random.uniform(-1.0, 1.0, (30, 2)) * 1000.0, np.zeros(30)])
    for fit_one in (cp.fit_cylinder, cp.fit_cone):
        fit = fit_one(flat)
        assert fit.converged
        assert fit.max < 1e-9
        assert abs(fit.curvature) < 1e-15
        assert abs(fit.normal[2]) == pytest.approx(1.0, abs=1e-12)


def test_a_near_flat_panel_with_a_published_radius():
    """OpenIndy-DefaultPlugin, test/function/tst_function.cpp: radius 10438.54 mm within 0.01, axis z within 1e-5."""
    arc = [(900.0, 19.05), (700.0, 12.34), (200.0, 12.34), (0.0, 19.05)]
    points = np.array([(x, y, z) for x, y in arc for z in (-1205.0, 0.0, 1205.0)])
    fit = cp.fit_cylinder(points)
    assert fit.radius == pytest.approx(10438.54, abs=0.01)
    # The circle through the four points is exact: its radius to all digits.
    assert fit.radius == pytest.approx(10438.539903180816, rel=1e-14)
    assert abs(fit.axis[2]) == pytest.approx(1.0, abs=1e-14)
    assert fit.max < 1e-12
    points[0, 0] = 901.0
    moved = cp.fit_cylinder(points)
    # The same file: one sample moved by 1 mm gives 10449.77 mm within 0.01.
    assert moved.radius == pytest.approx(10449.77, abs=0.01)
    assert moved.rms == pytest.approx(0.0077669087787892591, rel=1e-9)


@pytest.mark.parametrize(("half_angle", "noise"), [(math.radians(3.0), 2.9e-7), (math.radians(3.0), 0.0)])
def test_two_rings_of_a_slender_cone_are_no_wide_cylinder(half_angle, noise):
    """Two far rings lie on a sphere as well as on a cone, and a wide cylinder across them is a local minimum."""
    random = np.random.default_rng(11)
    known = known_cone(random, radius=0.1, half_angle=half_angle, arc=2.0 * math.pi, length=1.0, count=400, noise=noise)
    along = known.points @ known.axis
    ends = np.abs(along - np.mean(along)) > 0.42
    fit = cp.fit_cone(known.points[ends])
    assert fit.rms <= np.sqrt(np.mean(known.noise[ends] ** 2)) + 1e-15
    assert math.degrees(abs(fit.half_angle - half_angle)) < (1e-4 if noise else 1e-9)


@pytest.mark.parametrize("with_normals", [False, True])
def test_many_random_patches_lose_none(with_normals):
    random = np.random.default_rng(23)
    fits = {"cylinder": fit_cylinders, "cone": fit_cones}
    for kind, fit_many in fits.items():
        known = [random_patch(random, kind) for _ in range(150)]
        points = np.stack([one.points for one in known])
        normals = np.stack([one.normals for one in known]) if with_normals else None
        found = fit_many(points, normals)
        true = np.array([np.sqrt(np.mean(one.noise**2)) for one in known])
        allowed = true * (1.0 + 1e-9) + 10.0 * EPS * np.max(np.abs(points), axis=(1, 2))
        assert np.flatnonzero(found.rms > allowed).tolist() == []
        assert np.all(found.converged)


def random_patch(random, kind):
    """An arc of 5 to 360 degrees, a strip 1:30 to 30:1, half angle to 69 degrees or tiny, noise or none."""
    length = 10.0 ** random.uniform(2.0, 4.0)
    arc = math.radians(random.uniform(5.0, 360.0))
    radius = length * 10.0 ** random.uniform(-1.5, 1.5) / (2.0 * math.sin(0.5 * min(arc, math.pi)))
    half_angle = 0.0
    if kind == "cone":
        half_angle = random.choice([random.uniform(0.0, 1.2), 10.0 ** random.uniform(-12.0, -1.0)])
        length = min(length, 1.6 * radius / math.tan(half_angle))
    narrow = radius - 0.5 * length * math.tan(half_angle)
    noise = random.choice([0.0, min(length * 10.0 ** random.uniform(-6.0, -2.0), 0.05 * narrow)])
    return known_cone(random, radius=radius, half_angle=half_angle, arc=arc, length=length, noise=noise, count=40)


def test_planes_of_a_batch_are_those_of_each_alone():
    random = np.random.default_rng(1)
    points = random.normal(size=(5, 12, 3)) * [3.0, 2.0, 0.1]
    found = fit_planes(points)
    for i in range(5):
        assert found.frames[i] == pytest.approx(cp.fit_plane(points[i]).frame, abs=1e-12)
