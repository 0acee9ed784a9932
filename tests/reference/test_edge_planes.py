"""The planes in which drawn edges lie."""

from dataclasses import replace

import numpy as np
import pytest

from cadpanel.reference.edge_planes import edge_planes, turned_edges
from cadpanel.reference.model import Seam
from tests.known_panels import alone, moved
from tests.shapes import folded_panel

LEANING = [(1.0, 0.1, 0.05), (1.0, -0.2, -0.1)]


def panels(**how):
    return alone(folded_panel(**how))


def test_the_ends_of_a_fold_lie_in_their_cut_planes():
    """A fold bends far out of its chord: its ends tell how their planes lean."""
    reference = panels(cut_normals=LEANING)
    normals, lengths = edge_planes(reference.panels)
    for end, cut in enumerate(LEANING):
        unit = np.array(cut) / np.linalg.norm(cut)
        assert abs(normals[0, end] @ unit) == pytest.approx(1.0, abs=1e-4)
        line = reference.panels[0].ends[end]
        assert lengths[0, end] == pytest.approx(np.linalg.norm(np.diff(line, axis=0), axis=1).sum())


def test_a_straight_side_lies_in_the_plane_square_to_the_skin():
    reference = panels()
    normals, _ = edge_planes(reference.panels)
    for side in (2, 3):
        line, skin = reference.panels[0].edges[side], reference.panels[0].edge_normals[side]
        along = (line[-1] - line[0]) / np.linalg.norm(line[-1] - line[0])
        assert abs(normals[0, side] @ along) <= 1e-12
        assert abs(normals[0, side] @ skin[0]) <= 1e-9


def test_an_edge_that_bows_within_a_flat_skin_does_not_lean():
    """What hardly leaves its chord out of the skin says nothing of a lean, however far it bows in the skin."""
    reference = panels()
    (panel,) = reference.panels
    t = np.linspace(0.0, 1.0, 33)[:, None]
    line = np.concatenate([1000.0 * t, 60.0 * t * (1.0 - t), 1e-3 * np.sin(9.0 * t)], axis=1)
    edges = (line, *panel.edges[1:])
    skins = (np.tile([0.0, 0.0, 1.0], (33, 1)), *panel.edge_normals[1:])
    normals, _ = edge_planes([replace(panel, edges=edges, edge_normals=skins)])
    assert np.abs(normals[0, 0]) == pytest.approx([0.0, 1.0, 0.0], abs=1e-3)


def test_moving_the_drawing_moves_its_planes():
    turn, _ = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))
    turn *= np.linalg.det(turn)
    reference = panels(cut_normals=LEANING)
    there = moved(reference, turn, np.array([1e5, -2e5, 3e4]))
    for one, other in zip(edge_planes(reference.panels), edge_planes(there.panels), strict=True):
        assert other == pytest.approx(one @ turn.T if one.ndim == 3 else one, abs=1e-6)


def test_ends_and_edges_on_seams_may_not_turn_and_free_sides_may():
    one = panels()
    assert turned_edges(one).tolist() == [[True, True, False, False]]
    two = replace(one, panels=one.panels * 2, seams=(Seam(panels=(0, 1), edges=(3, 2), reversed=False),))
    assert turned_edges(two).tolist() == [[True, True, False, True], [True, True, True, False]]
