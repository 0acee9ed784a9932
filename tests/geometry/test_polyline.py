"""Distances to curves of which only points are known."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cadpanel.geometry.polyline import (
    arc_length,
    arc_lengths,
    distances_to_curves,
    distances_to_polylines,
    end_tangents,
    inside_edges,
    interpolate,
)


def helix(parts, radius, turn, pitch):
    angle = turn * parts
    return np.stack([radius * np.cos(angle), radius * np.sin(angle), pitch * angle], axis=-1)


@given(
    radius=st.floats(50.0, 50_000.0),
    turn=st.floats(0.05, 2.5),
    slope=st.floats(0.0, 1.0),
    off=st.floats(1e-3, 1e-2),
    side=st.sampled_from([-1.0, 1.0]),
    even=st.floats(0.0, 0.2),
)
@settings(max_examples=100, deadline=None)
def test_distance_off_a_helix_is_what_it_was_moved_by_on_either_side(radius, turn, slope, off, side, even):
    """Where chords would be off by up to 2 % of the radius, and however unevenly the points lie."""
    parts = np.linspace(0.0, 1.0, 65)
    curve = helix(parts + even * parts * (1.0 - parts), radius, turn, slope * radius)
    inside = np.linspace(0.02, 0.98, 50)
    foot = helix(inside, radius, turn, slope * radius)
    outwards = np.stack([np.cos(turn * inside), np.sin(turn * inside), 0.0 * inside], axis=-1)
    found = distances_to_curves((foot + side * off * radius * outwards)[None], curve[None])
    np.testing.assert_allclose(found[0], off * radius, atol=1e-6 * radius)


@pytest.mark.parametrize("turned", [8.0, 14.0])
def test_a_curve_that_turns_less_than_sharply_from_point_to_point_is_no_polyline(turned):
    """However far it turns over several points: chords would be off by the sagitta, 0.2 to 0.7 % of the radius."""
    count = 9
    curve = helix(np.linspace(0.0, 1.0, count), 1.0, np.radians(turned) * (count - 1), 0.0)
    between = helix(np.linspace(0.0, 1.0, 2 * count - 1)[1::2], 1.0, np.radians(turned) * (count - 1), 0.0)
    np.testing.assert_allclose(distances_to_curves(between[None], curve[None])[0], 0.0, atol=5e-4)


def test_distance_beyond_an_end_is_to_the_end():
    line = np.linspace([0.0, 0.0, 0.0], [100.0, 0.0, 0.0], 9)
    assert distances_to_curves(np.array([[[103.0, 4.0, 0.0], [-3.0, 4.0, 0.0]]]), line[None])[0] == pytest.approx(5.0)


@pytest.mark.parametrize("turn", [30.0, 90.0, 150.0])
def test_no_curve_overshoots_a_corner(turn):
    way = np.array([np.cos(np.radians(turn)), np.sin(np.radians(turn)), 0.0])
    steps = np.arange(1.0, 9.0)[:, None]
    corner = np.concatenate([-steps[::-1] * [1.0, 0.0, 0.0], np.zeros((1, 3)), steps * way])
    between = 0.5 * (corner[1:] + corner[:-1])
    assert distances_to_curves(between[None], corner[None])[0] == pytest.approx(0.0, abs=1e-12)


def test_points_that_lie_on_each_other_are_met_by_chords():
    line = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [3.0, 0.0, 0.0]])
    assert distances_to_curves(np.array([[[1.0, 2.0, 0.0], [2.5, 2.0, 0.0]]]), line[None])[0] == pytest.approx(2.0)


@given(seed=st.integers(0, 2**32 - 1), count=st.integers(2, 8))
def test_distances_to_a_polyline_are_those_to_many_points_on_it(seed, count):
    random = np.random.default_rng(seed)
    line, points = random.uniform(-100.0, 100.0, (count, 3)), random.uniform(-200.0, 200.0, (7, 3))
    shares = np.linspace(0.0, 1.0, 2001)[:, None]
    dense = np.concatenate([first + shares * (last - first) for first, last in pairwise(line)])
    wanted = np.linalg.norm(points[:, None] - dense, axis=-1).min(axis=1)
    np.testing.assert_allclose(distances_to_polylines(points[None], line[None])[0], wanted, atol=0.1)


@pytest.mark.parametrize("beyond", [1e-3, 10.0, 40.0])
def test_beyond_the_ends_of_a_polyline_its_ends_count(beyond):
    line = np.array([[0.0, 0.0, 0.0], [100.0, 0.0, 0.0]])
    points = np.array([[100.0 + beyond, 0.0, 0.0], [-beyond, 0.0, 0.0]])
    np.testing.assert_allclose(distances_to_polylines(points[None], line[None])[0], beyond)


@given(seed=st.integers(0, 2**32 - 1), count=st.integers(1, 9))
def test_lengths_along_a_polyline_add_up(seed, count):
    points = np.random.default_rng(seed).normal(size=(count, 3))
    found = arc_length(points)
    assert found[0] == 0.0
    np.testing.assert_allclose(np.diff(found), np.linalg.norm(np.diff(points, axis=0), axis=1))


@given(seed=st.integers(0, 2**32 - 1), counts=st.lists(st.integers(4, 9), min_size=1, max_size=3))
def test_a_cubic_is_met_exactly_on_every_curve_however_unevenly_its_points_lie(seed, counts):
    random = np.random.default_rng(seed)
    lengths = [np.cumsum(random.uniform(0.2, 1.0, count)) for count in counts]
    cubics = [random.normal(size=(4, 2)) for _ in counts]
    places = [np.append(random.uniform(own[0], own[-1], 5), own[[0, -1]]) for own in lengths]

    def on(cubic, at):
        return np.vander(at, 4) @ cubic

    values = np.concatenate([on(cubic, own) for cubic, own in zip(cubics, lengths, strict=True)])
    wanted = np.concatenate([on(cubic, own) for cubic, own in zip(cubics, places, strict=True)])
    np.testing.assert_allclose(interpolate(lengths, values, places), wanted, atol=1e-9 * np.abs(values).max())


@given(seed=st.integers(0, 2**32 - 1), first=st.floats(0.1, 3.0), second=st.floats(0.1, 3.0))
def test_the_tangent_at_an_end_is_that_of_the_parabola_by_length_of_chord(seed, first, second):
    """Through a start, a point that is `first` away from it, and one that is so far away as it then says."""
    way, bend = np.random.default_rng(seed).normal(size=(2, 3))
    near = first * way
    far = (first + second) * way + second * (first + second) * 0.1 * bend
    steps = np.linalg.norm([near, far], axis=1)
    # p(s) = a s + b s^2 with p(|near|) = near and p(|far|) = far.
    a, _ = np.linalg.solve([[steps[0], steps[0] ** 2], [steps[1], steps[1] ** 2]], np.array([near, far]))
    start = np.random.default_rng(seed + 1).normal(size=3)
    found = end_tangents(start + np.array([np.zeros(3), near, far]))
    np.testing.assert_allclose(found, a / np.linalg.norm(a), atol=1e-9)


def test_several_polylines_have_each_its_own_lengths():
    random = np.random.default_rng(1)
    for counts in ((4, 4, 4), (4, 6, 5), (4, 6, 4)):
        lines = [random.normal(size=(count, 3)) for count in counts]
        for found, line in zip(arc_lengths(lines), lines, strict=True):
            np.testing.assert_allclose(found, arc_length(line))


@given(seed=st.integers(0, 2**32 - 1), counts=st.lists(st.integers(4, 9), min_size=1, max_size=3))
def test_points_keep_their_values_and_what_lies_between_the_first_ones_hangs_on_the_first_four(seed, counts):
    """Whatever the values are; the same at the other end."""
    random = np.random.default_rng(seed)
    lengths = [np.cumsum(random.uniform(0.2, 1.0, count)) for count in counts]
    values = [random.normal(size=(count, 2)) for count in counts]
    np.testing.assert_allclose(interpolate(lengths, np.concatenate(values), lengths), np.concatenate(values), atol=1e-9)
    for part, place in ((slice(None, 4), 0), (slice(-4, None), -2)):
        own = [length[part] for length in lengths]
        at = [0.5 * (length[place] + length[place + 1]) for length in lengths]
        some = np.concatenate([value[part] for value in values])
        found = interpolate(lengths, np.concatenate(values), [np.array([where]) for where in at])
        np.testing.assert_allclose(found, interpolate(own, some, [np.array([where]) for where in at]), atol=1e-9)


@pytest.mark.parametrize("size", [1e-3, 0.3, 1.0, 1e5])
def test_distances_grow_with_the_unit_of_length(size):
    random = np.random.default_rng(4)
    line, points = np.cumsum(random.uniform(0.1, 1.0, (3, 9, 3)), axis=1), random.uniform(0.0, 5.0, (3, 7, 3))
    for distances in (distances_to_polylines, distances_to_curves):
        np.testing.assert_allclose(distances(size * points, size * line), size * distances(points, line), rtol=1e-9)


@pytest.mark.parametrize("off", [0.3, 0.6])
def test_feet_are_found_from_points_far_inside_a_bend(off):
    """Where the foot on the chord is a good place to begin: there the steps towards the foot get shorter slowly."""
    parts, inside = np.linspace(0.0, 1.0, 65), np.linspace(0.02, 0.98, 97)
    curve, foot = helix(parts, 1.0, 2.0, 0.0), helix(inside, 1.0, 2.0, 0.0)
    found = distances_to_curves(((1.0 - off) * foot)[None], curve[None])
    np.testing.assert_allclose(found[0], off, rtol=0.0, atol=6e-7)


def test_points_at_the_height_of_corners_are_inside_or_outside_as_those_beside_them():
    """A diamond, and a step with level edges, by their edges in any order."""
    diamond = np.array([[0.0, -1.0], [2.0, 0.0], [0.0, 1.0], [-2.0, 0.0]])
    step = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 1.0], [2.0, 1.0], [2.0, 1.25], [0.0, 1.25]])
    for outline, inside, outside in (
        (diamond, [[-1.0, 0.0], [1.0, 0.0], [0.0, 0.9]], [[-3.0, 0.0], [3.0, 0.0], [-1.0, 1.0], [-1.0, -1.0]]),
        (step, [[1.0, 1.0], [3.0, 0.9], [1.0, 1.2], [1.9, 1.0]], [[-1.0, 1.0], [3.0, 1.1], [-1.0, 0.0], [5.0, 1.0]]),
    ):
        for order in (slice(None), slice(None, None, -1)):
            edges = outline[order], np.roll(outline[order], -1, axis=0)
            assert inside_edges(np.array(inside), *edges).all()
            assert not inside_edges(np.array(outside), *edges).any()
