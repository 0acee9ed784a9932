"""Samples that no surface can be fitted to are refused in one sentence that says which and why."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import cadpanel as cp
from cadpanel.atomic.cylinder import fit_cylinders
from cadpanel.atomic.plane import fit_planes

LEAST: dict[Callable[..., Any], int] = {cp.fit_plane: 3, cp.fit_cylinder: 5, cp.fit_cone: 6}
every_fit = pytest.mark.parametrize("fit", list(LEAST))


def samples(count, seed=0):
    return np.random.default_rng(seed).normal(size=(count, 3))


@every_fit
def test_fewer_samples_than_unknowns_are_refused(fit):
    least = LEAST[fit]
    assert np.isfinite(fit(samples(least)).rms)
    with pytest.raises(cp.FitError, match=f"needs at least {least}, not {least - 1}"):
        fit(samples(least - 1))


@every_fit
def test_samples_without_weight_do_not_count(fit):
    weights = np.ones(LEAST[fit])
    weights[0] = 0.0
    with pytest.raises(cp.FitError, match="too few samples"):
        fit(samples(LEAST[fit]), weights=weights)


@every_fit
@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_a_coordinate_that_is_no_number_is_refused(fit, value):
    points = samples(10)
    points[3, 1] = value
    with pytest.raises(cp.FitError, match="a coordinate that is no number"):
        fit(points)


@every_fit
def test_coordinates_and_normals_that_overflow_are_refused(fit):
    with pytest.raises(cp.FitError, match=r"a coordinate beyond 1e\+15"):
        fit(1e200 * samples(10))
    with pytest.raises(cp.FitError, match=r"a normal longer than 1e\+15"):
        fit(samples(10), normals=1e200 * samples(10))


@every_fit
def test_a_normal_that_is_no_number_is_refused(fit):
    normals = samples(10)
    normals[0, 0] = np.nan
    with pytest.raises(cp.FitError, match="a normal that is no number"):
        fit(samples(10), normals=normals)


@every_fit
@pytest.mark.parametrize("value", [-1.0, np.nan, np.inf])
def test_a_weight_that_weighs_nothing_sensible_is_refused(fit, value):
    weights = np.ones(10)
    weights[2] = value
    with pytest.raises(cp.FitError, match="a weight that is negative or no number"):
        fit(samples(10), weights=weights)


@every_fit
def test_samples_at_one_point_or_on_one_line_are_refused(fit):
    with pytest.raises(cp.FitError, match="at one point"):
        fit(np.full((10, 3), 7.0))
    line = np.linspace(-1.0, 1.0, 10)[:, None] * [3.0, 2.0, 1.0]
    with pytest.raises(cp.FitError, match="on one line"):
        fit(line)
    # The smallest bend makes a plane.
    line[4, 2] += 1e-9
    assert fit(line).rms < 1e-9


@every_fit
@pytest.mark.parametrize(
    ("points", "message"),
    [("no numbers", "rectangular array of numbers"), (np.zeros(3), r"shape \(m, 3\)"), (np.zeros((9, 2)), "shape")],
)
def test_arrays_of_another_shape_are_refused(fit, points, message):
    with pytest.raises(cp.FitError, match=message):
        fit(points)


def test_weights_and_normals_that_do_not_belong_to_the_points_are_refused():
    with pytest.raises(cp.FitError, match="one for each sample"):
        cp.fit_plane(samples(5), np.ones(4))
    with pytest.raises(cp.FitError, match="one for each sample"):
        cp.fit_cylinder(samples(9), samples(8))


def test_the_set_that_is_wrong_is_named():
    points = np.stack([samples(9, seed) for seed in range(4)])
    points[2] = points[2, :1]
    with pytest.raises(cp.FitError, match="a plane cannot be fitted: set 2 of the samples has all its samples at one"):
        fit_planes(points)
    points[1, 0, 0] = np.nan
    with pytest.raises(cp.FitError, match="set 1"):
        fit_cylinders(points)


def test_the_error_is_a_value_error_of_the_package():
    assert issubclass(cp.FitError, cp.CadpanelError)
    assert issubclass(cp.FitError, ValueError)
