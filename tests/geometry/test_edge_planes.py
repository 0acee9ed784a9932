"""The plane of a seam halves the angle between two skins, holds the seam, and is the same from either side."""

import numpy as np
import pytest

from cadpanel.errors import PanelError
from cadpanel.geometry.edge_planes import farthest, seam_plane
from tests.joined import hexagons, polygon, quadrilaterals, seams
from tests.shapes import folded_panel, moved

CLOSE = 1e-9


@pytest.mark.parametrize("panels", [quadrilaterals(), quadrilaterals(skew=0.4), hexagons()])
def test_it_holds_the_seam_and_halves_the_angle(panels):
    for seam in seams(panels):
        one, other = (panels[i] for i in seam.panels)
        plane = seam_plane((one, other), seam.edges)
        assert max(farthest(plane, panel, edge) for panel, edge in zip((one, other), seam.edges, strict=True)) < CLOSE
        assert plane.normal @ one.normal == pytest.approx(-(plane.normal @ other.normal), abs=1e-12)
        assert plane.beyond(one.outline.mean(axis=0)) < 0.0 < plane.beyond(other.outline.mean(axis=0))


@pytest.mark.parametrize("panels", [quadrilaterals(), hexagons()])
def test_it_does_not_matter_which_panel_is_the_first(panels):
    for seam in seams(panels):
        one, other = (panels[i] for i in seam.panels)
        there, back = seam_plane((one, other), seam.edges), seam_plane((other, one), seam.edges[::-1])
        assert there.normal == pytest.approx(-back.normal, abs=1e-12)
        assert there.beyond(back.point) == pytest.approx(0.0, abs=CLOSE)


def test_between_bent_edges_it_is_the_mean_of_the_planes_that_cut_them():
    lean = np.radians(3.0)
    one = folded_panel(cut_normals=((1.0, 0.0, 0.0), (np.cos(lean), np.sin(lean), 0.0)))
    other = moved(folded_panel(), (1000.5, 0.0, 0.0))
    plane = seam_plane((one, other), ("end 1", "end 0"))
    assert plane.normal == pytest.approx([np.cos(0.5 * lean), np.sin(0.5 * lean), 0.0], abs=1e-12)
    heights = np.concatenate([plane.beyond(panel.corners()[end]) for panel, end in ((one, 1), (other, 0))])
    assert heights.max() == pytest.approx(-heights.min(), abs=CLOSE)


def test_a_straight_edge_takes_the_plane_of_a_bent_one():
    bent = folded_panel()
    ends = bent.corners()[1, [0, 1]]
    flat = polygon("F", np.array([ends[1], ends[1] + [500.0, 0.0, 0.0], ends[0] + [500.0, 0.0, 0.0], ends[0]]))
    plane = seam_plane((bent, flat), ("end 1", "edge 3"))
    assert plane.normal == pytest.approx([1.0, 0.0, 0.0], abs=1e-12)


def test_panels_that_fold_back_on_each_other_are_refused():
    flat = polygon("A", np.array([[0.0, 0.0, 0.0], [1000.0, 0.0, 0.0], [1000.0, 1000.0, 0.0], [0.0, 1000.0, 0.0]]))
    lifted = flat.outline * [1.0, 1.0, 0.0] + np.array([0.0, 0.0, 1.0]) * flat.outline[:, 1:2] * 0.05
    back = polygon("B", lifted[::-1])
    with pytest.raises(PanelError, match=r"Panel 'A': it folds back on 'B' at its edge 0"):
        seam_plane((flat, back), ("edge 0", "edge 2"))
