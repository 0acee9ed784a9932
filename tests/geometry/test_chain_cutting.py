"""A chain's walls stand in the planes that were given, on both faces of the sheet, and the panel stays buildable."""

import numpy as np
import pytest

from cadpanel.errors import PanelError
from cadpanel.geometry.sheet_checks import check_buildable, other_face
from cadpanel.geometry.vectors import cross
from tests.joined import leaning
from tests.shapes import folded_panel, random_panel

CLOSE = 1e-9
EDGES = ("end 0", "end 1", "side 0", "side 1")


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("depth", [-3.0, 20.0])
@pytest.mark.parametrize("lean", [-0.1, 0.1])
def test_walls_of_flat_sides_and_of_ends_stand_in_their_planes(seed, depth, lean):
    shape = random_panel(seed)
    planes = {edge: leaning(shape, edge, 10.0, lean, 0.01) for edge in EDGES}
    cut = shape.cut_back(planes, depth)
    check_buildable(cut, abs(depth), "outer" if depth < 0.0 else "inner")
    for face in (cut, cut.offset(0.5 * depth), cut.offset(depth)):
        for edge in EDGES:
            assert planes[edge].beyond(face.edge(edge).corners) == pytest.approx(0.0, abs=CLOSE)


@pytest.mark.parametrize("half_angle", [-0.05, 0.05])
@pytest.mark.parametrize("depth", [-20.0, 3.0])
@pytest.mark.parametrize("side", [0, 1])
def test_the_side_of_a_cone_keeps_behind_its_plane_and_square_to_the_sheet(half_angle, depth, side):
    shape = folded_panel(chain="c", half_angle=half_angle, radius=900.0, widths=(), turns=())
    edge = f"side {side}"
    plane = leaning(shape, edge, 10.0, 0.05, 0.01)
    cut = shape.cut_back({edge: plane}, depth)
    check_buildable(cut, abs(depth), "outer" if depth < 0.0 else "inner")
    corners = np.concatenate([face.edge(edge).corners for face in (cut, cut.offset(depth))])
    assert plane.beyond(corners).max() == pytest.approx(0.0, abs=CLOSE)
    assert plane.beyond(corners).min() < 0.0
    assert cut.side_leans.tolist() == [0.0, 0.0]
    # The other side, and the cone, are as they were.
    other = f"side {1 - side}"
    assert cut.edge(other).corners == pytest.approx(shape.edge(other).corners, abs=CLOSE)


def test_what_is_not_named_stays():
    shape = random_panel(2)
    cut = shape.cut_back({"end 1": leaning(shape, "end 1", 10.0, 0.0)}, -3.0)
    assert cut.corners()[0] == pytest.approx(shape.corners()[0], abs=CLOSE)
    assert other_face(cut, 3.0, "outer").corners()[0] == pytest.approx(
        other_face(shape, 3.0, "outer").corners()[0], abs=CLOSE
    )
    assert cross(cut.directions, shape.directions) == pytest.approx(np.zeros((4, 3)), abs=1e-12)


def test_a_plane_that_misses_a_round_side_is_refused():
    shape = folded_panel(chain="c", radius=900.0, widths=(), turns=())
    plane = leaning(shape, "side 1", -600.0, 0.0)
    with pytest.raises(PanelError, match="its neighbour at side 1 lies too far away"):
        shape.cut_back({"side 1": plane}, -3.0)
