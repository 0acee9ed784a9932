"""Laws of end curves and of the distance between two of them along a whole seam."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cadpanel.geometry.closest_points import distances_near
from cadpanel.geometry.cone import cone_distance, plane_distance
from cadpanel.geometry.end_curves import EndCurves, as_chains, seam_gap
from cadpanel.geometry.patches import ConePatch
from cadpanel.geometry.vectors import dot
from tests.closest import closest
from tests.known_panels import end_curve
from tests.seams import backwards
from tests.shapes import CHAINS, folded_panel, random_panel

# Millimetres, on panels of 2 m that stand up to 20 m from the origin.
ROUNDING = 1e-8
# The closest point is found by an iteration; the distance of points that are near is better than this, and that of
# points as far off as the curve's radius better than a share of itself.
CLOSEST = 1e-6
FAR_SHARE = 0.01

few = settings(max_examples=12)
seeds = st.integers(0, 10_000)
chains = st.sampled_from(sorted(chain for chain in CHAINS if chain != "plane"))


def shifted(curves, by):
    """The curves moved by a vector (3,)."""
    return replace(curves, corners=curves.corners + by, p=curves.p + by, cut_point=curves.cut_point + by)


def followed(curves, count=2001):
    u = np.linspace(0.0, curves.patches, count)
    return u, *(values[0] for values in curves.follow(u[None]))


@few
@given(seeds, chains, st.sampled_from([0, 1]))
def test_the_curve_runs_through_the_corners(seed, chain, end):
    curves = end_curve(random_panel(seed, chain=chain), end)
    points, _ = curves.follow(np.arange(curves.patches + 1.0)[None])
    assert points == pytest.approx(curves.corners, abs=ROUNDING)


@few
@given(seeds, chains, st.sampled_from([0, 1]))
def test_the_curve_lies_on_its_cut_plane_and_on_its_patches(seed, chain, end):
    shape = random_panel(seed, chain=chain)
    curves = end_curve(shape, end)
    u, points, normals = followed(curves, 101)
    assert (points - shape.cut_points[end]) @ shape.cut_normals[end] == pytest.approx(0.0, abs=ROUNDING)
    assert np.linalg.norm(normals, axis=-1) == pytest.approx(1.0, abs=1e-12)
    for i, patch in enumerate(shape.patches):
        x = points[(u >= i) & (u <= i + 1)].T[:, None]
        p, t, n = shape.points[i, None], shape.directions[i, None], shape.normals[i, None]
        if isinstance(patch, ConePatch):
            distance = cone_distance(x, p, t, n, np.array([patch.radius]), np.array([patch.half_angle]))
        else:
            distance = plane_distance(x, p, n)
        assert distance == pytest.approx(0.0, abs=ROUNDING)


@few
@given(seeds, chains)
def test_the_normals_turn_without_a_leap_from_patch_to_patch(seed, chain):
    curves = end_curve(random_panel(seed, chain=chain), 1)
    for i in range(1, curves.patches):
        at = curves.follow(np.array([[i - 1e-12, float(i)]]))[1][0]
        assert at[0] == pytest.approx(at[1], abs=1e-10)


@few
@given(seeds, chains, st.sampled_from([0.0, 1e-3, 1.0, 10.0, 100.0]))
def test_the_closest_point_is_no_farther_than_any_point_of_the_curve(seed, chain, away):
    curves = end_curve(random_panel(seed, chain=chain), 0)
    random = np.random.default_rng(seed)
    _, points, _ = followed(curves)
    x = points[random.integers(0, len(points), 20)] + away * random.normal(size=(20, 3))
    distance, u = closest(curves, x[None])
    brute = np.linalg.norm(x[:, None] - points[None], axis=-1).min(axis=1)
    spacing = np.linalg.norm(np.diff(points, axis=0), axis=-1).max()
    assert np.all(distance[0] <= brute + (CLOSEST if away <= 1.0 else FAR_SHARE * brute))
    assert np.all(distance[0] >= brute - spacing)
    # The parameter is that of the distance.
    there = np.linalg.norm(curves.follow(u)[0] - x, axis=-1)
    assert there == pytest.approx(distance, abs=ROUNDING)


@few
@given(seeds, chains)
def test_points_of_the_curve_have_no_distance_from_it(seed, chain):
    curves = end_curve(random_panel(seed, chain=chain), 0)
    _, points, _ = followed(curves, 137)
    distance, _ = closest(curves, points[None])
    assert distance == pytest.approx(0.0, abs=CLOSEST)


@few
@given(seeds, chains)
def test_a_curve_has_no_gap_and_no_kink_with_itself(seed, chain):
    curves = end_curve(random_panel(seed, chain=chain), 1)
    gap, kink, _, _ = seam_gap(curves, curves)
    assert gap == pytest.approx(0.0, abs=CLOSEST)
    assert kink == pytest.approx(0.0, abs=1e-7)


@few
@given(seeds, chains, st.sampled_from([1e-3, 0.1, 5.0]))
def test_a_shift_out_of_the_cut_plane_is_the_gap(seed, chain, by):
    shape = random_panel(seed, chain=chain)
    curves = end_curve(shape, 1)
    gap, *_ = seam_gap(curves, shifted(curves, by * shape.cut_normals[1]))
    assert gap == pytest.approx(by, abs=CLOSEST)


@few
@given(seeds, seeds, chains)
def test_the_gap_is_symmetric(one, other, chain):
    first = end_curve(random_panel(one, chain=chain), 1)
    second = end_curve(random_panel(other, chain=chain), 0)
    second = shifted(second, (first.corners - second.corners)[0, 0])
    ahead, back = seam_gap(first, second), seam_gap(second, first)
    assert np.array_equal(ahead[0], back[0])
    assert np.array_equal(ahead[1], back[1])


@few
@given(seeds, seeds, chains)
def test_the_gap_agrees_with_finely_followed_curves(one, other, chain):
    first = end_curve(random_panel(one, chain=chain), 1)
    second = end_curve(random_panel(other, chain=chain), 0)
    second = shifted(second, (first.corners - second.corners)[0, 0])
    (_, a, _), (_, b, _) = followed(first, 801), followed(second, 801)
    between = np.linalg.norm(a[:, None] - b[None], axis=-1)
    brute = max(between.min(axis=0).max(), between.min(axis=1).max())
    spacing = max(np.linalg.norm(np.diff(points, axis=0), axis=-1).max() for points in (a, b))
    gap = seam_gap(first, second)[0][0]
    # The stations of the measure may miss the farthest point by the bend between two of them.
    assert brute * 0.99 - spacing <= gap <= brute + CLOSEST + spacing


@few
@given(st.integers(0, 500))
def test_a_seam_walked_the_other_way_has_the_same_gap(seed):
    """A panel turned end for end: its curve runs from the other side."""
    shape = random_panel(seed)
    curves = end_curve(shape, 1)
    turned = backwards(curves)
    gap, kink, _, _ = seam_gap(curves, turned)
    assert gap == pytest.approx(0.0, abs=CLOSEST)
    assert kink == pytest.approx(0.0, abs=1e-7)
    moved = shifted(turned, 3.0 * shape.cut_normals[1])
    assert seam_gap(curves, moved)[0] == pytest.approx(3.0, abs=CLOSEST)


def test_one_curve_of_a_batch_does_not_touch_the_others():
    curves = [end_curve(random_panel(seed), 0) for seed in range(4)]
    batch = EndCurves(*(np.concatenate([getattr(c, name) for c in curves]) for name in EndCurves.__slots__))
    other = shifted(batch, np.array([1.0, 2.0, 3.0]))
    gap, kink, _, _ = seam_gap(batch, other)
    for i in range(4):
        alone = seam_gap(batch.take(np.array([i])), other.take(np.array([i])))
        assert gap[i] == pytest.approx(alone[0][0], abs=1e-9)
        assert kink[i] == pytest.approx(alone[1][0], abs=1e-9)


def test_a_seam_that_opens_only_between_the_corners_is_seen():
    """Two arcs with the same ends and another bulge: every corner gap is 0, the seam gap is not."""
    narrow = end_curve(folded_panel(radius=200.0, sweep=1.0), 0)
    # The chord of the wider arc is the same: radius sin(sweep / 2) agrees.
    half = np.arcsin(200.0 * np.sin(0.5) / 230.0)
    wide = end_curve(folded_panel(radius=230.0, sweep=2.0 * half), 0)
    arc_only = [
        replace(c, **{name: getattr(c, name)[:, 1:3] for name in ("corners", "p", "t", "n")})
        for c in (
            replace(narrow, **{name: getattr(narrow, name)[:, 1:2] for name in ("radius", "half_angle", "sweep")}),
            replace(wide, **{name: getattr(wide, name)[:, 1:2] for name in ("radius", "half_angle", "sweep")}),
        )
    ]

    def upright(curve):
        """Its chord laid on the x axis of its cut plane, the bulge up."""
        start, end = curve.corners[0]
        x = (end - start) / np.linalg.norm(end - start)
        z = np.array([1.0, 0.0, 0.0])
        basis = np.stack([x, np.cross(z, x), z])
        move = {name: (getattr(curve, name) - start) @ basis.T for name in ("corners", "p", "cut_point")}
        turn = {name: getattr(curve, name) @ basis.T for name in ("t", "n", "cut_normal")}
        return replace(curve, **move, **turn)

    one, other = (upright(curve) for curve in arc_only)
    assert np.linalg.norm(one.corners - other.corners, axis=-1).max() < 1e-9
    bulge = [radius * (1.0 - np.cos(0.5 * sweep)) for radius, sweep in ((200.0, 1.0), (230.0, 2.0 * half))]
    gap = seam_gap(one, other)[0][0]
    assert gap == pytest.approx(bulge[0] - bulge[1], rel=1e-3)


@few
@given(seeds)
def test_stations_follow_every_patch_from_end_to_end(seed):
    curves = end_curve(random_panel(seed), 0)
    stations = curves.stations()
    assert stations[0] == 0.0
    assert stations[-1] == curves.patches
    assert np.all(np.diff(stations) > 0.0)
    assert set(range(curves.patches + 1)) <= set(stations.tolist())
    assert dot(curves.t, curves.n) == pytest.approx(0.0, abs=1e-12)


@few
@given(seeds, st.integers(0, 1))
def test_the_closest_point_of_a_straight_end_is_the_foot_or_an_end(seed, end):
    """On the end of a plane that stands anywhere."""
    curves = end_curve(random_panel(seed, chain="plane"), end)
    assert curves.patches == 1
    random = np.random.default_rng(seed)
    first, last = curves.corners[0]
    points = first + random.uniform(-0.5, 1.5, (9, 1)) * (last - first) + 30.0 * random.normal(size=(9, 3))
    distance, u = closest(curves, points[None])
    fine = first + np.linspace(0.0, 1.0, 20_001)[:, None] * (last - first)
    brute = np.linalg.norm(points[:, None] - fine, axis=-1)
    assert distance[0] == pytest.approx(brute.min(axis=1), abs=1e-3)
    assert u[0] == pytest.approx(brute.argmin(axis=1) / 20_000, abs=1e-4)


@few
@given(seed=seeds, chain=chains)
def test_a_distance_to_some_place_near_is_at_least_that_of_the_closest_point_and_about_it_where_it_is_near(seed, chain):
    """From any place at all it is no less; from near the closest point a step leads all but there."""
    random = np.random.default_rng(seed)
    curves = end_curve(random_panel(seed, chain=chain), 0)
    u = random.uniform(0.05, 0.95, 60) + random.integers(0, curves.patches, 60)
    foot, normals = (values[0] for values in curves.follow(u[None]))
    points = foot + random.uniform(-20.0, 20.0, (60, 1)) * normals
    origin = curves.corners[:, 0]
    on, flat = as_chains(curves, origin), (points - origin).T
    least, where = (values[0] for values in closest(curves, points[None]))
    anywhere = random.integers(0, curves.patches, 60)
    assert np.all(distances_near(on, anywhere, random.uniform(0.0, 1.0, 60), flat) >= least - ROUNDING)
    piece = np.minimum(where.astype(np.intp), curves.patches - 1)
    near = np.clip(where - piece + random.uniform(-0.01, 0.01, 60), 0.0, 1.0)
    found = distances_near(on, piece, near, flat)
    assert np.all(found >= least - ROUNDING)
    assert found == pytest.approx(least, rel=1e-3, abs=1e-3)
    exact = distances_near(on, piece, where - piece, flat)
    assert exact == pytest.approx(least, abs=ROUNDING)
