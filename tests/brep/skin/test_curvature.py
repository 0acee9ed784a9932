"""Curvature against closed forms: M. do Carmo, Differential Geometry of Curves and Surfaces, 1976, sections 3-3."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from OCP.Geom import Geom_Plane, Geom_SphericalSurface, Geom_ToroidalSurface
from OCP.gp import gp_Ax3, gp_Dir, gp_Pln, gp_Pnt

from cadpanel.brep.kernel.transforms import shifted
from cadpanel.brep.skin.curvature import DEVELOPABLE, FLAT, bending_of, curvature_of
from tests.cuts import surface_of
from tests.known_faces import arc_face, disc_on, face_on, graph_surface

GRID_ERROR = 2e-3  # part of an integral by which a grid of 31 x 31 middles misses it
AXES = gp_Ax3(gp_Pnt(0.0, 0.0, 0.0), gp_Dir(0.0, 0.0, 1.0))
TURN = 2.0 * np.pi
lengths = st.floats(500.0, 20_000.0)


def measured(face):
    (found,) = surface_of(face).faces
    return curvature_of(found)


@settings(max_examples=5)
@given(radius=lengths)
def test_a_whole_sphere_has_4_pi_and_its_own_radius(radius):
    found = measured(face_on(Geom_SphericalSurface(AXES, radius)))
    assert found.kind == "doubly curved"
    assert found.total_gaussian == pytest.approx(4.0 * np.pi, rel=GRID_ERROR)
    # Both principal curvatures are equal: the root of their difference keeps half the digits.
    assert found.smallest_radius == pytest.approx(radius, rel=1e-6)
    assert found.off_plane == pytest.approx(radius, rel=0.02)


@settings(max_examples=5)
@given(radius=lengths, degrees=st.floats(20.0, 170.0))
def test_a_cylinder_is_developable_and_has_its_radius(radius, degrees):
    found = measured(arc_face(radius, 0.0, degrees))
    assert found.kind == "developable"
    assert found.total_gaussian < 1e-9
    assert found.smallest_radius == pytest.approx(radius, rel=1e-9)


@settings(max_examples=5)
@given(tube=st.floats(200.0, 900.0))
def test_a_torus_has_8_pi_of_either_sign_and_the_radius_of_its_tube(tube):
    """K = cos v / (r (R + r cos v)), and dA = r (R + r cos v): the absolute values add up to 2 pi times 4."""
    found = measured(face_on(Geom_ToroidalSurface(AXES, 1000.0, tube)))
    assert found.total_gaussian == pytest.approx(8.0 * np.pi, rel=GRID_ERROR)
    # The inner equator bends by 1 / (R - r) the other way: the sharper of both counts.
    assert found.smallest_radius == pytest.approx(min(tube, 1000.0 - tube), rel=0.02)


def hessian_integral(hessian, origin, ways, count=200):
    """Of |K| dA over a parallelogram: for z = f(x, y), K = det H / (1 + |grad f|^2)^2 and dA = sqrt(1 + |grad f|^2)."""
    parts = (np.arange(count) + 0.5) / count
    places = origin + parts[:, None, None] * ways[0] + parts[None, :, None] * ways[1]
    steep = 1.0 + np.sum((places @ hessian) ** 2, axis=-1)
    return abs(np.linalg.det(hessian)) * np.mean(steep**-1.5) * abs(np.linalg.det(ways))


@settings(max_examples=12)
@given(
    bends=st.tuples(*[st.floats(-1.0, 1.0)] * 3),
    shear=st.floats(-0.8, 0.8),
    origin=st.tuples(*[st.floats(-500.0, 500.0)] * 2),
)
def test_a_paraboloid_or_saddle_has_the_curvature_of_its_hessian_in_whatever_parameters(bends, shear, origin):
    """Also where its parameter lines are neither lines of curvature nor square to each other."""
    hessian = np.array([[bends[0], bends[1]], [bends[1], bends[2]]]) * 1e-3
    ways = np.array([[1000.0, 1000.0 * shear], [-300.0 * shear, 800.0]])

    def height(x, y):
        return 0.5 * (hessian[0, 0] * x * x + hessian[1, 1] * y * y) + hessian[0, 1] * x * y

    found = measured(face_on(graph_surface(height, origin, *ways)))
    wanted = hessian_integral(hessian, np.array(origin), ways)
    assert found.total_gaussian == pytest.approx(wanted, rel=GRID_ERROR, abs=1e-6)


@pytest.mark.parametrize(
    ("first", "second", "mixed"),
    [(3.0, 1.0, 0.0), (1.0, 3.0, 0.0), (2.0, -5.0, 0.0), (0.0, 0.0, 4.0), (1.0, -1.0, 2.0), (-3.0, -1.0, 1.0)],
)
@pytest.mark.parametrize("shear", [0.0, 0.7])
def test_the_smallest_radius_is_that_of_the_larger_principal_curvature(first, second, mixed, shear):
    hessian = np.array([[first, mixed], [mixed, second]]) * 1e-4

    def height(x, y):
        return 0.5 * (hessian[0, 0] * x * x + hessian[1, 1] * y * y) + hessian[0, 1] * x * y

    # A small patch about the vertex, where the slope is 0 and the principal curvatures are those of the Hessian.
    face = face_on(graph_surface(height, (-20.0, -20.0 - 20.0 * shear), (40.0, 40.0 * shear), (0.0, 40.0)))
    sharpest = np.abs(np.linalg.eigvalsh(hessian)).max()
    assert measured(face).smallest_radius == pytest.approx(1.0 / sharpest, rel=1e-3)


@pytest.mark.parametrize("shear", [0.0, 0.7])
def test_the_normal_turns_as_it_differs_between_neighbouring_points(shear):
    """On a saddle whose parameter lines are not square to each other, on ways that lie along neither of them."""
    hessian = np.array([[8.0, 3.0], [3.0, -5.0]]) * 1e-4

    def height(x, y):
        return 0.5 * (hessian[0, 0] * x * x + hessian[1, 1] * y * y) + hessian[0, 1] * x * y

    def normals(places):
        """Of z = f(x, y), upwards."""
        up = np.column_stack([-places @ hessian, np.ones(len(places))])
        return up / np.linalg.norm(up, axis=-1, keepdims=True)

    (face,) = surface_of(
        face_on(graph_surface(height, (-300.0, -200.0), (900.0, 900.0 * shear), (-200.0, 700.0)))
    ).faces
    bent = bending_of(face.patch, 5)
    up = np.sign(bent.normals[:, 2:])
    assert bent.normals == pytest.approx(up * normals(bent.points[:, :2]), abs=1e-6)
    for parts in ((1.0, 0.0), (0.0, 1.0), (0.7, -1.3)):
        ways = sum(part * along for part, along in zip(parts, bent.along, strict=True))
        ways /= np.linalg.norm(ways, axis=-1, keepdims=True)
        ahead, behind = (normals(bent.points[:, :2] + way * ways[:, :2]) for way in (0.5, -0.5))
        assert bent.turn(ways) == pytest.approx(up * (ahead - behind), rel=1e-3, abs=1e-8)


def test_a_trimmed_face_counts_what_lies_within_its_border():
    """The curvature of this paraboloid falls away from its vertex, about which the disc lies."""

    def height(x, y):
        return 5e-4 * (x * x + y * y)

    surface = graph_surface(height, (-1000.0, -1000.0), (2000.0, 0.0), (0.0, 2000.0))
    found = measured(disc_on(surface, (0.5, 0.5), 0.25))
    # Over a disc of 500 mm, with k = 1e-3: pi k^2 times the integral of 2 r dr / (1 + k^2 r^2)^(3/2).
    wanted = 2.0 * np.pi * (1.0 - 1.0 / np.sqrt(1.0 + 0.25))
    assert found.total_gaussian == pytest.approx(wanted, rel=0.02)
    assert found.smallest_radius == pytest.approx(1000.0, rel=0.01)


def test_a_plane_is_flat_and_bends_nowhere():
    found = measured(face_on(Geom_Plane(gp_Pln()), (0.0, 1000.0), (0.0, 700.0)))
    assert (found.kind, found.smallest_radius) == ("flat", np.inf)
    assert found.off_plane == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize(("rise", "kind"), [(0.98, "flat"), (1.02, "developable")])
def test_a_twisted_face_is_flat_as_long_as_its_corners_keep_to_a_plane(rise, kind):
    """Corners go up and down in turn, so that the plane through the middle fits best."""
    side, rise = 1000.0, rise * FLAT
    twisted = graph_surface(lambda x, y: 4.0 * rise * x * y / side**2, (-500.0, -500.0), (side, 0.0), (0.0, side))
    found = measured(face_on(twisted))
    assert found.off_plane == pytest.approx(rise, rel=1e-6)
    assert found.kind == kind


@pytest.mark.parametrize(("part", "kind"), [(0.98, "developable"), (1.02, "doubly curved")])
def test_a_face_is_doubly_curved_from_a_small_solid_angle_on(part, kind):
    radius = 500_000.0
    half = 0.5 * np.sqrt(part * DEVELOPABLE)
    found = measured(face_on(Geom_SphericalSurface(AXES, radius), (0.0, 2.0 * half), (-half, half)))
    assert found.total_gaussian == pytest.approx(part * DEVELOPABLE, rel=1e-3)
    assert found.off_plane > FLAT
    assert found.kind == kind


@settings(max_examples=5)
@given(by=st.tuples(*[st.floats(-5000.0, 5000.0)] * 3))
def test_where_a_face_stands_does_not_matter(by):
    face = face_on(graph_surface(lambda x, y: 2e-4 * x * x - 1e-4 * x * y))
    here, there = measured(face), measured(shifted(face, by))
    assert there.kind == here.kind
    assert there.off_plane == pytest.approx(here.off_plane, rel=1e-6)
    assert there.total_gaussian == pytest.approx(here.total_gaussian, rel=1e-6)
    assert there.smallest_radius == pytest.approx(here.smallest_radius, rel=1e-6)
