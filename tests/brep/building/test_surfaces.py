"""Kernel surfaces of patches are the patches' own, to rounding, from steep cones through cylinders to hollow ones."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from OCP.gp import gp_Pnt, gp_Vec

from cadpanel.brep.building.surfaces import arc_on_round, generatrix_on_round, plane_surface, round_surface
from cadpanel.geometry.cone_sections import axis_frame, cut_cone, elliptic_section
from cadpanel.geometry.patches import ConePatch
from cadpanel.geometry.vectors import cross

ROUNDING = 1e-9  # mm, on lengths of metres
P, T, N = np.array([100.0, -200.0, 300.0]), np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])

half_angles = st.sampled_from([0.0, 1e-9, -1e-9, 1e-4, -1e-4, 0.05, -0.05, 0.3, -0.3])
radii = st.floats(200.0, 5000.0).flatmap(lambda radius: st.sampled_from([radius, -radius]))
patches = st.builds(ConePatch, radius=radii, half_angle=half_angles, sweep=st.floats(0.05, 1.5))
seeds = st.integers(0, 2**32 - 1)


def values(surface, parameters):
    """Points and unit normals (m, 3) of a kernel surface."""
    point, along_u, along_v = gp_Pnt(), gp_Vec(), gp_Vec()
    points, normals = [], []
    for u, v in parameters.tolist():
        surface.D1(u, v, point, along_u, along_v)
        points.append(point.Coord())
        normals.append(along_u.Crossed(along_v).Normalized().Coord())
    return np.array(points), np.array(normals)


@settings(max_examples=60)
@given(patch=patches, level=st.floats(-100.0, 100.0), seed=seeds)
def test_a_round_surface_has_the_patchs_points_and_normals(patch, level, seed):
    random = np.random.default_rng(seed)
    frame = axis_frame(P, T, N, patch)
    built = round_surface(frame, level)
    angles, heights = random.uniform(0.0, patch.sweep, 6), random.uniform(-150.0, 150.0, 6)
    points, normals = values(built.surface, built.parameters(angles, heights))
    np.testing.assert_allclose(points, frame.points(angles, heights), atol=ROUNDING)
    # The patch's normal: the radial direction where the radius is positive, tilted by the half angle.
    outward = np.cos(patch.half_angle) * frame.radials(angles) - np.sin(patch.half_angle) * frame.axis
    np.testing.assert_allclose(normals if built.agrees else -normals, outward, atol=1e-9)


@settings(max_examples=40)
@given(patch=patches, part=st.floats(0.0, 1.0), start=st.floats(-100.0, 100.0))
def test_a_generatrix_is_walked_by_length(patch, part, start):
    frame = axis_frame(P, T, N, patch)
    built = round_surface(frame, 0.0)
    line = generatrix_on_round(built, part * patch.sweep, start)
    for walked in (0.0, 37.0, 120.0):
        point = built.surface.Value(*line.Value(walked).Coord()).Coord()
        wanted = frame.points(np.array([part * patch.sweep]), np.array([start + walked]))[0]
        np.testing.assert_allclose(point, wanted, atol=ROUNDING)


@settings(max_examples=30, deadline=None)
@given(patch=patches, tilt=st.tuples(st.floats(-0.5, 0.5), st.floats(-0.5, 0.5)))
def test_an_arc_in_the_parameter_plane_is_the_ellipse_at_every_parameter(patch, tilt):
    frame = axis_frame(P, T, N, patch)
    normal = T + tilt[0] * N + tilt[1] * cross(N, T)
    section = elliptic_section(frame, cut_cone(frame, P, normal / np.linalg.norm(normal)))
    built = round_surface(frame, 0.0)
    curve = arc_on_round(built, section)
    places = np.linspace(section.start, section.stop, 23)
    found = np.array([curve.Value(place).Coord() for place in places.tolist()])
    np.testing.assert_allclose(values(built.surface, found)[0], section.points(places), atol=1e-7)
    # Around u = pi, clear of the seam.
    assert np.abs(found[:, 0] - np.pi).max() <= 0.5 * patch.sweep + 1e-6


@given(seed=seeds)
def test_a_plane_has_the_normal_that_is_wanted(seed):
    origin, normal, x_axis = np.random.default_rng(seed).normal(size=(3, 3))
    normal /= np.linalg.norm(normal)
    plane = plane_surface(origin, normal, x_axis)
    points, normals = values(plane.surface, np.array([(0.0, 0.0), (300.0, -200.0)]))
    np.testing.assert_allclose(points[0], origin, atol=1e-12)
    np.testing.assert_allclose(normals, [normal, normal], atol=1e-12)
    assert (points[1] - origin) @ normal == pytest.approx(0.0, abs=1e-9)
    assert plane.agrees
