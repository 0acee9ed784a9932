"""Arcs follow flat curves within the tolerance that is asked for, without a kink."""

import math

import numpy as np
import pytest

from cadpanel.geometry.biarcs import arc_chains, arc_circle, arc_contour_area, off_arcs
from cadpanel.geometry.flat_sizes import flat_sizes
from cadpanel.geometry.unroll import unroll
from tests.chains import CHAINS
from tests.flat_panels import panels
from tests.shapes import folded_panel, random_panel


def drawn(vertices, stop, per_arc=20):
    """Points on a chain of arcs, by turning the chord's half."""
    ends = np.vstack([vertices[:, :2], stop])
    found = []
    for (x, y, bulge), after in zip(vertices, ends[1:], strict=True):
        start = np.array([x, y])
        if bulge == 0.0:
            found.append(start + np.linspace(0.0, 1.0, per_arc)[:, None] * (after - start))
            continue
        centre, radius = arc_circle(start, after, bulge)
        begin = math.atan2(*(start - centre)[::-1])
        angles = begin + np.linspace(0.0, 4.0 * math.atan(bulge), per_arc)
        found.append(centre + radius * np.stack([np.cos(angles), np.sin(angles)], axis=-1))
    return np.concatenate(found)


def apart(points, curve):
    """Largest distance of points from a densely sampled curve, counted to its chords."""
    dense = curve.points(np.linspace(0.0, 1.0, 4001)[None])[0]
    near = np.clip(np.linalg.norm(points[:, None] - dense, axis=-1).argmin(axis=1), 1, len(dense) - 2)
    ways = dense[near + 1] - dense[near - 1]
    to = points - dense[near]
    return np.abs(ways[:, 0] * to[:, 1] - ways[:, 1] * to[:, 0]).max() / np.linalg.norm(ways, axis=-1).min()


@pytest.mark.parametrize("chord", [1.0, 0.01, 0.001])
@pytest.mark.parametrize("seed", range(4))
def test_arcs_stay_within_the_chord_tolerance(chord, seed):
    curves = unroll(random_panel(seed, half_angle=0.05, mitre=0.5)).curves
    for row, vertices in enumerate(arc_chains(curves, chord)):
        curve = curves.take(slice(row, row + 1))
        if curves.curved[row]:
            assert apart(drawn(vertices, curve.stop), curve) <= chord + 1e-6
        else:
            assert vertices[:, 2] == pytest.approx(0.0)


def test_a_finer_tolerance_takes_more_arcs_and_a_coarse_one_few():
    curves = unroll(random_panel(1, half_angle=0.05, mitre=0.5)).curves
    counts = [sum(map(len, arc_chains(curves, chord))) for chord in (1.0, 0.01, 1e-4)]
    assert counts[0] < counts[1] < counts[2]
    assert counts[1] < 40


@pytest.mark.parametrize("name", sorted(CHAINS))
def test_arcs_meet_without_a_kink_inside_of_every_curve(name):
    for shape in panels(name, 8)[:2]:
        curves = unroll(shape).curves
        for row, vertices in enumerate(arc_chains(curves, 1e-3)):
            ends = np.vstack([vertices[:, :2], curves.stop[row]])
            chords = np.diff(ends, axis=0)
            ways = np.arctan2(chords[:, 1], chords[:, 0])
            half = 2.0 * np.arctan(vertices[:, 2])
            kinks = (ways[1:] - half[1:]) - (ways[:-1] + half[:-1])
            assert np.abs(np.angle(np.exp(1j * kinks))).max(initial=0.0) < 1e-9


def test_a_straight_edge_of_a_bend_is_one_segment():
    curves = unroll(folded_panel()).curves
    assert [len(vertices) for vertices in arc_chains(curves, 0.01)] == 8 * [1]


def test_the_area_inside_arcs_is_that_inside_the_curves_but_for_the_tolerance():
    pattern = unroll(random_panel(3, half_angle=0.05, mitre=0.5))
    (size,) = flat_sizes([pattern])
    bent = sum(length for length, curved in zip(size.pieces, pattern.curves.curved, strict=True) if curved)
    for chord in (0.1, 1e-3):
        area = arc_contour_area(np.concatenate(arc_chains(pattern.curves, chord)))
        assert abs(area - size.area) <= chord * bent


def test_two_half_circles_enclose_a_disc():
    disc = np.array([[1.0, 0.0, 1.0], [-1.0, 0.0, 1.0]])
    assert arc_contour_area(disc) == pytest.approx(math.pi)
    assert arc_contour_area(disc[::-1] * [1.0, 1.0, -1.0]) == pytest.approx(-math.pi)
    centre, radius = arc_circle(np.array([2.0, 0.0]), np.array([0.0, 2.0]), math.tan(math.pi / 8.0))
    assert centre == pytest.approx([0.0, 0.0], abs=1e-12)
    assert radius == pytest.approx(2.0)


def test_distances_from_a_closed_chain_are_those_from_many_points_of_it():
    vertices = np.array([[0.0, 0.0, 0.3], [100.0, 20.0, -0.5], [130.0, 120.0, 0.0], [10.0, 90.0, 0.8]])
    near = drawn(vertices, vertices[0, :2], per_arc=4001)
    places = np.random.default_rng(5).uniform(-80.0, 200.0, (300, 2))
    wanted = np.linalg.norm(places[:, None] - near, axis=-1).min(axis=1)
    assert off_arcs(vertices, places) == pytest.approx(wanted, abs=1e-3)
