"""The wall at a cylinder's side leans as the plane of its joint does, and every parallel skin ends on it."""

import numpy as np
import pytest

from cadpanel.geometry.sheet_checks import check_buildable
from tests.joined import leaning
from tests.shapes import folded_panel

CLOSE = 1e-9


@pytest.mark.parametrize("radius", [900.0, -900.0])
@pytest.mark.parametrize("depth", [-20.0, 3.0])
@pytest.mark.parametrize("side", [0, 1])
@pytest.mark.parametrize("degrees", [-10.0, -1.0, 0.0, 5.0, 10.0])
def test_both_faces_and_all_between_end_on_the_plane(radius, depth, side, degrees):
    shape = folded_panel(chain="c", radius=radius, sweep=np.sign(radius), widths=(), turns=())
    edge = f"side {side}"
    plane = leaning(shape, edge, 10.0, np.tan(np.radians(degrees)))
    cut = shape.cut_back({edge: plane}, depth)
    check_buildable(cut, abs(depth), "outer" if depth < 0.0 else "inner")
    for face in (cut, cut.offset(0.3 * depth), cut.offset(0.5 * depth).offset(0.5 * depth)):
        assert plane.beyond(face.edge(edge).corners) == pytest.approx(0.0, abs=CLOSE)
    square = cut.squared(depth)
    corners = np.concatenate([face.edge(edge).corners for face in (square, square.offset(depth))])
    assert plane.beyond(corners).max() == pytest.approx(0.0, abs=CLOSE)
