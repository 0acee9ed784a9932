"""Profiles of seams: what is known of two chains place by place, and nothing beyond what is largest along the whole."""

from __future__ import annotations

import numpy as np
import pytest

from cadpanel.fitting.measures.edges import PanelEdges
from cadpanel.geometry.end_curves import as_chains, seam_gap
from cadpanel.geometry.seam_profiles import profiles
from tests.shapes import folded_panel

STEPS = 8


def ends(panel, edge=0):
    edges = PanelEdges.of([panel])
    return edges.curves[edges.batch[0, edge]].take(np.array([edges.row[0, edge]])), edges.centre


def test_a_panel_and_its_parallel_are_one_step_apart_all_along():
    panel = folded_panel()
    (first, here), (second, there) = ends(panel), ends(panel.offset(2.0))
    origin = here[None]
    found = profiles(as_chains(first, 0.0 * origin), as_chains(second, here - there + 0.0 * origin), STEPS)
    assert found.step == pytest.approx(2.0, abs=1e-6)
    assert found.gap == pytest.approx(2.0, abs=1e-6)
    assert np.abs(found.width).max() < 1e-3
    assert np.abs(found.kink).max() < 1e-6


def test_a_profile_follows_the_edge_from_end_to_end_and_nowhere_exceeds_the_whole_seam():
    first, _ = ends(folded_panel(sweep=0.9))
    second, _ = ends(folded_panel(sweep=0.8))
    origin = np.zeros((1, 3))
    found, whole = profiles(as_chains(first, origin), as_chains(second, origin), STEPS), seam_gap(first, second)
    assert found.points[:, [0, -1]] == pytest.approx(first.corners[:, [0, -1]], abs=1e-9)
    assert found.points.shape == (1, STEPS * first.patches + 1, 3)
    for values, most in ((found.gap, whole.gap), (found.kink, whole.kink), (found.step, whole.step)):
        assert values.max() > 0.0
        assert values.max() <= most.max() * (1.0 + 1e-9)
