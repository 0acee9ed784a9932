"""A loft in the plane keeps lengths and areas; what it cannot keep is told."""

import numpy as np
import pytest

from cadpanel.geometry.biarcs import arc_chains, arc_contour_area
from cadpanel.lofting.flat import outline
from cadpanel.lofting.loft import loft
from tests.known_rails import TWISTED, curve, on_cone, rails


def test_a_cone_between_two_circles_becomes_a_sector():
    low, high = (curve(on_cone(lambda t, z=z: z + 0.0 * t), 0.0, 2.0) for z in (0.0, 200.0))
    surface = loft(low, high)
    (flat,), error = surface.flat
    slant, sine = np.hypot(100.0, 500.0), 100.0 / np.hypot(100.0, 500.0)
    area = 0.5 * 2.0 * sine * slant**2 * (1.0 - 0.6**2)
    assert error.surface == pytest.approx(area, rel=1e-9)
    for edge, radius in zip(flat.edges, (slant, 0.6 * slant), strict=True):
        assert np.ptp(np.linalg.norm(edge(np.linspace(0.0, 1.0, 9)) - np.array([0.0, slant]), axis=1)) < 1e-6
        assert np.linalg.norm(edge(0.5) - np.array([0.0, slant])) == pytest.approx(radius, abs=1e-6)
    contour = np.concatenate(arc_chains(outline(surface.flat[0]), 0.01))
    assert arc_contour_area(contour) == pytest.approx(area, rel=1e-4)


def test_what_warp_takes_from_lengths_and_areas_is_told():
    error = loft(*rails(TWISTED)).flat[1]
    assert error.length > 1e-4
    assert error.area > 0.0
