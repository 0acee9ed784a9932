"""How far edges turn from the drawn ones, and how even seams run, measured on whole panels."""

from dataclasses import replace

import numpy as np
import pytest

from cadpanel.fitting.measures.edges import PanelEdges
from cadpanel.fitting.measures.turns import edge_turns, seam_unevenness
from cadpanel.geometry.frames import rotate_about
from tests.elsewhere import elsewhere
from tests.fitted_grids import fitted
from tests.known_panels import alone
from tests.shapes import folded_panel

NONE = np.zeros(3)


def about(axis, angle):
    """(3, 3) the rotation about a unit vector."""
    return np.array([rotate_about(np.array(axis), np.array(angle), one) for one in np.eye(3)]).T


def turned(axis, angle, **how):
    shape = folded_panel(**how)
    there = elsewhere(shape, about(axis, angle), NONE)
    return edge_turns(PanelEdges.of([there]), alone(shape))


@pytest.mark.parametrize("angle", [1e-3, 0.03, -0.1])
def test_a_flat_panel_that_turns_about_its_normal_turns_its_ends_and_not_its_free_sides(angle):
    found = turned((0.0, 0.0, 1.0), angle, chain="p", widths=(400.0,), turns=(0.0,))
    assert found == pytest.approx(np.array([[abs(angle), abs(angle), 0.0, 0.0]]), abs=1e-6)


def test_of_a_fold_that_turns_about_one_flanges_normal_that_flange_turns_by_the_angle():
    """Seen from the other flange, which stands nearly square to it, the cut leans about half as much."""
    found = turned((0.0, 0.0, 1.0), 0.05)
    assert found[0, :2] == pytest.approx([0.05, 0.05], rel=2e-2)


def test_a_panel_in_its_own_place_turns_nowhere():
    shape = folded_panel(cut_normals=[(1.0, 0.1, 0.05), (1.0, -0.2, -0.1)])
    assert edge_turns(PanelEdges.of([shape]), alone(shape)).max() <= 1e-3


def test_a_grid_that_is_moved_as_a_whole_runs_as_evenly():
    result = fitted("planar-quadrilateral")
    still = seam_unevenness(PanelEdges.of(result.shapes), result.reference)
    assert still.max() > 0.0
    shift = np.array([2.0, -1.0, 0.5])
    there = [elsewhere(shape, np.eye(3), shift) for shape in result.shapes]
    assert seam_unevenness(PanelEdges.of(there), result.reference) == pytest.approx(still, abs=0.3)


def test_without_seams_nothing_is_uneven():
    shape = folded_panel()
    assert seam_unevenness(PanelEdges.of([shape]), replace(alone(shape), seams=())).shape == (0,)
