"""Where a plane meets a cone's generatrices, followed by the angle and by the height: one curve, told both ways."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cadpanel.geometry.cone_sections import axis_frame
from cadpanel.geometry.patches import ConePatch
from cadpanel.geometry.plane_section import PlaneSection, corner_angles, plane_section
from cadpanel.geometry.vectors import unit
from tests.shapes import random_panel

STEP = 1e-3  # mm


def section(seed: int, *, concave: bool):
    """A plane that runs about as the generatrix at a third of a random cone's sweep, and what it is in."""
    shape = random_panel(seed, concave=concave)
    patch = shape.patches[1]
    assert isinstance(patch, ConePatch)
    frame = axis_frame(shape.points[1], shape.directions[1], shape.normals[1], patch)
    random = np.random.default_rng(seed)
    near = np.array([0.3 * frame.sweep])
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
