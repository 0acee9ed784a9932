"""The bevel of an end: the angle between its wall and the sheet's normal, square to the edge."""

import math

import numpy as np
import pytest

from cadpanel.geometry.bevels import end_bevels
from tests.flat_panels import panels
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


def test_edges_of_polygons_are_square():
    assert end_bevels(panels("polygon of 5", 1)[0]).shape == (0, 2)
