"""Which seams are drawn level: rings that close in one plane, and cuts that were asked to be level."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from cadpanel.reference.level_seams import level_edges, rings
from cadpanel.reference.model import Seam
from cadpanel.reference.settings import ReferenceSettings
from tests.columns import column, turned
from tests.delivered import strip

TURN = Rotation.from_rotvec([0.4, -0.7, 0.2]).as_matrix()


def test_both_rings_of_a_leaning_column_lie_in_planes_square_to_it() -> None:
    level = level_edges(turned(column(rows=3, columns=4), TURN))
    found = sorted(zip(level.panels.tolist(), level.edges.tolist(), strict=True))
    assert found == sorted([(p, 1) for p in range(8)] + [(p, 0) for p in range(4, 12)])
    heights = np.where(level.panels + 4 * level.edges < 8, 1500.0, 3000.0)
    assert np.abs(level.normals @ TURN[:, 2]) == pytest.approx(1.0)
    assert level.points @ TURN[:, 2] == pytest.approx(heights)


def test_a_ring_of_two_panels_closes_and_one_that_lacks_a_seam_does_not() -> None:
    whole = column(rows=2, columns=2)
    assert [sorted(ring) for ring in rings(whole)] == [[(0, 1), (1, 1), (2, 0), (3, 0)]]
    for lacking in range(len(whole.seams)):
        open_ = replace(whole, seams=(*whole.seams[:lacking], *whole.seams[lacking + 1 :]))
        assert rings(open_) == []


def test_a_ring_that_waves_is_not_level_and_nor_is_one_with_an_edge_on_two_seams() -> None:
    assert len(rings(column(wave=20.0))) == 2
    assert not len(level_edges(column(wave=20.0)).panels)
    whole = column(rows=2)
    assert not rings(replace(whole, seams=(*whole.seams, Seam(panels=(0, 5), edges=(1, 0), reversed=False))))


def test_the_cuts_of_a_strip_are_level_where_they_were_asked_to_be() -> None:
    assert not len(level_edges(strip()).panels)
    asked = replace(strip(), settings=ReferenceSettings(divide=3, seams="level"))
    level = level_edges(asked)
    assert list(zip(level.panels.tolist(), level.edges.tolist(), strict=True)) == [(0, 1), (1, 0), (1, 1), (2, 0)]
    assert (level.normals == [0.0, 0.0, 1.0]).all()
    drawn = asked.panels[1].edges[1][:, 2]
    assert level.points[2, 2] == pytest.approx(0.5 * (drawn.min() + drawn.max()))
