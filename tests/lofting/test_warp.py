"""Warp is the angle between two normals, with the derivatives that differences show; both distances vanish together."""

import numpy as np
import pytest

from cadpanel.errors import SettingsError
from cadpanel.lofting.distance import check_distance
from cadpanel.lofting.rail import rail_of
from cadpanel.lofting.warp import signed_warp, squares, warp
from tests.known_rails import CYLINDER, TWISTED, rails

A, B = (rail_of(given, name) for given, name in zip(rails(TWISTED), "AB", strict=True))
PLACES = np.random.default_rng(0).uniform(0.1, 0.9, (20, 2))


def test_the_sine_has_the_derivatives_that_differences_show():
    def at(a, b):
        return signed_warp(A.at(a), B.at(b))

    a, b, step = *PLACES.T, 1e-6
    found = at(a, b)
    assert np.abs(found.by_a - (at(a + step, b).sine - at(a - step, b).sine) / (2.0 * step)).max() < 1e-7
    assert np.abs(found.by_b - (at(a, b + step).sine - at(a, b - step).sine) / (2.0 * step)).max() < 1e-7
    assert np.abs(np.abs(found.angle) - warp(A.at(a), B.at(b))).max() < 1e-12


def test_along_generators_of_a_cylinder_neither_distance_is_anything_and_elsewhere_both_are():
    # Both circles by the same angle: level rails.
    level = rails((CYLINDER[0], lambda t: CYLINDER[0](t) + np.array([0.0, 0.0, 200.0])))
    a, b = (rail_of(given, name) for given, name in zip(level, "AB", strict=True))
    share = np.linspace(0.0, 1.0, 9)
    for distance in ("warp", "tangent-planes"):
        found = squares(a, b, share, share, distance)
        assert np.diag(found).max() < 1e-20
        assert (found + np.eye(9)).min() > 1e-6


def test_another_distance_is_refused():
    with pytest.raises(SettingsError, match="warp or tangent-planes"):
        check_distance("nonsense")
