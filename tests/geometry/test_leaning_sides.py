"""The wall at a cylinder's side leans as the plane of its joint does, and every parallel skin ends on it."""

import numpy as np
import pytest

from cadpanel.geometry.edge_planes import turned_round
from cadpanel.geometry.sheet_checks import check_buildable
from cadpanel.geometry.vectors import cross
from cadpanel.geometry.volume import sheet_volume
from tests.joined import leaning
from tests.shapes import folded_panel

CLOSE = 1e-9
LEANS = np.tan(np.radians([-30.0, -10.0, -1.0, 0.0, 5.0, 10.0]))
"""Those of walls between panels that kink by up to 20 degrees, and by 60."""


def _rolled(radius: float):
    return folded_panel(chain="c", radius=radius, sweep=np.sign(radius), widths=(), turns=())


@pytest.mark.parametrize("radius", [900.0, -900.0])
@pytest.mark.parametrize("depth", [-20.0, 3.0])
@pytest.mark.parametrize("side", [0, 1])
@pytest.mark.parametrize("lean", LEANS)
def test_both_faces_and_all_between_end_on_the_plane(radius, depth, side, lean):
    shape = _rolled(radius)
    edge = f"side {side}"
    plane = leaning(shape, edge, 10.0, lean)
    cut = shape.cut_back({edge: plane}, depth)
    check_buildable(cut, abs(depth), "outer" if depth < 0.0 else "inner")
    for face in (cut, cut.offset(0.3 * depth), cut.offset(0.5 * depth).offset(0.5 * depth)):
        assert plane.beyond(face.edge(edge).corners) == pytest.approx(0.0, abs=CLOSE)
    square = cut.squared(depth)
    corners = [face.edge(edge).corners for face in (square, square.offset(depth))]
    assert plane.beyond(np.concatenate(corners)).max() == pytest.approx(0.0, abs=CLOSE)
    across = corners[1][0] - corners[0][0]
    assert cross(across, square.normals[-side]) == pytest.approx(np.zeros(3), abs=CLOSE)


@pytest.mark.parametrize("depth", [-20.0, 3.0])
def test_a_wall_leans_about_the_axis_alone_and_keeps_behind_a_plane_that_crosses_it(depth):
    shape = _rolled(900.0)
    plane = leaning(shape, "side 1", 10.0, 0.1, 0.01)
    cut = shape.cut_back({"side 1": plane}, depth)
    beyond = np.array([plane.beyond(face.edge("side 1").corners) for face in (cut, cut.offset(depth))])
    assert beyond.max() == pytest.approx(0.0, abs=CLOSE)
    # Along the joint it tapers as the plane turns; from face to face it does not.
    assert beyond[0] == pytest.approx(beyond[1], abs=CLOSE)


@pytest.mark.parametrize(("radius", "depth"), [(900.0, -3.0), (-900.0, -20.0), (60.0, -20.0)])
def test_two_sheets_on_either_side_of_a_plane_fill_the_whole_one(radius, depth):
    shape = _rolled(radius)
    plane = leaning(shape, "side 1", 0.2 * abs(radius), 0.4)
    parts = [shape.cut_back(walls, depth) for walls in ({"side 1": plane}, {"side 0": turned_round(plane)})]
    volumes = [sheet_volume(part, -depth, "outer") for part in (*parts, shape)]
    assert sum(volumes[:2]) == pytest.approx(volumes[2], rel=1e-12)
