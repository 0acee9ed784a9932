"""Places of a flat pattern lie on the panel where folding takes them, and back again, on every feature."""

from __future__ import annotations

import math

import numpy as np
import pytest

from cadpanel.geometry.flat_places import flat_places
from cadpanel.geometry.patches import ConePatch
from cadpanel.geometry.unroll import unroll
from tests.chains import FEATURES
from tests.flat_panels import panels
from tests.shapes import folded_panel

NEAR = 1e-8  # mm
OFFSETS = (0.0, 4.0)


@pytest.mark.parametrize("offset", OFFSETS)
@pytest.mark.parametrize("name", sorted(FEATURES))
def test_places_on_the_skin_are_found_again_in_the_plane_and_keep_their_distances(name: str, offset: float) -> None:
    shape = panels(name, 8)[0]
    pattern = unroll(shape, offset)
    for patch, place in enumerate(flat_places(shape, pattern, offset)):
        row = pattern.owners.index(patch)
        middle = pattern.curves.points(np.full((len(pattern.curves), 1), 0.5))[row, 0] + [0.0, 30.0]
        random = np.random.default_rng(patch)
        flat = middle + random.uniform(-40.0, 40.0, (20, 2))
        points, normals = place.on_skin(flat)
        for lift in (0.0, offset, -9.0):
            assert np.abs(place.in_plane(points + lift * normals, lift) - flat).max() < NEAR
        # A short step on the unrolled surface is as long as in the plane.
        steps = 1e-3 * random.normal(size=(20, 2))
        moved, turned = place.on_skin(flat + steps)
        ways = moved + offset * turned - points - offset * normals
        assert np.linalg.norm(ways, axis=-1) == pytest.approx(np.linalg.norm(steps, axis=-1), rel=1e-5)
        assert np.abs((ways * normals).sum(axis=-1)).max() < 1e-6


def test_corners_lie_where_the_panel_has_them() -> None:
    for name in ("plane-cone-plane", "cone-spline-4", "polygon of 5"):
        shape = panels(name, 2)[0]
        pattern = unroll(shape, 0.0)
        places = flat_places(shape, pattern, 0.0)
        for row, patch in enumerate(pattern.owners):
            point = places[patch].on_skin(pattern.curves.start[row][None])[0]
            assert np.linalg.norm(shape.corners().reshape(-1, 3) - point, axis=-1).min() < NEAR


@pytest.mark.parametrize("half_angle", [0.0, 1e-9, 1e-5, 0.02, -0.02])
def test_cones_go_over_into_cylinders(half_angle: float) -> None:
    shape = folded_panel(chain="c", widths=(), turns=(), half_angle=half_angle, radius=300.0)
    pattern = unroll(shape)
    (place,) = flat_places(shape, pattern, 0.0)
    flat = np.array([[120.0, 300.0], [40.0, 700.0]])
    points, _ = place.on_skin(flat)
    assert np.abs(place.in_plane(points, 0.0) - flat).max() < NEAR
    patch = shape.patches[0]
    assert isinstance(patch, ConePatch)
    radii = place.normal_radii(flat)
    level = 300.0 + np.tan(half_angle) * (flat[:, 1] - 500.0)
    assert radii == pytest.approx(level, abs=30.0 * abs(half_angle) + 1e-9)


@pytest.mark.parametrize("half_angle", [0.4, -0.4])
@pytest.mark.parametrize("offset", [0.0, 5.0])
def test_a_cone_is_bent_as_its_distance_from_the_apex_says(half_angle: float, offset: float) -> None:
    shape = folded_panel(chain="c", widths=(), turns=(), half_angle=half_angle, radius=600.0)
    pattern = unroll(shape, offset)
    (place,) = flat_places(shape, pattern, offset)
    apex = place.origin - (600.0 + offset) / math.tan(half_angle) * place.along
    flat = place.origin + np.array([[0.0, 0.0], [300.0, 0.0], [-150.0, 200.0], [80.0, -170.0]])
    away = np.linalg.norm(flat - apex, axis=-1)
    assert place.normal_radii(flat) == pytest.approx(abs(math.tan(half_angle)) * away, rel=1e-12)
