"""Arcs follow flat curves within the tolerance that is asked for, without a kink."""

import math
from dataclasses import dataclass, field

import numpy as np
import pytest

from cadpanel.geometry.biarcs import all_but_straight, arc_chains, arc_circle, arc_contour_area, off_arcs
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


@dataclass(frozen=True)
class Spiral:
    """A curve that bends more and more, drawn at some size; a curve that tells how often it was asked for."""

    size: float
    asked: list[int] = field(default_factory=list)

    @property
    def start(self):
        return self.points(np.zeros((1, 1)))[:, 0]

    @property
    def curved(self):
        return np.array([True])

    def __len__(self):
        return 1

    def take(self, rows):
        self.asked.append(len(rows))
        return self

    def points(self, u):
        return self.size * np.stack([np.exp(u) * np.cos(2.0 * u), np.exp(u) * np.sin(2.0 * u)], axis=-1)

    def velocities(self, u):
        x, y = np.moveaxis(self.points(u), -1, 0)
        return np.stack([x - 2.0 * y, y + 2.0 * x], axis=-1)


@pytest.mark.parametrize("scale", [2.0**-12, 2.0**12])
@pytest.mark.parametrize("chord", [1.0, 1e-2, 1e-4])
def test_a_larger_curve_within_a_larger_tolerance_has_the_same_arcs(scale, chord):
    (arcs,), (larger,) = (arc_chains(Spiral(10.0 * by), chord * by) for by in (1.0, scale))
    assert larger == pytest.approx(arcs * [scale, scale, 1.0])


def test_arcs_are_not_many_more_than_are_needed_and_found_at_once():
    """The error falls with the cube of their number, so that this times the root of the tolerance is a constant."""
    chords = 10.0 ** np.linspace(-4.0, -7.0, 40)
    beside = []
    for chord in chords:
        curve = Spiral(10.0)
        beside.append(len(arc_chains(curve, chord)[0]) * np.cbrt(chord))
        assert len(curve.asked) <= 6
    assert max(beside) <= 1.15 * min(beside)


def turned(angle, x, y):
    """Points (..., 2) turned by angles."""
    return np.stack([x * np.cos(angle) - y * np.sin(angle), x * np.sin(angle) + y * np.cos(angle)], axis=-1)


@dataclass(frozen=True)
class TwoArcs(Spiral):
    """Two arcs that meet without a kink and turn by two angles, each over half of u; tangents at all ends are 10 mm."""

    first: float = 1.0
    second: float = 1.0

    def _angles(self, u):
        return self.first * np.clip(2.0 * u, 0.0, 1.0), self.second * np.clip(2.0 * u - 1.0, 0.0, 1.0)

    def points(self, u):
        places = np.zeros(2)
        before = np.zeros_like(u)
        for whole, angle in zip((self.first, self.second), self._angles(u), strict=True):
            radius = self.size / np.tan(0.5 * whole)
            places = places + radius * turned(before, np.sin(angle), 1.0 - np.cos(angle))
            before = before + angle
        return places

    def velocities(self, u):
        return turned(sum(self._angles(u)), 1.0, 0.0)


@pytest.mark.parametrize(
    ("first", "second"), [(2.5, 0.2), (0.2, 2.5), (2.8, -0.4), (-0.5, 2.0), (1.0, 1.0), (0.3, 0.2), (2.8, 2.6)]
)
def test_a_curve_that_is_two_arcs_becomes_these_two(first, second):
    """One stretch is enough, as every point is held against its own arc."""
    curve = TwoArcs(10.0, first=first, second=second)
    (arcs,) = arc_chains(curve, 1e-6)
    assert arcs[:, :2] == pytest.approx(curve.points(np.array([[0.0, 0.5]]))[0], abs=1e-9)
    assert arcs[:, 2] == pytest.approx(np.tan(0.25 * np.array([first, second])), abs=1e-9)


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


def test_beyond_a_corner_the_distance_is_that_from_it():
    """However little beyond it, on the line along which an edge arrives or leaves."""
    triangle = np.array([[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 3.0, 0.0]])
    for little in (0.01, 0.1, 1.0):
        places = np.array([[4.0 + little, 0.0], [-little, 0.0], [0.0, 3.0 + little], [0.0, -little]])
        assert off_arcs(triangle, places) == pytest.approx(little)
    beside = np.array([[0.2, -0.1], [3.8, -0.1], [-0.1, 0.2], [-0.1, 2.8]])
    assert off_arcs(triangle, beside) == pytest.approx(0.1)


@pytest.mark.parametrize(("chord", "bow"), [(0.1, 1e-6), (10.0, 1e-6), (1000.0, 3e-4), (1e4, 3e-2)])
def test_an_arc_that_bows_by_less_than_can_be_told_is_a_line(chord, bow):
    """By 1e-6 mm, or on long ones by what puts its centre too far away."""
    stop = chord * np.array([0.6, 0.8])
    for way in (1.0, -1.0):
        assert all_but_straight(np.zeros(2), stop, way * 0.99 * bow / (0.5 * chord))
        assert not all_but_straight(np.zeros(2), stop, way * 1.01 * bow / (0.5 * chord))


def test_distances_from_a_closed_chain_are_those_from_many_points_of_it():
    vertices = np.array([[0.0, 0.0, 0.3], [100.0, 20.0, -0.5], [130.0, 120.0, 0.0], [10.0, 90.0, 0.8]])
    near = drawn(vertices, vertices[0, :2], per_arc=4001)
    places = np.random.default_rng(5).uniform(-80.0, 200.0, (300, 2))
    wanted = np.linalg.norm(places[:, None] - near, axis=-1).min(axis=1)
    assert off_arcs(vertices, places) == pytest.approx(wanted, abs=1e-3)
