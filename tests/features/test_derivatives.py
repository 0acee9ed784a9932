"""The laws of how panels follow their numbers: exact derivatives, no spare unknowns, smooth at half angle 0."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cadpanel.features.cut_planes import cut_plane_rates, cut_planes
from cadpanel.features.walk import arc_rulings
from tests.chains import CHAINS, FEATURES, random_values, rulings_of, slopes

# Lengths in panel lengths, angles in radians.
ROUNDING = 1e-12
# Central differences of functions of size 1 with this step agree to the tolerance, relative to the largest derivative.
STEP = 1e-6
DIFFERENCES = 1e-6
# A direction of the unknowns that moves nothing has a singular value below this share of the largest.
NO_MOTION = 1e-8

few = settings(max_examples=5)
seeds = st.integers(0, 2**32 - 1)
every_feature = pytest.mark.parametrize("name", sorted(FEATURES))
every_chain = pytest.mark.parametrize("name", sorted(CHAINS))


def differences(of, values, function):
    """Central differences (..., N) by all numbers of each array that `function` makes of a walk, in one batch."""
    panels, count = values.shape
    steps = STEP * np.concatenate([np.eye(count), -np.eye(count)])
    batch = (values[:, None] + steps).reshape(-1, count)
    both = [part.reshape(panels, 2, count, *part.shape[1:]) for part in function(of.walk(batch, derivatives=False))]
    return [np.moveaxis((part[:, 0] - part[:, 1]) / (2.0 * STEP), 1, -1) for part in both]


def relative(one, other):
    return np.abs(one - other).max(initial=0.0) / max(1.0, np.abs(other).max(initial=0.0))


def corners_and_arc_points(walked):
    return [walked.feature.corners(walked).position, walked.feature.arcs(walked).position]


@every_feature
@few
@given(seed=seeds)
def test_derivatives_of_corners_and_arc_points_agree_with_finite_differences(name, seed):
    of, values = FEATURES[name], random_values(FEATURES[name], seed)
    walked = of.walk(values, derivatives=True)
    numeric = differences(of, values, corners_and_arc_points)
    for points, expected in zip((of.corners(walked), of.arcs(walked)), numeric, strict=True):
        assert relative(slopes(points), expected) <= DIFFERENCES


@every_chain
@few
@given(seed=seeds)
def test_derivatives_of_the_cut_planes_agree_with_finite_differences(name, seed):
    values = random_values(CHAINS[name], seed)
    exact = cut_plane_rates(CHAINS[name].walk(values, derivatives=True))
    for one, other in zip(exact, differences(CHAINS[name], values, cut_planes), strict=True):
        assert relative(one, other) <= DIFFERENCES


def frames_of(walked):
    return [getattr(rulings, axis) for rulings in rulings_of(walked).values() for axis in "pbtn"]


@every_feature
@few
@given(seed=seeds)
def test_twists_of_all_rulings_agree_with_finite_differences(name, seed):
    values = random_values(FEATURES[name], seed)
    exact = []
    for rulings in rulings_of(FEATURES[name].walk(values, derivatives=True)).values():
        assert rulings.twist is not None
        omega, v = rulings.twist[..., :3, :], rulings.twist[..., 3:, :]
        exact.append(v + np.cross(omega, rulings.p[..., None], axisa=-2, axisb=-2, axisc=-2))
        for axis in "btn":
            exact.append(np.cross(omega, getattr(rulings, axis)[..., None], axisa=-2, axisb=-2, axisc=-2))
    for one, other in zip(exact, differences(FEATURES[name], values, frames_of), strict=True):
        assert relative(one, other) <= DIFFERENCES


def test_a_wrong_derivative_is_found():
    of = FEATURES["plane-cone-plane"]
    values = random_values(of, 3)
    walked = of.walk(values, derivatives=True)
    jacobian = slopes(of.corners(walked)).copy()
    jacobian[0, 0, 0, 0] += 1e-5
    assert relative(jacobian, differences(of, values, corners_and_arc_points)[0]) > DIFFERENCES


def motions(of, values):
    """(panels, rows, free) how the skin's points and normals follow the unknowns, at all corners and in arcs."""
    walked = of.walk(values, derivatives=True)
    rows = [
        slopes(points).reshape(len(values), -1, values.shape[1]) for points in (of.corners(walked), of.arcs(walked))
    ]
    for rulings in (walked.anchor, walked.edges, arc_rulings(walked)):
        assert rulings.twist is not None
        turning = np.cross(rulings.twist[..., :3, :], rulings.n[..., None], axisa=-2, axisb=-2, axisc=-2)
        rows += [turning.reshape(len(values), -1, values.shape[1])]
    return of.by_unknowns(np.concatenate(rows, axis=1))


def dependent(of, values):
    """Whether some combination of the unknowns moves nothing."""
    singular = np.linalg.svd(motions(of, values), compute_uv=False)
    return bool(np.any(singular[:, -1] <= NO_MOTION * singular[:, 0]))


@every_feature
@few
@given(seed=seeds)
def test_no_unknown_is_dependent_on_the_others(name, seed):
    assert not dependent(FEATURES[name], random_values(FEATURES[name], seed))


def test_unknowns_that_the_panel_does_not_show_are_found():
    """A cone that sweeps by nothing shows neither its radius nor its half angle."""
    of = CHAINS["plane-cone-plane"]
    values = random_values(of, 5)
    values[:, of.patch_slice(1).stop - 1] = 0.0
    assert dependent(of, values)


HALF_ANGLES = {
    name: [i for i, number in enumerate(of.numbers) if number.name.endswith("half_angle") and number.fixed is None]
    for name, of in CHAINS.items()
}


@pytest.mark.parametrize("name", sorted(name for name, at in HALF_ANGLES.items() if at))
@few
@given(seed=seeds)
def test_panels_are_smooth_through_half_angle_zero(name, seed):
    of, at = CHAINS[name], HALF_ANGLES[name]
    values = random_values(of, seed)
    values[:, at] = 0.0
    walked = of.walk(values, derivatives=True)
    corners = of.corners(walked)
    slope = slopes(corners)
    rate = slope[..., at].sum(axis=-1)
    for half_angle in [sign * 10.0**-k for k in range(12, 1, -2) for sign in (1.0, -1.0)]:
        bent = values.copy()
        bent[:, at] = half_angle
        there = of.walk(bent, derivatives=True)
        points = of.corners(there)
        # What is left after the tangent is of second order, down to rounding.
        curved = points.position - corners.position - half_angle * rate
        assert np.abs(curved).max() <= 50.0 * half_angle**2 + ROUNDING
        assert np.abs(slopes(points) - slope).max() <= 100.0 * abs(half_angle) + 1e-11
