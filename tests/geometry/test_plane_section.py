"""Where a plane meets a cone's generatrices, followed by the angle and by the height: one curve, told both ways."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cadpanel.geometry.cone_sections import AxisFrame, axis_frame
from cadpanel.geometry.patches import ConePatch
from cadpanel.geometry.plane_section import PlaneSection, corner_angles, plane_section
from cadpanel.geometry.shape import PanelShape
from cadpanel.geometry.vectors import unit
from tests.shapes import folded_panel, random_panel

STEP = 1e-3  # mm


def first_frame(shape: PanelShape) -> AxisFrame:
    """The frame of a cone that is the first patch."""
    patch = shape.patches[0]
    assert isinstance(patch, ConePatch)
    return axis_frame(shape.points[0], shape.directions[0], shape.normals[0], patch)


def section(seed: int, *, concave: bool, at: float = 0.3):
    """A plane that runs about as the generatrix at a part of a random cone's sweep, and what it is in."""
    shape = random_panel(seed, concave=concave)
    patch = shape.patches[1]
    assert isinstance(patch, ConePatch)
    frame = axis_frame(shape.points[1], shape.directions[1], shape.normals[1], patch)
    random = np.random.default_rng(seed)
    near = np.array([at * frame.sweep])
    (point,), (normal,) = frame.points(near, np.zeros(1)), frame.normals(near)
    across = np.sign(frame.sweep) * np.cross(frame.axis, frame.radials(near)[0]) * np.sign(frame.level_radius)
    tilted = unit(across + random.uniform(-0.5, 0.5) * normal + random.uniform(-0.05, 0.05) * frame.axis)
    return frame, plane_section(frame, point, tilted), near, (point, tilted)


@given(seed=st.integers(0, 10_000), concave=st.booleans())
def test_a_curve_followed_by_the_height_lies_in_its_plane_and_turns_as_its_derivative_says(seed, concave):
    frame, found, near, (point, normal) = section(seed, concave=concave)
    heights = np.linspace(-200.0, 200.0, 9)[None]
    way_out = np.sign(near)
    angles, turns = found.angles(heights, way_out, near)
    assert (frame.points(angles[0], heights[0]) - point) @ normal == pytest.approx(np.zeros(9), abs=1e-8)
    assert angles[0, 4] == pytest.approx(near[0], abs=1e-9)
    before, after = (found.angles(heights + step, way_out, near)[0] for step in (-STEP, STEP))
    assert turns == pytest.approx((after - before) / (2.0 * STEP), abs=1e-8)
    # The way out is the way in which the distance beyond the plane grows.
    out = frame.points(angles[0] + 1e-6 * way_out, heights[0])
    assert ((out - point) @ normal > 0.0).all()
    # Where the curve runs across generatrices at all, the angle tells the height, too.
    steep = np.abs(turns[0]) > 1e-6
    assert found.heights(angles)[0][0, steep] == pytest.approx(heights[0, steep], abs=1e-3)


@given(seed=st.integers(0, 10_000), concave=st.booleans())
def test_a_corner_lies_in_both_planes(seed, concave):
    frame, side, near, (point, normal) = section(seed, concave=concave)
    shape = random_panel(seed, concave=concave)
    ends = [plane_section(frame, *cut) for cut in zip(shape.cut_points, shape.cut_normals, strict=True)]
    both = PlaneSection(
        reach=np.concatenate([end.reach for end in ends]), rate=np.concatenate([end.rate for end in ends])
    )
    sides = PlaneSection(reach=np.tile(side.reach, (2, 1)), rate=np.tile(side.rate, (2, 1)))
    angles = corner_angles(both, sides, np.tile(near, 2))
    corners = frame.points(angles, both.heights(angles[:, None])[0][:, 0])
    assert (corners - point) @ normal == pytest.approx(np.zeros(2), abs=1e-8)
    off = np.einsum("ex,ex->e", corners - shape.cut_points, shape.cut_normals)
    assert off == pytest.approx(np.zeros(2), abs=1e-8)


@pytest.mark.parametrize("angle", [-2.5, -1.0, 1.0, 2.5])
@pytest.mark.parametrize("turns", [-1, 0, 2])
def test_of_an_angle_and_those_by_whole_turns_beside_it_the_one_near_by_is_found(angle, turns):
    frame = section(3, concave=False)[0]
    _, found, near, _ = section(3, concave=False, at=angle / frame.sweep)
    elsewhere = near + 2.0 * np.pi * turns
    angles = found.angles(np.zeros((1, 1)), np.ones(1), elsewhere)[0]
    assert angles[0] == pytest.approx(elsewhere, abs=1e-9)


def test_where_a_plane_ends_before_there_are_no_angles():
    """Of one that is parallel to a cone's axis: as far from that as the cone is wide at the height 0."""
    shape = folded_panel(chain="c", widths=(), turns=(), radius=100.0, half_angle=0.1)
    frame = first_frame(shape)
    top = frame.points(np.zeros(1), np.zeros(1))[0]
    found = plane_section(frame, top, frame.radial)
    angles = found.angles(np.array([[-100.0, -1.0, 1.0, 100.0, 300.0]]), np.ones(1), np.zeros(1))[0][0]
    assert np.isnan(angles).tolist() == [True, True, False, False, False]


@pytest.mark.parametrize("share", [0.15, 0.5, 2.5])
def test_corners_near_an_apex_and_far_from_it_are_found(share):
    """At so much of the cone's distance from its apex, where its width has changed by as much."""
    shape = folded_panel(chain="c", widths=(), turns=(), radius=300.0, half_angle=0.4, sweep=1.0)
    frame = first_frame(shape)
    height = np.array([(share - 1.0) * frame.level_radius / np.sin(0.4)])
    corner = np.array([0.5])
    (point,), (radial,) = frame.points(corner, height), frame.radials(corner)
    across = np.cross(frame.axis, radial)
    side = plane_section(frame, point, unit(across + 0.1 * frame.axis))
    end = plane_section(frame, point, unit(frame.axis + 0.2 * across))
    assert corner_angles(end, side, np.array([0.3])) == pytest.approx(corner, abs=1e-12)


@given(seed=st.integers(0, 10_000), concave=st.booleans())
def test_heights_change_with_the_angle_as_their_derivative_says(seed, concave):
    frame = section(seed, concave=concave)[0]
    point, (normal,) = frame.center, frame.normals(np.array([0.4]))
    found = plane_section(frame, point, unit(frame.axis + 0.3 * normal))
    angles = np.linspace(-1.0, 1.0, 5)[None]
    rates = found.heights(angles)[1]
    after, before = (found.heights(angles + turn)[0] for turn in (1e-5, -1e-5))
    assert rates == pytest.approx((after - before) / 2e-5, rel=1e-6, abs=1e-4)
