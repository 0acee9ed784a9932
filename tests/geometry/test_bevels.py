"""Bevels: the angle between a wall and the sheet's normal, square to the edge."""

import math

import numpy as np
import pytest

from cadpanel.geometry.bevels import edge_bevels, end_bevels
from tests.flat_panels import panels
from tests.joined import leaning, quadrilaterals
from tests.known_panels import end_curve
from tests.shapes import folded_panel, random_panel


@pytest.mark.parametrize("chain", ["plane-cone-plane", "cone", "cone-plane-cone"])
@pytest.mark.parametrize("seed", range(6))
def test_the_extremes_are_those_of_many_places_along_the_end(chain, seed):
    shape = random_panel(seed, chain=chain, mitre=0.6)
    u = np.linspace(0.0, len(shape.patches), 2001)[None]
    for end, way in enumerate((-1.0, 1.0)):
        _, normals = end_curve(shape, end).follow(u)
        leans = np.arcsin(way * normals[0] @ shape.cut_normals[end])
        least, largest = end_bevels(shape)[end]
        assert least <= leans.min() + 1e-12
        assert largest >= leans.max() - 1e-12
        assert least == pytest.approx(leans.min(), abs=1e-6)
        assert largest == pytest.approx(leans.max(), abs=1e-6)


def test_square_ends_have_none_and_a_known_slant_is_told_with_its_sign():
    assert end_bevels(folded_panel(chain="p", widths=(100.0,), turns=(0.0,))) == pytest.approx(np.zeros((2, 2)))
    slant = math.radians(10.0)
    # The wall at end 1 looks upwards, to the outside: the outer face is the shorter one.
    leaning = (math.cos(slant), 0.0, math.sin(slant))
    flat = folded_panel(chain="p", widths=(100.0,), turns=(0.0,), cut_normals=((1.0, 0.0, 0.0), leaning))
    assert np.degrees(end_bevels(flat)) == pytest.approx(np.array([[0.0, 0.0], [10.0, 10.0]]))


def test_the_largest_bevel_inside_of_a_bend_is_found():
    shape = folded_panel(chain="c", sweep=2.0, widths=(), turns=(), cut_normals=((1, 0, 0), (1.0, -0.5, 0.3)))
    least, largest = end_bevels(shape)[1]
    rulings = [math.asin(normal @ shape.cut_normals[1]) for normal in shape.normals]
    assert largest > max(rulings) + 1e-3
    assert least == pytest.approx(min(rulings))


@pytest.mark.parametrize("depth", [-3.0, 20.0])
def test_a_wall_that_nobody_asked_to_lean_is_square(depth):
    polygon, chain = panels("polygon of 5", 1)[0], random_panel(3)
    assert end_bevels(polygon).shape == (0, 2)
    found = edge_bevels(polygon, polygon.offset(depth))
    assert list(found) == [f"edge {i}" for i in range(5)]
    assert np.array(list(found.values())) == pytest.approx(np.zeros((5, 2)), abs=1e-9)
    found = edge_bevels(chain, chain.offset(depth))
    assert list(found) == ["end 0", "end 1", "side 0", "side 1"]
    assert np.array([found["end 0"], found["end 1"]]) == pytest.approx(end_bevels(chain))
    assert found["side 0"] + found["side 1"] == pytest.approx((0.0,) * 4, abs=1e-9)


@pytest.mark.parametrize("depth", [-3.0, 20.0])
@pytest.mark.parametrize("lean", [-0.2, 0.1])
def test_walls_that_lean_have_the_bevels_of_their_planes(depth, lean):
    polygon, chain = quadrilaterals()[0], random_panel(5, chain="plane-cone-plane")
    for shape, edges in ((polygon, ("edge 1", "edge 2")), (chain, ("side 0", "side 1"))):
        cut = shape.cut_back({edge: leaning(shape, edge, 8.0, lean) for edge in edges}, depth)
        found = edge_bevels(cut, cut.offset(depth))
        for edge in edges:
            assert found[edge] == pytest.approx(2 * (math.atan(lean),), abs=1e-9)
