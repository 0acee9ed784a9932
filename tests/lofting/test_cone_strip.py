"""Cones along a strip touch it and each other along rulings; those along a cone are that cone."""

import numpy as np
import pytest

from cadpanel.errors import LoftError
from cadpanel.features.catalogue import feature
from cadpanel.features.walk import walk
from cadpanel.lofting.cone_strip import cones_through, joints
from tests.known_rails import off_torse
from tests.known_strips import strip

APEX = np.array([0.0, 0.0, 500.0])


def between(curve):
    return curve.turning if curve.bend > 0 else curve.turning[::-1]


def stations(curve, count):
    return curve.stations(count)[:: curve.bend]


def walked(curve, count):
    """Points, ways b and normals of the edges of `count` cones, as a feature walks over them."""
    of = feature(f"cone-spline-{count}")
    cones = cones_through(curve, between(curve), count, of.anchor)
    values = np.zeros((1, len(of.numbers)))
    for patch, own in enumerate(cones.dimensions):
        values[0, of.patch_slice(patch)] = own
    edges = walk(of, values, derivatives=False).edges
    return cones.origin + edges.p[0] @ cones.axes.T, edges.b[0] @ cones.axes.T, edges.n[0] @ cones.axes.T


@pytest.mark.parametrize("name", ["torse", "cone", "cylinder"])
def test_cones_touch_the_strip_along_its_rulings(name):
    curve = strip(name)
    points, ways, normals = walked(curve, 6)
    s = stations(curve, 4)
    planes, rates = curve.planes(s), curve.bend * curve.velocities(s)
    assert normals[::2] == pytest.approx(planes[:, :3], abs=1e-9)
    # Every second edge lies in the strip's plane, and turns its way: the ruling is the strip's.
    assert np.abs(np.einsum("md,md->m", points[::2], planes[:, :3]) + planes[:, 3]).max() < 1e-7
    assert np.abs(np.einsum("md,md->m", points[::2], rates[:, :3]) + rates[:, 3]).max() < 1e-6
    assert ways[::2] == pytest.approx(curve.bend * rates[:, :3], abs=1e-9)


def test_cones_along_a_cone_are_that_cone_and_along_a_cylinder_are_cylinders():
    for name, half_angle in (("cone", -np.arctan(0.2)), ("cylinder", 0.0)):
        curve = strip(name, 16)
        cones = cones_through(curve, between(curve), 4, 1)
        assert cones.dimensions[:, 1] == pytest.approx(half_angle, abs=1e-4)
        assert np.ptp(cones.dimensions[:, 0]) < 0.05
        assert cones.dimensions[:, 2].sum() == pytest.approx(1.4, abs=1e-4)


def test_a_joint_of_planes_of_one_cone_is_a_plane_of_it():
    u, half_angle = np.array([0.1, 0.9, 1.4]), 0.3
    cosine, sine = np.cos(half_angle), np.sin(half_angle)
    normals = np.stack([cosine * np.cos(u), cosine * np.sin(u), np.full(3, sine)], axis=-1)
    rates = np.stack([-np.sin(u), np.cos(u), np.zeros(3)], axis=-1)
    planes = np.column_stack([normals, -normals @ APEX])
    found = joints(planes, np.column_stack([rates, -rates @ APEX]))
    assert np.linalg.norm(found[:, :3], axis=-1) == pytest.approx(1.0, abs=1e-12)
    assert found[:, 2] == pytest.approx(sine, abs=1e-12)
    assert found[:, :3] @ APEX + found[:, 3] == pytest.approx(0.0, abs=1e-9)
    with pytest.raises(LoftError, match="turn back"):
        joints(planes[::-1], np.column_stack([rates, -rates @ APEX]))


def test_twice_as_many_cones_are_eight_times_as_near():
    off = [off_torse(walked(strip("torse", 16), count)[0]).max() for count in (2, 4, 8)]
    assert off[0] > 8.0 * off[1] > 64.0 * off[2]


def test_an_odd_number_of_cones_is_refused():
    with pytest.raises(LoftError, match="two by two: 3 do not"):
        cones_through(strip("torse"), between(strip("torse")), 3, 1)
