"""A strip through tangent planes of a developable surface is that surface, and any strip is developable."""

import numpy as np
import pytest

from cadpanel.errors import LoftError
from cadpanel.lofting.tangent_planes import Sampled, plane_curve
from tests.known_rails import cone_samples, off_torse, torse_samples
from tests.known_strips import KNOWN, strip


def turned(seed):
    axes, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    return axes * np.sign(np.linalg.det(axes))


@pytest.mark.parametrize("name", KNOWN)
def test_a_developable_strip_comes_back_within_a_millionth_of_its_size(name):
    points, normals, _, _ = KNOWN[name]()
    _, off = strip(name, 16).feet(points)
    assert np.abs(off).max() < 1e-6 * np.ptp(points, axis=0).max()
    _, lifted = strip(name, 16).feet(points + 3.0 * normals)
    assert lifted == pytest.approx(3.0, abs=1e-3)


def test_its_rulings_are_those_of_the_surface():
    points, ways = strip("torse").rulings(strip("torse").stations(30))
    assert max(off_torse(points + far * ways).max() for far in (-100.0, 0.0, 200.0)) < 1e-3
    low, high = (np.array([0.0, 0.0, 1.0, -height]) for height in (20.0, 250.0))
    ends = strip("cone").between(strip("cone").stations(30), np.array([low, high]))
    for end, radius in ((0, 96.0), (1, 50.0)):
        assert np.hypot(*ends[:, end, :2].T) == pytest.approx(radius, abs=1e-3)


def test_twice_as_many_spans_are_ten_times_as_near():
    points, *_ = torse_samples()
    off = [np.abs(strip("torse", spans).feet(points)[1]).max() for spans in (2, 4, 8)]
    assert off[0] > 8.0 * off[1] > 64.0 * off[2]


def test_a_strip_through_planes_of_a_twisted_surface_is_developable_all_the_same():
    x, y = (grid.ravel() for grid in np.meshgrid(np.linspace(-300.0, 300.0, 13), np.linspace(-500.0, 500.0, 9)))
    slope = np.stack([-x / 400.0 - 1e-4 * y, -1e-4 * x], axis=-1)
    heights = -(x**2) / 800.0 - 1e-4 * x * y
    normals = np.column_stack([-slope, np.ones_like(x)])
    normals /= np.linalg.norm(normals, axis=-1)[:, None]
    curve = plane_curve(
        Sampled.of(np.column_stack([x, y, heights]), normals, np.ones_like(x), np.array([0.0, 1.0, 0.0]))
    )
    s, step = curve.stations(9)[1:-1], 1e-5
    planes = curve.planes(s)
    bounds = np.array([[0.0, 1.0, 0.0, 400.0], [0.0, 1.0, 0.0, -400.0]])
    before, after = curve.between(s - step, bounds), curve.between(s + step, bounds)
    # Both ends move in one tangent plane, that of the family.
    moved = (after - before) / np.linalg.norm(after - before, axis=-1)[..., None]
    assert np.abs(np.einsum("med,md->me", moved, planes[:, :3])).max() < 1e-7
    assert np.abs(np.einsum("med,md->me", before, planes[:, :3]) + planes[:, 3:]).max() < 1e-4
    # It is no copy of the surface, which is not developable.
    assert 0.1 < np.abs(curve.feet(np.column_stack([x, y, heights]))[1]).max() < 10.0


def test_velocities_are_how_planes_move_and_turn_their_normals_at_the_rate_one():
    curve, step = strip("torse"), 1e-6
    s = curve.stations(9)[1:-1]
    moved = curve.planes(s + step) - curve.planes(s - step)
    moved /= np.linalg.norm(moved[:, :3], axis=-1)[:, None]
    assert np.abs(moved - curve.velocities(s))[:, :3].max() < 1e-7
    assert moved == pytest.approx(curve.velocities(s), rel=1e-6, abs=1e-6)


def test_moving_and_turning_the_samples_does_so_with_the_strip():
    points, normals, weights, along = torse_samples()
    axes, shift = turned(3), np.array([9000.0, -4000.0, 2500.0])
    moved = plane_curve(Sampled.of(points @ axes.T + shift, normals @ axes.T, weights, axes @ along))
    s = moved.stations(9)
    planes = strip("torse").planes(s)
    expected = planes[:, :3] @ axes.T
    assert moved.planes(s) == pytest.approx(np.column_stack([expected, planes[:, 3] - expected @ shift]), abs=1e-6)


def test_flat_parts_at_the_sides_are_planes():
    u, z = (grid.ravel() for grid in np.meshgrid(np.linspace(-1.8, 1.8, 73), np.linspace(-400.0, 400.0, 9)))
    angle, beyond = np.clip(u, -0.6, 0.6), 300.0 * (u - np.clip(u, -0.6, 0.6))
    out, way = ((np.stack(pair, axis=-1)) for pair in ((np.sin(angle), np.cos(angle)), (np.cos(angle), -np.sin(angle))))
    flat = 300.0 * out + beyond[:, None] * way
    points, normals = np.insert(flat, 1, z, axis=1), np.insert(out, 1, 0.0, axis=1)
    sampled = Sampled.of(points, normals, np.ones(len(points)), np.array([0.0, 1.0, 0.0]))
    curve = plane_curve(sampled)
    assert curve.turning == pytest.approx((-np.tan(0.6), np.tan(0.6)), abs=1e-9)
    assert curve.bend == 1
    assert np.abs(curve.feet(points)[1]).max() < 0.1


def test_what_is_no_strip_is_refused():
    points, normals, weights, along = cone_samples(slope=0.0)
    with pytest.raises(LoftError, match="is flat"):
        plane_curve(Sampled.of(points, np.tile(normals[:1], (len(points), 1)), weights, along))
    round_, outwards, *_ = cone_samples(slope=0.0, first=-1.5, last=1.5)
    with pytest.raises(LoftError, match="86 degrees from their mean"):
        Sampled.of(round_, outwards, np.ones(len(round_)), along)
    wave = points * np.array([0.0, 1.0, 1.0])
    to_and_fro = np.stack([np.ones(len(wave)), np.sin(wave[:, 1] / 15.0), 0.0 * weights], axis=-1)
    to_and_fro /= np.linalg.norm(to_and_fro, axis=-1)[:, None]
    curve = plane_curve(Sampled.of(wave, to_and_fro, weights, along))
    assert curve.bend == 0
    with pytest.raises(LoftError, match="meet inside"):
        curve.feet(wave)
