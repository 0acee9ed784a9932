"""Normals of planes and cones, and the angles between them along the straight edges that they share."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cadpanel.geometry.cone_sections import axis_frame
from cadpanel.geometry.kink import EDGE_POINTS, edge_angles, surface_normals
from cadpanel.geometry.patches import ConePatch
from cadpanel.geometry.vectors import unit
from tests.shapes import CHAINS, random_panel

seeds = st.integers(0, 10_000)
chains = st.sampled_from(sorted(CHAINS))
ROUNDING = 1e-9


def surface_of(shape, index):
    """The surface of a patch as nine numbers."""
    patch = shape.patches[index]
    if not isinstance(patch, ConePatch):
        return np.array([*shape.points[index], *shape.normals[index], 0.0, 0.0, 1.0])
    frame = axis_frame(shape.points[index], shape.directions[index], shape.normals[index], patch)
    side = np.sign(patch.radius)
    return np.array([*frame.center, *frame.axis, abs(patch.radius), side * patch.half_angle, side])


def drawn(random, count):
    """Planes, cylinders and cones of some metres, none of which has its apex near."""
    axes = unit(random.normal(size=(count, 3)))
    radius = np.where(np.arange(count) % 3 == 0, 0.0, 1.0)
    angle = np.where(np.arange(count) % 3 == 2, random.uniform(-0.5, 0.5, count), 0.0)
    side = np.where(random.uniform(size=count) < 0.5, -1.0, 1.0)
    return np.column_stack([random.normal(size=(count, 3)), axes, radius, angle, side])


@given(seeds, chains, st.booleans())
def test_normals_along_a_ruling_are_those_of_the_ruling_on_both_patches(seed, chain, concave):
    """On convex and concave cones that widen either way, from end to end."""
    shape = random_panel(seed, chain=chain, concave=concave and "c" in CHAINS[chain])
    for index in range(len(shape.patches)):
        for ruling in (index, index + 1):
            normals = surface_normals(shape.corners()[:, ruling], surface_of(shape, index)[None])
            assert normals == pytest.approx(np.tile(shape.normals[ruling], (2, 1)), abs=ROUNDING)


@given(seeds, chains)
def test_patches_of_a_chain_meet_without_an_angle(seed, chain):
    shape = random_panel(seed, chain=chain)
    inner = np.arange(1, len(shape.patches))
    surfaces = [[surface_of(shape, index - 1), surface_of(shape, index)] for index in inner]
    edges = shape.corners()[:, 1:-1].swapaxes(0, 1)
    assert edge_angles(edges, np.array(surfaces).reshape(len(inner), 2, 9)) == pytest.approx(0.0, abs=1e-7)


@given(seeds, st.sampled_from([1e-6, 0.1, 3.0]))
def test_two_planes_meet_at_the_angle_by_which_one_is_turned(seed, turn):
    along, across, out = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))[0].T
    turned = np.cos(turn) * out + np.sin(turn) * across
    planes = [[*np.zeros(3), *normal, 0.0, 0.0, 1.0] for normal in (out, turned)]
    assert edge_angles(np.array([[np.zeros(3), along]]), np.array([planes])) == pytest.approx([turn], rel=1e-7)


@given(seeds)
def test_the_greatest_angle_between_the_ends_of_an_edge_counts(seed):
    """Between any two surfaces, which need not touch: from one end of the edge to the other, and no farther."""
    random = np.random.default_rng(seed)
    edges = random.normal(size=(6, 2, 3))
    surfaces = np.stack([drawn(random, 6), drawn(random, 7)[1:]], axis=1)
    for edge, pair, found in zip(edges, surfaces, edge_angles(edges, surfaces), strict=True):
        angles = []
        for share in np.linspace(0.0, 1.0, EDGE_POINTS):
            point = (1.0 - share) * edge[0] + share * edge[1]
            one, other = (surface_normals(point, of) for of in pair)
            angles.append(np.arccos(np.clip(one @ other, -1.0, 1.0)))
        assert found == pytest.approx(max(angles), abs=1e-6)


@pytest.mark.parametrize("size", [1e-3, 0.2, 1.0, 1e4])
def test_normals_do_not_hang_on_the_unit_of_length(size):
    random = np.random.default_rng(3)
    surfaces, points = drawn(random, 9), random.normal(size=(9, 3))
    scaled = surfaces * np.array([size] * 3 + [1.0] * 3 + [size, 1.0, 1.0])
    found = surface_normals(size * points, scaled)
    assert found == pytest.approx(surface_normals(points, surfaces), abs=ROUNDING)
    assert np.linalg.norm(found, axis=-1) == pytest.approx(1.0)


def test_no_edges_have_no_angles():
    assert edge_angles(np.zeros((0, 2, 3)), np.zeros((0, 2, 9))).shape == (0,)
