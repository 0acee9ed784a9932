"""Features that a user composes: what they fix stays fixed, what they bound stays within, the fit finds the rest."""

import numpy as np
import pytest

from cadpanel.features.feature import Feature
from cadpanel.features.patches import Cone, Cylinder, Plane
from cadpanel.fitting.run import fit
from cadpanel.fitting.settings import FitSettings
from cadpanel.geometry.patches import ConePatch
from fixtures.arrays import reference as sampled_lip
from fixtures.lips import Lip
from tests.instances import random_shapes
from tests.known_panels import alone

RECOVERED = 1e-6
LIP = sampled_lip(Lip(panels=2, twist=(2.0, 3.0), radius=(300.0, 260.0)))

every_method = pytest.mark.parametrize("method", ["local", "two_stage", "concurrent"])


def cone_of(shape) -> ConePatch:
    (cone,) = (patch for patch in shape.patches if isinstance(patch, ConePatch))
    return cone


def composed(*patches, **how):
    return Feature(*patches, **how)


def fitted(feature, reference=LIP, **how):
    return fit(reference, FitSettings(feature=feature, gap_tolerance=10.0, **how))


@every_method
def test_a_fixed_radius_and_sweep_are_kept_to_the_last_digit(method):
    of = composed(Plane(), Cylinder(radius=280.0, sweep=np.radians(95.0)), Plane(), name="stamped")
    for shape in fitted(of, method=method).shapes:
        cone = cone_of(shape)
        assert shape.feature == "stamped"
        assert cone.radius == pytest.approx(280.0, rel=1e-14)
        assert (cone.sweep, cone.half_angle, cone.kind) == (np.radians(95.0), 0.0, "cylinder")


@every_method
@pytest.mark.parametrize(("least", "greatest"), [(150.0, 220.0), (320.0, 400.0)])
def test_bounds_are_kept_and_reached_where_the_drawing_lies_beyond_them(method, least, greatest):
    of = composed(Plane(), Cone(radius=(least, greatest)), Plane())
    radii = [cone_of(shape).radius for shape in fitted(of, method=method).shapes]
    assert min(radii) >= least * (1.0 - 1e-12)
    assert max(radii) <= greatest * (1.0 + 1e-12)
    free = [cone_of(shape).radius for shape in fitted("plane-cone-plane", method="local").shapes]
    assert all(greatest < radius for radius in free) or all(radius < least for radius in free)
    if method == "local":
        nearest = greatest if free[0] > greatest else least
        assert radii == pytest.approx([nearest, nearest], rel=1e-9)


def test_bounds_that_hold_anyway_change_nothing():
    loose = fitted(composed(Plane(), Cone(radius=(10.0, 5000.0), sweep=(0.1, 3.0)), Plane()), method="local")
    free = fitted("plane-cone-plane", method="local")
    for one, other in zip(loose.shapes, free.shapes, strict=True):
        assert one.corners() == pytest.approx(other.corners(), abs=1e-4)


def test_one_bound_may_be_open():
    of = composed(Plane(), Cone(radius=(None, 200.0)), Plane())
    assert max(cone_of(shape).radius for shape in fitted(of, method="local").shapes) <= 200.0 * (1.0 + 1e-12)


@every_method
def test_restarts_keep_to_the_bounds_too(method):
    of = composed(Plane(), Cone(radius=(150.0, 220.0), half_angle=(-0.01, 0.01)), Plane())
    for shape in fitted(of, method=method, restarts=2, seed=1).shapes:
        assert 150.0 * (1.0 - 1e-12) <= cone_of(shape).radius <= 220.0 * (1.0 + 1e-12)
        assert abs(cone_of(shape).half_angle) <= 0.01 * (1.0 + 1e-12)


def test_a_fixed_flange_has_its_width_between_its_two_rulings():
    of = composed(Plane(width=300.0, turn=0.0), Cone(), Plane())
    for shape in fitted(of, method="local").shapes:
        across = shape.corners()[:, 1] - shape.corners()[:, 0]
        assert across @ shape.binormals()[0] == pytest.approx([300.0, 300.0], abs=1e-9)


@pytest.mark.parametrize(
    "patches",
    [
        (Plane(), Cone()),
        (Cone(), Plane(), Cone()),
        (Plane(), Cylinder(), Plane(), Cone(), Plane()),
        # A width that is fixed holds in the middle of the panel; without a turn it is the same all along.
        (Plane(width=400.0, turn=0.0), Cone(radius=(100.0, 900.0)), Plane(turn=0.0)),
    ],
    ids=lambda patches: "-".join(patch.kind for patch in patches),
)
@pytest.mark.parametrize("cuts", ["mitre", "upright", "parallel", "square"])
def test_a_composed_feature_is_recovered_from_its_samples(patches, cuts):
    of = composed(*patches, cuts=cuts)
    known = random_shapes(of.in_units(2000.0), 5, 6)
    result = fit(alone(*known), FitSettings(feature=of, method="local"))
    for one, other in zip(result.shapes, known, strict=True):
        error = np.linalg.norm(one.corners() - other.corners(), axis=-1).max()
        # What upright means is told by the start's frame, which knows the fold's direction only roughly.
        assert error <= (RECOVERED if cuts in ("mitre", "square") else 50.0)
    if cuts in ("mitre", "square"):
        assert result.measures.overall_rms <= 1e-8
