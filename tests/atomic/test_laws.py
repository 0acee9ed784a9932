"""What must not matter does not: place, turn, unit, order, padding, company; and scatter is told as it is."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import cadpanel as cp
from cadpanel.atomic import orthogonal
from cadpanel.atomic.cone import fit_cones
from cadpanel.atomic.cylinder import fit_cylinders
from cadpanel.atomic.orthogonal import descend
from cadpanel.atomic.plane import fit_planes
from cadpanel.atomic.ruling import CONE, CYLINDER, Rulings, distance_rows
from tests.atomic.known_samples import between, known_cone, rotation
from tests.thorough import thorough

pytestmark = pytest.mark.each_value_once

CLOSE = 1e-7

many = settings(max_examples=15, derandomize=True, deadline=None)
seeds = st.integers(0, 2**32 - 1)
every_kind = pytest.mark.parametrize("kind", ["plane", "cylinder", "cone"])
BATCH: dict[str, Callable[..., Any]] = {
    "plane": lambda x, n, w: fit_planes(x, w, normals=n),
    "cylinder": fit_cylinders,
    "cone": fit_cones,
}
SINGLE: dict[str, Callable[..., Any]] = {
    "plane": lambda x, n=None, w=None: cp.fit_plane(x, w, normals=n),
    "cylinder": cp.fit_cylinder,
    "cone": cp.fit_cone,
}


def noisy(seed, kind, count=40):
    """Samples with noise of about a thousandth; their normals."""
    random = np.random.default_rng(seed)
    half_angle = {"plane": 0.0, "cylinder": 0.0, "cone": 0.2}[kind]
    radius = 1e9 if kind == "plane" else 1000.0
    arc = 1e-6 if kind == "plane" else random.uniform(1.0, 3.0)
    return known_cone(random, radius=radius, half_angle=half_angle, arc=arc, length=1500.0, count=count, noise=1.0)


def same(first, second, scale=1.0):
    """Two fits with their residuals sample by sample."""
    assert second.rms == pytest.approx(scale * first.rms, rel=CLOSE)
    assert second.residuals == pytest.approx(scale * first.residuals, abs=CLOSE * scale * first.size)
    assert second.converged == first.converged
    spread = [np.sqrt(np.diag(fit.covariance)[0]) for fit in (first, second)]
    assert spread[1] == pytest.approx(spread[0], rel=1e-4)


@every_kind
@many
@given(seeds, st.floats(1e-3, 1e3))
def test_moving_turning_and_scaling_the_samples_does_the_same_to_the_fit(kind, seed, scale):
    known = noisy(seed, kind)
    random = np.random.default_rng(seed + 1)
    turn, offset = rotation(random), 1e4 * random.normal(size=3)
    first = SINGLE[kind](known.points, known.normals)
    second = SINGLE[kind](scale * (known.points @ turn.T + offset), known.normals @ turn.T)
    same(first, second, scale)
    assert second.normal == pytest.approx(turn @ first.normal, abs=CLOSE)
    assert second.point == pytest.approx(scale * (turn @ first.point + offset), abs=CLOSE * scale * 1e4)
    if kind != "plane":
        assert second.radius == pytest.approx(scale * first.radius, rel=CLOSE)
        assert between(second.axis, turn @ first.axis) < CLOSE
    if kind == "cone":
        assert second.half_angle == pytest.approx(first.half_angle, abs=CLOSE)


@every_kind
@many
@given(seeds)
def test_renumbering_the_samples_changes_nothing(kind, seed):
    known = noisy(seed, kind)
    order = np.random.default_rng(seed).permutation(len(known.points))
    first = SINGLE[kind](known.points, known.normals)
    second = SINGLE[kind](known.points[order], known.normals[order])
    assert second.residuals == pytest.approx(first.residuals[order], abs=CLOSE)
    assert second.rms == pytest.approx(first.rms, rel=1e-9)


@every_kind
@many
@given(seeds)
def test_a_weight_of_zero_leaves_the_sample_out(kind, seed):
    known = noisy(seed, kind)
    random = np.random.default_rng(seed)
    weights = random.uniform(0.5, 2.0, len(known.points)) * (random.random(len(known.points)) < 0.7)
    points = np.where((weights > 0.0)[:, None], known.points, np.nan)
    used = weights > 0.0
    first = SINGLE[kind](known.points[used], None, weights[used])
    second = SINGLE[kind](points, None, 3.0 * weights)
    assert second.rms == pytest.approx(first.rms, rel=CLOSE)
    assert second.residuals[used] == pytest.approx(first.residuals, abs=CLOSE)
    assert np.all(second.residuals[~used] == 0.0)
    assert np.diag(second.covariance) == pytest.approx(np.diag(first.covariance), rel=1e-4)


@every_kind
@many
@given(seeds)
def test_a_whole_weight_counts_as_so_many_samples(kind, seed):
    known = noisy(seed, kind)
    times = np.random.default_rng(seed).integers(1, 4, len(known.points))
    first = SINGLE[kind](known.points, None, times.astype(float))
    second = SINGLE[kind](np.repeat(known.points, times, axis=0))
    assert second.rms == pytest.approx(first.rms, rel=CLOSE)


@every_kind
def test_a_batch_gives_what_each_set_gives_alone(kind):
    known = [noisy(seed, kind, count=20 + seed) for seed in range(6)]
    most = max(len(one.points) for one in known)
    points, normals, weights = np.zeros((6, most, 3)), np.zeros((6, most, 3)), np.zeros((6, most))
    for i, one in enumerate(known):
        own = len(one.points)
        points[i, :own], normals[i, :own], weights[i, :own] = one.points, one.normals, 1.0
    found = BATCH[kind](points, normals, weights)
    for i, one in enumerate(known):
        alone = SINGLE[kind](one.points, one.normals)
        assert found.rms[i] == pytest.approx(alone.rms, rel=1e-9)
        assert found.residuals[i, : len(one.points)] == pytest.approx(alone.residuals, abs=CLOSE)
        assert found.points[i] == pytest.approx(alone.point, abs=CLOSE)
        assert found.frames[i] == pytest.approx(alone.frame, abs=CLOSE)


@many
@given(seeds, st.sampled_from(["cylinder", "cone"]))
def test_the_fit_is_at_least_as_good_as_the_true_surface(seed, kind):
    known = noisy(seed, kind)
    fit = SINGLE[kind](known.points)
    assert fit.rms <= math.sqrt(np.mean(known.noise**2)) * (1.0 + 1e-12)
    assert fit.max == np.max(np.abs(fit.residuals))
    assert fit.rms == pytest.approx(math.sqrt(np.mean(fit.residuals**2)), rel=1e-12)


@pytest.mark.parametrize("kind", ["cylinder", "cone"])
@pytest.mark.parametrize("arc", [math.radians(5.0), math.radians(40.0), 2.0])
@pytest.mark.parametrize("noise", [0.1, 3.0])
def test_no_random_start_finds_a_better_minimum(kind, arc, noise):
    """Brute force: 200 starts with any axis, each run to its minimum."""
    random = np.random.default_rng(17)
    unknowns = CYLINDER if kind == "cylinder" else CONE
    for slimness in (0.1, 1.0, 10.0):
        width = 1000.0 if slimness <= 1.0 else 300.0
        known = known_cone(random, radius=width / arc, arc=arc, length=width * slimness, count=30, noise=noise)
        fit = SINGLE[kind](known.points)
        x = (known.points - known.points.mean(axis=0)) / fit.size
        starts = any_starts(random, 200, x, tapered=kind == "cone")
        each = np.broadcast_to(x, (200, *x.shape))
        roots = np.full((200, len(x)), 1.0 / math.sqrt(len(x)))
        best = math.sqrt(np.min(descend(each, roots, starts, unknowns, steps=60).cost)) * fit.size
        assert fit.rms <= best * (1.0 + 1e-6)


def any_starts(random, count, x, *, tapered):
    """Half with any axis, half with one in the samples' plane."""
    main = np.linalg.svd(x)[2].T
    main[:, 2] *= np.linalg.det(main)
    frames = np.stack([rotation(random) for _ in range(count)])
    for i, angle in enumerate(random.uniform(0.0, math.pi, count // 2)):
        cosine, sine = math.cos(angle), math.sin(angle)
        frames[i] = main @ np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
    return Rulings(
        points=0.1 * random.normal(size=(count, 3)),
        frames=frames,
        curvature=10.0 ** random.uniform(-3.0, 1.0, count) * random.choice([-1.0, 1.0], count),
        taper=random.uniform(-0.3, 0.3, count) if tapered else np.zeros(count),
    )


@thorough
def test_the_covariance_is_what_repeated_measurements_scatter():
    random = np.random.default_rng(29)
    known = known_cone(random, radius=1000.0, half_angle=0.15, arc=1.5, length=1200.0, count=40)
    repeats = 1500
    points = known.points + random.normal(size=(repeats, 40, 1)) * known.normals
    cones, cylinders = fit_cones(points), fit_cylinders(points)
    assert np.all(cones.converged)
    some = [cp.ConeFit.of(cones, i) for i in range(0, repeats, 3)]
    told = {
        "radius": np.mean([fit.radius_deviation**2 for fit in some]),
        "half angle": np.mean([fit.half_angle_deviation**2 for fit in some]),
        "axis": np.mean([fit.axis_deviation**2 for fit in some]),
    }
    axes = np.stack([fit.axis for fit in some])
    seen = {
        "radius": np.var([fit.radius for fit in some]),
        "half angle": np.var([fit.half_angle for fit in some]),
        "axis": np.sum(np.var(axes, axis=0)),
    }
    # 500 values tell a variance to 6 percent (one standard deviation).
    for name, variance in told.items():
        assert variance == pytest.approx(seen[name], rel=0.2), name
    # The cylinder does not fit, so its scatter must look larger than the noise of 1 mm.
    assert np.mean(cylinders.rms) > 2.0


def test_the_covariance_of_cylinders_and_planes_scatters_alike():
    random = np.random.default_rng(31)
    known = known_cone(random, radius=1000.0, arc=1.2, length=1500.0, count=30)
    points = known.points + random.normal(size=(600, 30, 1)) * known.normals
    cylinders = fit_cylinders(points)
    every = [cp.CylinderFit.of(cylinders, i) for i in range(600)]
    assert np.mean([fit.radius_deviation**2 for fit in every]) == pytest.approx(
        np.var([fit.radius for fit in every]), rel=0.2
    )
    axes = np.stack([fit.axis * np.sign(fit.axis @ known.axis) for fit in every])
    assert np.mean([fit.axis_deviation**2 for fit in every]) == pytest.approx(np.sum(np.var(axes, axis=0)), rel=0.2)
    flat = np.column_stack([random.uniform(-1.0, 1.0, (30, 2)) * [500.0, 200.0], np.zeros(30)])
    planes = fit_planes(flat + random.normal(size=(600, 30, 1)) * [0.0, 0.0, 1.0])
    told = np.mean([cp.PlaneFit.of(planes, i).normal_deviation ** 2 for i in range(600)])
    normals = planes.frames[:, :, 2] * np.sign(planes.frames[:, 2:, 2])
    assert told == pytest.approx(np.sum(np.var(normals, axis=0)), rel=0.2)


def test_what_samples_do_not_determine_has_no_finite_deviation():
    random = np.random.default_rng(37)
    flat = np.column_stack([random.uniform(-1.0, 1.0, (30, 2)), np.zeros(30)])
    assert cp.fit_cylinder(flat).axis_deviation == math.inf
    assert cp.fit_cone(flat).half_angle_deviation == math.inf
    # As many samples as unknowns leave nothing to tell the scatter from.
    known = known_cone(random, radius=1000.0, arc=2.0, length=1000.0, count=5)
    assert cp.fit_cylinder(known.points).radius_deviation == math.inf


def test_a_wrong_derivative_is_found(monkeypatch):
    """The smallest case that fails: with one sign turned the same samples no longer give their cylinder."""
    known = known_cone(np.random.default_rng(2), radius=1000.0, arc=1.0, length=1000.0)
    assert cp.fit_cylinder(known.points).max < 1e-9

    def wrong(rulings, q, unknowns):
        distance, rows = distance_rows(rulings, q, unknowns)
        rows[:, 0] *= -1.0
        return distance, rows

    monkeypatch.setattr(orthogonal, "distance_rows", wrong)
    assert cp.fit_cylinder(known.points).max > 1e-9
