"""A polygon's walls stand in the planes that were given; edges that go on straight share one."""

import math
from dataclasses import replace

import numpy as np
import pytest

from cadpanel.errors import PanelError
from cadpanel.geometry.sheet_checks import check_buildable
from cadpanel.geometry.vectors import cross, unit
from tests.instances import random_polygon
from tests.joined import leaning, polygon

CLOSE = 1e-9


@pytest.mark.parametrize("corners", [3, 4, 6])
@pytest.mark.parametrize("depth", [-3.0, 20.0])
def test_walls_stand_in_their_planes_on_both_faces_and_others_stay(corners, depth):
    shape = random_polygon(1, corners)
    leans = np.linspace(-0.1, 0.2, corners)
    planes = {f"edge {i}": leaning(shape, f"edge {i}", 5.0, leans[i]) for i in range(corners - 1)}
    cut = shape.cut_back(planes, depth)
    check_buildable(cut, abs(depth), "outer" if depth < 0.0 else "inner")
    for face in (cut, cut.offset(depth)):
        for edge, plane in planes.items():
            assert plane.beyond(face.edge(edge).corners) == pytest.approx(0.0, abs=CLOSE)
    free = shape.edge(f"edge {corners - 1}")
    for face in (cut, cut.offset(depth)):
        ends = face.edge(f"edge {corners - 1}").corners
        assert (ends - free.corners[0]) @ free.outward == pytest.approx(0.0, abs=CLOSE)


def parted(bend=0.0, place=900.0):
    """A rectangle whose upper side two neighbours share, with a corner between them that bends by so many mm."""
    upper = [[2000.0, 900.0, 0.0], [place, 900.0 + bend, 0.0], [0.0, 900.0, 0.0]]
    return polygon("P", np.array([[0.0, 0.0, 0.0], [2000.0, 0.0, 0.0], *upper]))


@pytest.mark.parametrize("bend", [0.0, 3.0, -3.0])
@pytest.mark.parametrize("depth", [-3.0, 20.0])
def test_two_edges_in_one_line_get_one_wall_behind_both_planes(bend, depth):
    shape = parted(bend)
    planes = {"edge 2": leaning(shape, "edge 2", 10.0, 0.02), "edge 3": leaning(shape, "edge 3", 10.0, 0.08)}
    cut = shape.cut_back(planes, depth)
    check_buildable(cut, abs(depth), "outer" if depth < 0.0 else "inner")
    ahead = np.array(
        [planes[edge].beyond(face.edge(edge).corners).max() for face in (cut, cut.offset(depth)) for edge in planes]
    )
    assert ahead.max() == pytest.approx(0.0, abs=1e-8)
    assert ahead.min() > -3.0
    upper = [face.outline[[2, 3, 4]] for face in (cut, cut.offset(depth))]
    flat = np.concatenate(upper)
    assert np.linalg.svd(flat - flat.mean(axis=0))[1][2] == pytest.approx(0.0, abs=1e-9)


def test_a_panel_of_which_an_edge_is_gone_is_refused():
    shape = polygon("P", np.array([[0.0, 0.0, 0.0], [900.0, 0.0, 0.0], [900.0, 30.0, 0.0], [0.0, 30.0, 0.0]]))
    planes = {edge: leaning(shape, edge, 16.0, 0.0) for edge in ("edge 0", "edge 2")}
    with pytest.raises(PanelError, match="only 0 mm of edge 1 are left"):
        shape.cut_back(planes, -3.0)
    # On the other face alone, too.
    planes = {edge: leaning(shape, edge, 1.0, 1.0) for edge in ("edge 0", "edge 2")}
    assert shape.cut_back(planes, -3.0).outline.shape == (4, 3)
    with pytest.raises(PanelError, match="of edge 1 are left"):
        shape.cut_back(planes, 14.5)


def test_turning_the_list_of_corners_changes_nothing():
    shape = random_polygon(4, 6)
    rolled = replace(shape, outline=np.roll(shape.outline, -2, axis=0))
    cut = shape.cut_back({"edge 3": leaning(shape, "edge 3", 7.0, 0.1)}, -3.0)
    same = rolled.cut_back({"edge 1": leaning(rolled, "edge 1", 7.0, 0.1)}, -3.0)
    assert np.roll(same.outline, 2, axis=0) == pytest.approx(cut.outline, abs=CLOSE)


def test_two_edges_in_one_line_that_are_not_cut_stay_beside_others_that_are():
    shape = parted(3.0)
    cut = shape.cut_back({"edge 0": leaning(shape, "edge 0", 10.0, 0.1)}, -3.0)
    assert cut.outline[2:] == pytest.approx(shape.outline[2:], abs=CLOSE)
    assert cut.outline[:2, 1] == pytest.approx(math.hypot(10.0, 1.0))


@pytest.mark.parametrize("place", [900.0, 1100.0])
def test_a_wall_of_two_edges_whose_planes_lie_outside_of_the_panel_stands_at_its_outermost_corner(place):
    shape = parted(-3.0, place)
    cut = shape.cut_back({f"edge {i}": leaning(shape, f"edge {i}", -5.0, 0.0) for i in (2, 3)}, -3.0)
    start, stop = cut.outline[[2, 4]]
    out = cross(unit(stop - start), shape.normal)
    assert ((shape.outline - start) @ out).max() == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("distance", [-4.0, 4.0])
def test_the_wall_of_a_single_edge_stands_in_its_plane_wherever_that_is(distance):
    shape = parted(3.0)
    plane = leaning(shape, "edge 1", distance, 0.1)
    cut = shape.cut_back({"edge 1": plane}, -3.0)
    for face in (cut, cut.offset(-3.0)):
        assert plane.beyond(face.edge("edge 1").corners) == pytest.approx(0.0, abs=CLOSE)
