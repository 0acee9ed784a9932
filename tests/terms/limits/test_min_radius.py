"""A feature is refused where its author asks for a tighter radius than can be rolled, and only there."""

import math

import pytest

from cadpanel.errors import SettingsError
from cadpanel.features.feature import Feature
from cadpanel.features.patches import Cone, Cylinder, Plane
from cadpanel.terms.limits.min_radius import MinRadius


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("radius", [10.0, 0.3])
def test_just_the_least_radius_passes_and_by_a_last_digit_less_is_refused(radius, side):
    MinRadius().check_feature(Feature(Plane(), Cone(radius=side * radius), Plane()), radius)
    tighter = Feature(Plane(), Cylinder(radius=side * math.nextafter(radius, 0.0)), Plane())
    with pytest.raises(SettingsError, match=r"the radius of patch 1 of .* is tighter than the least radius"):
        MinRadius().check_feature(tighter, radius)


def test_planes_and_radii_that_the_fit_may_choose_pass():
    MinRadius().check_feature(Feature(Plane(width=1.0), Cone(), Plane()), 1e6)
    MinRadius().check_feature(Feature(Plane(), Cone(radius=(1.0, 50.0)), Plane()), 50.0)
