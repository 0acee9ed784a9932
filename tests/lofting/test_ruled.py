"""Dual and primal form of a ruled surface are one: the dual's planes touch the surface at both ends of rulings."""

import numpy as np
import pytest

from cadpanel.brep.building.ruled_surface import ruled_of, ruled_surface
from cadpanel.errors import LoftError
from cadpanel.lofting.loft import loft
from cadpanel.lofting.ruled import RuledSurface, plane_distance
from tests.known_rails import TORSE, TWISTED, rails

SAME = 1e-12
RANDOM = np.random.default_rng(5)


def random_surface(degree=3, count=7):
    inner = np.linspace(0.0, 1.0, count - degree + 1)
    knots = np.concatenate([np.zeros(degree), inner, np.ones(degree)])
    places = np.stack(
        [np.linspace(0.0, 9.0, count)[:, None] + np.zeros(2), *RANDOM.uniform(0.0, 2.0, (2, count, 2))], axis=-1
    )
    places[:, 1, 1] += 5.0
    weights = RANDOM.uniform(0.5, 2.0, (count, 2, 1))
    return RuledSurface(degree, knots, np.concatenate([weights * places, weights], axis=-1))


SURFACE = random_surface()
U = RANDOM.uniform(0.01, 0.99, 50)


def unit(planes):
    return planes / np.linalg.norm(planes, axis=-1)[..., None]


@pytest.mark.parametrize(
    "surface", [SURFACE, random_surface(1, 2), random_surface(2, 5)], ids=["cubic", "line", "conic"]
)
def test_the_dual_form_holds_the_planes_that_touch_the_surface(surface):
    planes, dual = unit(surface.planes(U)), unit(surface.dual().at(U))
    assert np.abs(planes - dual).max() < SAME
    for end in (0, 1):
        v, step = np.full(len(U), float(end)), 1e-6
        normal = dual[:, end, :3]
        for other in (0.0, 0.4, 1.0):
            off = np.einsum("md,md->m", normal, surface.points(U, v * 0.0 + other)) + dual[:, end, 3]
            assert np.abs(off).max() < 100.0 * SAME
        along = surface.points(U + step, v) - surface.points(U - step, v)
        across = surface.points(U, v * 0.0 + 1.0) - surface.points(U, v * 0.0)
        wanted = unit(np.cross(along, across))
        assert np.abs(unit(normal) - wanted).max() < 1e-6
    assert np.array_equal(surface.dual().between(U, 0.0 * U), surface.dual().at(U)[:, 0])


def test_a_surface_is_developable_where_both_planes_are_one():
    assert SURFACE.disparity(U).min() > 1e-4
    torse, twisted = ([ruled.disparity(U).max() for ruled in loft(*rails(known)).ruled()] for known in (TORSE, TWISTED))
    assert max(torse) < 1e-7 < max(twisted)
    there = SURFACE.poles * [7.0, 7.0, 7.0, 1.0] + SURFACE.poles[..., 3:] * [50.0, 9.0, 0.0, 0.0]
    moved = RuledSurface(3, SURFACE.knots, there)
    assert moved.disparity(U) == pytest.approx(SURFACE.disparity(U), rel=1e-9)


def test_planes_are_as_far_apart_as_points_of_the_region_lie():
    points = RANDOM.uniform(-1.0, 1.0, (40, 3))
    one = np.array([0.0, 0.0, 2.0, 0.0])
    assert plane_distance(one, np.array([0.0, 0.0, 1.0, -3.0]), points) == pytest.approx(3.0)
    assert plane_distance(one, 5.0 * one, points) == 0.0


def test_the_kernel_s_surface_is_the_same_to_the_last_digit_and_comes_back():
    built = ruled_surface(SURFACE)
    for u, v in zip(U.tolist(), RANDOM.uniform(size=50).tolist(), strict=True):
        assert (
            np.abs(np.array(built.Value(u, v).Coord()) - SURFACE.points(np.array([u]), np.array([v]))[0]).max()
            < SAME * 10.0
        )
    back = ruled_of(built)
    assert back.degree == SURFACE.degree
    assert np.array_equal(back.knots, SURFACE.knots)
    assert np.abs(back.poles - SURFACE.poles).max() < SAME
    built.ExchangeUV()
    turned = ruled_of(built)
    assert np.abs(turned.poles - SURFACE.poles).max() < SAME


def test_what_is_no_ruled_surface_is_refused():
    with pytest.raises(LoftError, match="weights above 0"):
        RuledSurface(3, SURFACE.knots, -SURFACE.poles)
    with pytest.raises(LoftError, match="n \\+ degree"):
        RuledSurface(2, SURFACE.knots, SURFACE.poles)
