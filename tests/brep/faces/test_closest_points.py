"""Feet are the nearest points of a face, on whichever of its layers they lie."""

import numpy as np
import pytest

from cadpanel.brep.faces.closest_points import Search
from cadpanel.brep.faces.face_patch import patch_of
from tests.brep.curves.test_drawn_curve import cut, polyline
from tests.reference_shapes import kernel_face

COUNT = 400
ON_IT = 1e-6  # mm


def hem(gap):
    """A sheet folded twice, its three layers a gap apart."""
    return lambda u, v: np.stack([150.0 * np.cos(3.0 * np.pi * u), 4000.0 * v, 3.0 * gap * u], axis=-1)


def spiral(gap):
    """A sheet that winds round twice."""

    def surface(u, v):
        angle, radius = 4.0 * np.pi * u, 1000.0 + 2.0 * gap * u
        return np.stack([radius * np.cos(angle), radius * np.sin(angle), 3000.0 * v], axis=-1)

    return surface


def slow(u, v):
    """A sheet whose parameters hardly move it along one border."""
    x = 6000.0 * u**4
    return np.stack([x, 4000.0 * v**3, 200.0 * np.sin(x / 900.0)], axis=-1)


def corrugated(u, v):
    return np.stack([6000.0 * u, 4000.0 * v, 100.0 * np.sin(20.0 * np.pi * u)], axis=-1)


FACES = {
    "hem 20": (hem(20.0), 60),
    "hem 5": (hem(5.0), 60),
    "spiral 50": (spiral(50.0), 80),
    "spiral 3": (spiral(3.0), 80),
    "slow": (slow, 30),
    "corrugated": (corrugated, 160),
}


@pytest.fixture(params=FACES)
def patch(request):
    surface, poles = FACES[request.param]
    return patch_of(kernel_face(surface, (0.0, 1.0), poles))


def places(patch):
    """Random parameters, all over the patch and on its borders."""
    parts = np.random.default_rng(7).uniform(size=(COUNT, 2))
    parts[:40] = np.round(parts[:40])
    return patch.at(0, parts[:, 0], parts[:, 1])


def test_points_of_a_face_are_their_own_feet(patch):
    points = patch.points(places(patch))
    feet = Search(patch).feet(points)
    assert feet.distances.max() <= ON_IT
    assert np.abs(patch.points(feet.parameters) - points).max() <= ON_IT


def test_foot_of_a_lifted_point_is_no_farther_than_it_was_lifted(patch):
    parameters = places(patch)
    height = 1.0
    points = patch.points(parameters) + height * patch.normals(parameters)
    assert Search(patch).feet(points).distances.max() <= height + ON_IT


def test_feet_stay_where_they_are_found(patch):
    points = patch.points(places(patch)) + np.array([0.0, 0.3, 0.4])
    search = Search(patch)
    feet = search.feet(points)
    again = search.feet(points, feet.parameters)
    assert again.parameters == pytest.approx(feet.parameters, abs=1e-6 * np.ptp(patch.bounds))


@pytest.mark.parametrize("gap", [20.0, 10.0])
def test_line_across_a_hem_cuts_all_its_layers(gap):
    face = kernel_face(hem(gap), (0.0, 1.0), 60)
    patch = patch_of(face)
    lines = [patch.points(patch.at(0, np.linspace(0.0, 1.0, 400), np.array([part]))) for part in (0.3, 0.6)]
    assert len(cut([face], [polyline(*line) for line in lines])) == 3
