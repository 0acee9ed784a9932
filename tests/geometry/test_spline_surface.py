"""Spline surfaces against SciPy's, whatever degree, knots and weights, and many at once as each alone."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.interpolate import BSpline

from cadpanel.geometry.spline_surface import CHUNK, SplineSurface, SplineSurfaces

seeds = st.integers(0, 2**32 - 1)
degrees = st.integers(1, 5)


def random_surface(random, degrees, rational):
    """Clamped knots, some inner ones double."""
    knots = []
    for degree in degrees:
        inner = np.sort(random.uniform(0.1, 0.9, random.integers(0, 5)))
        inner = np.sort(np.concatenate([inner, inner[:1]])) if degree > 2 else inner
        knots.append(np.concatenate([np.zeros(degree + 1), inner, np.ones(degree + 1)]))
    counts = [len(own) - degree - 1 for own, degree in zip(knots, degrees, strict=True)]
    poles = random.normal(size=(*counts, 3)) * 1000.0
    if rational:
        weights = random.uniform(0.5, 2.0, counts)
        poles = np.concatenate([poles * weights[..., None], weights[..., None]], axis=-1)
    return SplineSurface(degrees=degrees, knots=(knots[0], knots[1]), poles=poles, bounds=np.array([[0.0, 1.0]] * 2))


def by_scipy(surface, at, derivative=(0, 0)):
    """(p, 3 or 4) homogeneous values by two rounds of SciPy's splines."""
    (u, v), (degree_u, degree_v) = at.T, surface.degrees
    along = BSpline(surface.knots[0], surface.poles, degree_u)(u, nu=derivative[0])
    return np.array(
        [BSpline(surface.knots[1], own, degree_v)(place, nu=derivative[1]) for own, place in zip(along, v, strict=True)]
    )


@settings(max_examples=25)
@given(seed=seeds, degree_u=degrees, degree_v=degrees, rational=st.booleans())
def test_points_and_derivatives_are_those_of_scipy(seed, degree_u, degree_v, rational):
    random = np.random.default_rng(seed)
    surface = random_surface(random, (degree_u, degree_v), rational)
    at = np.concatenate([random.uniform(0.0, 1.0, (6, 2)), [(0.0, 0.0), (1.0, 1.0), (0.0, 1.0)]])
    found = SplineSurfaces([surface]).evaluate(np.zeros(len(at), dtype=np.intp), at)
    value, slope_u, slope_v = (by_scipy(surface, at, derivative) for derivative in ((0, 0), (1, 0), (0, 1)))
    if rational:  # quotient rule
        weight = value[:, 3:]
        value, slope_u, slope_v = (
            value[:, :3] / weight,
            (slope_u[:, :3] * weight - slope_u[:, 3:] * value[:, :3]) / weight**2,
            (slope_v[:, :3] * weight - slope_v[:, 3:] * value[:, :3]) / weight**2,
        )
    scale = np.abs(slope_u).max() + np.abs(slope_v).max()
    for place, wanted in enumerate((value, slope_u, slope_v)):
        np.testing.assert_allclose(found[:, place], wanted, atol=1e-9 * scale)


@settings(max_examples=10)
@given(seed=seeds, degree_u=degrees, degree_v=degrees, rational=st.booleans())
def test_a_grid_is_what_its_points_are_one_by_one(seed, degree_u, degree_v, rational):
    random = np.random.default_rng(seed)
    many = SplineSurfaces([random_surface(random, (degree_u, degree_v), rational) for _ in range(4)])
    owners = np.array([3, 0, 2, 3, 1])
    u, v = random.uniform(0.0, 1.0, (5, 7)), np.sort(random.uniform(0.0, 1.0, (5, 3)), axis=1)
    u[0, 0], v[0, -1] = 0.0, 1.0
    parameters = np.stack(np.broadcast_arrays(u[:, :, None], v[:, None, :]), axis=-1)
    wanted = many.evaluate(np.repeat(owners, 21), parameters.reshape(-1, 2)).reshape(5, 7, 3, 3, 3)
    found = many.evaluate_grids(owners, u, v)
    np.testing.assert_allclose(found, wanted, rtol=0.0, atol=1e-12 * np.abs(wanted).max())
    np.testing.assert_array_equal(many.slopes_on_grids(owners, u, v), found[..., 1:, :])


@settings(max_examples=10)
@given(seed=seeds, rational=st.booleans())
def test_many_surfaces_at_once_are_each_of_them_alone(seed, rational):
    random = np.random.default_rng(seed)
    surfaces = [random_surface(random, (3, 2), rational) for _ in range(4)]
    surfaces.append(surfaces[0])  # shares its poles
    owners, at = random.integers(0, 5, 40), random.uniform(0.0, 1.0, (40, 2))
    found = SplineSurfaces(surfaces).evaluate(owners, at)
    for owner in range(5):
        own = owners == owner
        alone = SplineSurfaces([surfaces[owner]]).evaluate(np.zeros(own.sum(), dtype=np.intp), at[own])
        np.testing.assert_array_equal(found[own], alone)


def test_more_points_than_are_worked_on_at_once_come_out_in_their_order():
    surface = random_surface(np.random.default_rng(3), (2, 2), rational=False)
    at = np.random.default_rng(4).uniform(0.0, 1.0, (CHUNK + 7, 2))
    owners = np.zeros(len(at), dtype=np.intp)
    batch = SplineSurfaces([surface])
    found = batch.evaluate(owners, at)
    np.testing.assert_array_equal(found[CHUNK - 3 :], batch.evaluate(owners[CHUNK - 3 :], at[CHUNK - 3 :]))


def creased(bounds):
    """Degree 1: z rises with slope 1 up to u = 0.5 and falls with slope 2 behind."""
    poles = np.array([[(u, v, z) for v in (0.0, 1.0)] for u, z in ((0.0, 0.0), (0.5, 0.5), (1.0, -0.5))])
    knots = np.array([0.0, 0.0, 0.5, 1.0, 1.0]), np.array([0.0, 0.0, 1.0, 1.0])
    return SplineSurfaces([SplineSurface(degrees=(1, 1), knots=knots, poles=poles, bounds=np.array(bounds))])


def test_on_a_knot_the_derivative_is_the_one_from_inside_the_bounds():
    at, owner = np.array([(0.5, 0.3)]), np.zeros(1, dtype=np.intp)
    whole, before, behind = (
        creased([own, (0.0, 1.0)]).evaluate(owner, at)[0] for own in ((0.0, 1.0), (0.0, 0.5), (0.5, 1.0))
    )
    assert before[1, 2] == 1.0
    assert behind[1, 2] == whole[1, 2] == -2.0
    np.testing.assert_array_equal(before[0], behind[0])


def test_beyond_the_bounds_the_outermost_polynomials_go_on():
    found = creased([(0.0, 0.5), (0.0, 1.0)]).evaluate(np.zeros(2, dtype=np.intp), np.array([(0.8, 0.0), (-0.4, 2.0)]))
    np.testing.assert_allclose(found[:, 0], [(0.8, 0.0, 0.8), (-0.4, 2.0, -0.4)])
