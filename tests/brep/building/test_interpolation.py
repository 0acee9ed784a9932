"""Splines follow curves as closely as rounding lets them."""

import numpy as np
import pytest
from scipy.interpolate import BSpline

from cadpanel.brep.building.interpolation import CLOSE, DEGREE, interpolate


@pytest.mark.parametrize("turn", [0.01, 1.5, 3.0, 6.0])
def test_a_spline_follows_a_curve_with_its_parameter(turn):
    def at(w):
        return np.stack([900.0 * np.cos(w), 700.0 * np.sin(w), 30.0 * w], axis=-1)

    found = interpolate(at, 0.2, 0.2 + turn, np.ones(3))
    ends = np.array([DEGREE + 1] + (len(found.knots) - 2) * [1] + [DEGREE + 1])
    spline = BSpline(np.repeat(found.knots, ends), found.poles, DEGREE)
    places = np.linspace(0.2, 0.2 + turn, 500)
    assert np.abs(spline(places) - at(places)).max() < 10.0 * CLOSE
    assert found.knots[-1] == 0.2 + turn
