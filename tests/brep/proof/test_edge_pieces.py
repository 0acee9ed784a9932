"""The edges of a shape in a file that make up one edge of a panel are found by the panel's corners."""

import numpy as np
import pytest

from cadpanel.brep.building.sheet import build_skin, build_solid
from cadpanel.brep.proof.edge_pieces import edge_pieces
from cadpanel.brep.proof.inspection import inspect
from tests.instances import random_polygon
from tests.shapes import random_panel

CLOSE = 1e-9


@pytest.mark.parametrize("build", [build_skin, lambda shape: build_solid(shape, 20.0)])
@pytest.mark.parametrize("edge", ["end 0", "end 1", "side 0", "side 1"])
def test_the_pieces_of_an_edge_run_from_corner_to_corner(build, edge):
    shape = random_panel(1)
    facts = inspect("A", build(shape))
    found = edge_pieces(facts, shape.corners(), edge)
    own = shape.edge(edge).corners
    assert found is not None
    assert len(found) == len(own) - 1
    for place, first, last in zip(found, own[:-1], own[1:], strict=True):
        ends = facts.piece_ends[place]
        turned = ends if np.linalg.norm(ends[0] - first) < CLOSE else ends[::-1]
        assert turned == pytest.approx(np.array([first, last]), abs=CLOSE)


def test_every_edge_of_a_polygon_is_another_piece():
    shape = random_polygon(1, 6)
    facts = inspect("P", build_skin(shape))
    found = [edge_pieces(facts, shape.corners(), f"edge {i}") for i in range(6)]
    assert sorted(int(one[0]) for one in found if one is not None) == list(range(6))


def test_an_edge_that_is_not_there_is_not_found():
    shape = random_panel(1)
    facts = inspect("A", build_skin(shape))
    assert edge_pieces(facts, shape.corners(), "edge 0") is None
    # Corners that the shape does not have: a corner of a patch stands in the place of another.
    swapped = shape.corners()[:, [0, 2, 1, 3]]
    assert edge_pieces(facts, swapped, "end 0") is None
