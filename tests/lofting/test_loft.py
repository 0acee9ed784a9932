"""Lofts between curves of surfaces that are known are these surfaces; what must not change a loft does not."""

from functools import cache

import numpy as np
import pytest
from scipy.interpolate import BSpline

from cadpanel.errors import LoftError
from cadpanel.lofting.kinds import Flat, Round
from cadpanel.lofting.loft import loft
from cadpanel.lofting.rail import Stretch, chained, stretch_through
from tests.known_rails import CONE, CYLINDER, PLANE, TORSE, TWISTED, off_torse, rails

# The figures: warp in radians, distance as a part of the size.
WARP, OFF = 1e-6, 1e-6
# Rails that begin and end at other rulings than their partners.
SHIFTED = {"first": (0.0, 1.5), "second": (0.2, 1.7)}
CUBE = np.array([[0.0, 0.0, 0.0], [100.0, 0.0, 10.0], [100.0, 100.0, 0.0]])


@cache
def spanned(name):
    known = {"torse": TORSE, "cone": CONE, "cylinder": CYLINDER, "plane": PLANE, "twisted": TWISTED}[name]
    return loft(*rails(known, **SHIFTED))


def points_of(surface):
    for piece in surface.pieces:
        a, b = piece.jets(np.linspace(0.0, 1.0, 101))
        yield piece, np.concatenate([(1.0 - v) * a.point + v * b.point for v in (0.0, 0.3, 1.0)])


@pytest.mark.parametrize("name", ["torse", "cone", "cylinder", "plane"])
def test_a_developable_surface_comes_back_without_warp(name):
    surface = spanned(name)
    assert surface.exact
    assert surface.max_warp < WARP
    assert surface.off < OFF * surface.size
    assert surface.flat[1].length < 1e-9 * surface.size
    # The smallest case that fails: rails between which there is none.
    assert spanned("twisted").max_warp > 1e-3


def test_a_fan_too_narrow_to_be_cut_is_left_out():
    a, b = rails(TORSE, second=(4e-6, 1.5))
    surface = loft(a, b)
    assert [piece.apex for piece in surface.pieces] == [None]
    assert 1e-8 < surface.max_warp < 1e-4
    assert len(loft(*rails(TORSE, second=(4e-4, 1.5))).pieces) == 2


def test_the_tangent_surface_of_a_helix_comes_back_itself():
    surface = spanned("torse")
    fans, smooth = [piece.apex for piece in surface.pieces], surface.pieces[1]
    assert fans == [1, None, 0]
    points = next(points for piece, points in points_of(surface) if piece is smooth)
    assert off_torse(points).max() < OFF * surface.size
    assert off_torse(points + np.array([0.0, 0.0, 1.0])).min() > 0.5


def test_cones_cylinders_and_planes_are_told_by_their_numbers():
    (cone,) = [kind for kind in spanned("cone").kinds if kind is not None]
    assert isinstance(cone, Round)
    assert cone.half_angle == pytest.approx(np.arctan(0.2), abs=1e-8)
    apex = cone.origin - cone.radius / np.tan(cone.half_angle) * cone.axis
    assert np.abs(apex - np.array([0.0, 0.0, 500.0])).max() < 1e-5
    (cylinder,) = [kind for kind in spanned("cylinder").kinds if kind is not None]
    assert isinstance(cylinder, Round)
    assert cylinder.word == "cylinder"
    assert cylinder.radius == pytest.approx(100.0, abs=1e-7)
    assert [type(kind) for kind in spanned("plane").kinds] == [Flat]
    assert all(kind is None for kind in spanned("twisted").kinds)


def test_moving_scaling_turning_round_and_swapping_the_rails_change_nothing():
    surface = spanned("twisted")
    turn, _ = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))
    turn *= np.sign(np.linalg.det(turn))
    a, b = rails(TWISTED, **SHIFTED)
    moved = [BSpline(rail.t, 7.0 * np.asarray(rail.c) @ turn + np.array([1e3, -5e3, 2e2]), rail.k) for rail in (a, b)]
    backwards = b(np.linspace(b.t[0], b.t[-1], 321)[::-1])
    for other, scale in ((loft(*moved), 7.0), (loft(b, a), 1.0), (loft(a, backwards), 1.0)):
        assert other.size == pytest.approx(scale * surface.size, rel=0.5)
        assert other.max_warp == pytest.approx(surface.max_warp, rel=1e-5)
        assert other.flat[1].surface == pytest.approx(scale**2 * surface.flat[1].surface, rel=1e-6)


def test_hoschek_s_distance_finds_the_same_developable_surface():
    a, b = rails(TORSE, **SHIFTED)
    other = loft(a, b, distance="tangent-planes")
    assert other.exact
    assert other.flat[1].surface == pytest.approx(spanned("torse").flat[1].surface, rel=1e-9)


def test_opposite_of_a_line_a_triangle_lies_between_two_cones():
    """A quarter of a circle under a line: the tangent is parallel to it at one place, where all its rulings meet."""
    turn = np.linspace(0.0, 0.5 * np.pi, 41)
    arc = np.stack([500.0 * np.cos(turn), 500.0 * np.sin(turn), 0.0 * turn], axis=-1)
    line = np.array([[500.0, 0.0, 300.0], [0.0, 500.0, 300.0]])
    for surface, apexes in ((loft(arc, line), [1, 0, 1]), (loft(line, arc), [0, 1, 0])):
        assert [piece.apex for piece in surface.pieces] == apexes
        assert isinstance(surface.kinds[1], Flat)
        assert surface.exact
        assert surface.max_warp < WARP
        assert surface.pieces[1].shares[0, apexes[0] ^ 1] == pytest.approx(0.5, abs=1e-6)


def test_a_quarter_of_a_rounded_rectangle_and_of_a_circle_are_spanned_by_triangles_and_a_cone():
    """The lines begin and end along the circle's tangents there, so that the rulings between the ends have no warp."""

    def arc(x, y, radius, z):
        w, (u, v) = 0.5**0.5, (x + radius, y + radius)
        poles = np.array([[u, y, z, 1.0], [w * u, w * v, w * z, w], [x, v, z, 1.0]])
        return Stretch(2, np.repeat([0.0, 1.0], 3), poles)

    lines = [
        stretch_through(np.array(ends)) for ends in ([[400.0, 0, 0], [400, 200, 0]], [[300, 300, 0], [0, 300, 0.0]])
    ]
    low = chained("low", [lines[0], arc(300.0, 200.0, 100.0, 0.0), lines[1]])
    surface = loft(chained("high", [arc(0.0, 0.0, 300.0, 300.0)]), low)
    assert [piece.apex for piece in surface.pieces] == [0, None, 0]
    assert surface.pieces[0].shares[1, 1] == pytest.approx(200.0 / low.length, abs=1e-6)
    assert surface.exact
    assert surface.max_warp < WARP


CUSP = BSpline(np.repeat([0.0, 1.0], 4), np.array([[0.0, 0, 0], [900, 400, 0], [0, 400, 0], [900, 0, 0]]), 3)
AXIS = np.array([[0.0, 0.0, 0.0], [900.0, 0.0, 0.0]])


@pytest.mark.parametrize(
    ("a", "b", "said"),
    [
        (CUSP, AXIS + np.array([0.0, 0.0, 500.0]), r"stands still at \(450\.0, 300\.0, 0\.0\) mm"),
        (AXIS, AXIS + np.array([2000.0, 0.0, 0.0]), "lie on one line, and span nothing"),
        (
            AXIS,
            1e-7 * AXIS + np.array([0.0, 9.0, 0.0]),
            "10000000 times as long .*: cut it into parts, or name",
        ),
    ],
)
def test_rails_that_span_nothing_are_refused_with_what_helps(a, b, said):
    with pytest.raises(LoftError, match=said):
        loft(a, b)


def test_lines_and_arcs_that_meet_smoothly_become_planes_and_cones():
    """A bend between two flanges, narrowing towards an apex over the middle of its arc."""
    weight, apex = np.cos(np.pi / 6.0), np.array([100.0, -50.0 * np.sqrt(3.0), 900.0])
    corner = np.array([[0.0, 0.0, 0.0], [100.0, 0.0, 0.0], [150.0, 0.0, 0.0]])
    end = corner[2] + 50.0 * np.array([0.5, -(0.75**0.5), 0.0])
    arc = Stretch(2, np.repeat([0.0, 1.0], 3), np.array([[*p, 1.0] for p in (corner[1], corner[2], end)]))
    arc.poles[1] *= weight
    flat = [stretch_through(np.array(ends)) for ends in (corner[:2], (end, end + 1.6 * (end - corner[2])))]
    low = [flat[0], arc, flat[1]]
    high = [Stretch(s.degree, s.knots, 0.6 * s.poles + 0.4 * s.poles[:, 3:] * np.append(apex, 1.0)) for s in low]
    surface = loft(chained("low", low), chained("high", high))
    assert [kind.word for kind in surface.kinds if kind is not None] == ["plane", "cone", "plane"]
    assert surface.max_warp < WARP
    # Where the other rail is one spline through the same places there are no such places to cut at.
    points = chained("high", high).at(np.linspace(0.0, 1.0, 60)).point
    assert len(loft(chained("low", low), points).segments) == 1


def test_corners_are_paired_with_corners_and_one_alone_is_refused_with_its_place():
    bent = [chained("bent", [stretch_through(CUBE[:2] + up), stretch_through(CUBE[1:] + up)]) for up in (0.0, 50.0)]
    surface = loft(*bent)
    assert [segment.pieces[0].apex for segment in surface.segments] == [None, None]
    assert [type(kind) for kind in surface.kinds] == [Flat, Flat]
    with pytest.raises(LoftError, match=r"at \(100\.0, 0\.0, 10\.0\) mm has none to go with it"):
        loft(bent[0], CUBE[[0, 2]] + 50.0)


@pytest.mark.parametrize(
    ("a", "b", "said"),
    [
        (CUBE[:2], np.array([[50.0, -50.0, 5.0], [50.0, 50.0, 5.0]]), r"meet at \(50\.0, 0\.0, 5\.0\) mm"),
        (CUBE[:2], np.array([[0.0, 9.0, 0.0], [0.0, 10.0, 0.0]]), "times as long"),
        (CUBE[[0, 1, 2, 0]], CUBE[:2] + 9.0, "closes at"),
    ],
)
def test_rails_between_which_nothing_can_be_spanned_are_refused(a, b, said):
    with pytest.raises(LoftError, match=said):
        loft(a, b)
