"""What is seen of a fit: deviations as they are measured, references as large as they are, seams of what is shown."""

import numpy as np
import pytest

from cadpanel.delivery.page.scene import scene_of
from tests.pages import NAMES, delivery, scene, strange


def test_deviations_over_the_mesh_reach_as_far_as_those_that_are_measured():
    measured = strange().measures.max_deviation
    assert [np.abs(panel.deviation).max() for panel in scene().panels] == pytest.approx(measured, rel=0.1)
    assert all((np.abs(panel.deviation) <= most).all() for panel, most in zip(scene().panels, measured, strict=True))


def test_the_reference_lies_outside_where_its_deviation_is_above_0():
    for panel in scene().panels:
        for way in (np.argmin, np.argmax):
            place = int(way(panel.deviation))
            ghost = panel.ghost.points
            there = ghost[np.linalg.norm(ghost - panel.points[place], axis=1).argmin()]
            outward = panel.points[place] - panel.other[place]
            assert np.sign((there - panel.points[place]) @ outward) == np.sign(panel.deviation[place])


def test_a_ghost_is_as_large_as_the_panel_and_keeps_to_its_outline():
    for panel, sheet in zip(scene().panels, delivery().panels, strict=True):
        a, b, c = (panel.ghost.points[panel.ghost.triangles[:, corner]] for corner in range(3))
        area = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()
        assert area == pytest.approx(sheet.area, rel=0.04)
        assert 30 < panel.ghost.outline <= 64


def test_only_panels_that_are_asked_for_are_shown_with_their_seams():
    told = delivery()
    last = scene_of(strange(), [told.panels[2].shape], [told.panels[2].other])
    assert [panel.name for panel in last.panels] == [NAMES[2]]
    assert [seam.panels for seam in last.seams] == [(NAMES[1], NAMES[2])]
