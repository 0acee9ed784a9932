"""The pieces of edges by which their turn is told."""

import numpy as np
import pytest

from cadpanel.features.edge_pieces import SHORT, boundary_points, edge_pieces, places, turns
from cadpanel.features.panel_edges import chain_edges, polygon_edges


def test_an_arc_is_told_in_two_halves_and_all_else_from_corner_to_corner():
    pieces = edge_pieces(chain_edges((False, True, False)))
    # Corners 0 to 3 on end 0, 4 to 7 on end 1; the middle of each arc is the second of its three points.
    ends = [[0, 1], [1, -2], [-2, 2], [2, 3], [4, 5], [5, -5], [-5, 6], [6, 7]]
    assert pieces.points.tolist() == [*ends, [0, 4], [3, 7]]
    assert pieces.edge.tolist() == [0, 0, 0, 0, 1, 1, 1, 1, 2, 3]


def test_a_polygon_has_one_piece_an_edge():
    pieces = edge_pieces(polygon_edges(5))
    assert pieces.points.tolist() == [[0, 1], [1, 2], [2, 3], [3, 4], [4, 0]]
    assert pieces.edge.tolist() == [0, 1, 2, 3, 4]


def test_arc_points_stand_after_all_corners():
    assert places(np.array([0, 3, -1, -2]), 8).tolist() == [0, 3, 8, 9]


def test_an_edge_lists_its_corners_and_then_its_arc_points():
    _, end, *_ = chain_edges((False, True))
    assert boundary_points(end) == [3, 4, 5, -4, -5, -6]


@pytest.mark.parametrize("angle", [0.0, 1e-3, 0.2, -0.2])
def test_a_piece_turns_by_its_angle_with_the_plane(angle):
    ends = np.array([[[1.0, 2.0, 3.0], [1.0 + 4.0 * np.cos(angle), 2.0 + 4.0 * np.sin(angle), 3.0]]])
    assert np.arcsin(turns(ends, np.array([[0.0, 1.0, 0.0]]), np.array([5.0]))) == pytest.approx([angle], abs=1e-12)


def test_a_short_piece_counts_as_long_as_can_be_seen_to_lean():
    ends = np.array([[[0.0, 0.0, 0.0], [0.0, 1e-3, 0.0]]])
    assert turns(ends, np.array([[0.0, 1.0, 0.0]]), np.array([2.0])) == pytest.approx([1e-3 / (SHORT * 2.0)])
