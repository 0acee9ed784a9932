"""Curves are parted where they turn sharply and nowhere else, with points the closer the more they bend."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cadpanel.brep.curves.pieces import LARGEST_TURN, piece_through, smooth_pieces
from tests.drawn import circle, curve, line, polyline, wave

corners = st.integers(1, 5)


def turns(points):
    ways = np.diff(points, axis=0)
    ways /= np.linalg.norm(ways, axis=1)[:, None]
    return np.degrees(np.arccos(np.clip(np.sum(ways[1:] * ways[:-1], axis=1), -1.0, 1.0)))


@settings(max_examples=10)
@given(count=corners, angle=st.floats(25.0, 150.0))
def test_a_polyline_is_parted_at_each_of_its_corners(count, angle):
    """A zigzag that turns by so many degrees at each corner."""
    half = np.radians(0.5 * angle)
    ways = 500.0 * np.array([(np.cos(half), (-1.0) ** k * np.sin(half), 0.0) for k in range(count + 1)])
    places = np.concatenate([[(0.0, 0.0, 0.0)], np.cumsum(ways, axis=0)])
    pieces = smooth_pieces(polyline(*places))
    assert len(pieces) == count + 1
    np.testing.assert_allclose([piece.points[0] for piece in pieces], places[:-1], atol=1e-9)
    np.testing.assert_allclose([piece.points[-1] for piece in pieces], places[1:], atol=1e-9)
    # The curve's own ends are those of the first and of the last piece.
    assert [piece.own_ends for piece in pieces] == [(k == 0, k == count) for k in range(count + 1)]


@pytest.mark.parametrize("edge", [line((0, 0, 0), (3000, 500, 0)), wave(1), wave(4)], ids=["line", "wave", "waves"])
def test_a_smooth_curve_is_one_piece_whose_points_lie_on_it_and_turn_little(edge):
    (piece,) = smooth_pieces(edge)
    assert piece.own_ends == (True, True)
    assert piece.beside == 0.0
    assert (np.diff(piece.parameters) > 0.0).all()
    np.testing.assert_allclose(piece.at(piece.parameters), piece.points, atol=1e-9)
    assert turns(piece.points).max() < LARGEST_TURN


def test_a_closed_curve_has_no_ends_of_its_own():
    (piece,) = smooth_pieces(circle((0.0, 0.0, 0.0), 400.0))
    assert piece.own_ends == (False, False)
    np.testing.assert_allclose(piece.points[0], piece.points[-1], atol=1e-9)
    assert turns(piece.points).max() < LARGEST_TURN


def test_a_short_bend_of_a_long_curve_gets_points_of_its_own():
    """A hairpin of radius 5 mm in ten metres."""
    t = np.linspace(-np.pi / 2.0, np.pi / 2.0, 60)
    bend = 5.0 * np.stack([np.cos(t), np.sin(t), 0.0 * t], axis=1)
    legs = np.linspace(-5000.0, -100.0, 50)
    ends = [np.stack([x, np.full(50, 5.0 * side), 0.0 * x], axis=1) for x, side in ((legs, -1.0), (legs[::-1], 1.0))]
    for piece in smooth_pieces(curve(np.concatenate([ends[0], bend, ends[1]]))):
        assert turns(piece.points).max() < 2.0 * LARGEST_TURN


@given(count=st.integers(2, 12), seed=st.integers(0, 2**32 - 1))
def test_a_piece_through_points_passes_through_them(count, seed):
    points = np.cumsum(np.random.default_rng(seed).uniform(1.0, 50.0, (count, 3)), axis=0)
    piece = piece_through(points)
    np.testing.assert_allclose(piece.at(piece.parameters), points, atol=1e-9)
    np.testing.assert_array_equal(piece.points, points)


def test_points_on_a_line_give_the_line():
    t = np.linspace(0.0, 1.0, 7) ** 2
    piece = piece_through(np.outer(t, (300.0, 400.0, 0.0)))
    found = piece.at(np.linspace(0.0, 6.0, 50))
    np.testing.assert_allclose(found[:, 1], found[:, 0] * 4.0 / 3.0, atol=1e-9)
