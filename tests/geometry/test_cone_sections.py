"""The exact ellipse in which a cut plane meets a cone patch."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cadpanel.geometry.cone_sections import as_pieces, axis_frame, cut_cone, elliptic_section, lifted, radius_range
from cadpanel.geometry.patches import ConePatch
from cadpanel.geometry.shape import PanelShape
from tests.shapes import folded_panel, random_panel

HALF_ANGLES = [0.0, 1e-13, 1e-12, 1e-9, 1e-6, 5e-6, 1e-4, 1e-2, 0.1, -1e-12, -1e-6, -1e-2, -0.1]
LENGTH_ERROR = 1e-9  # mm, at coordinates of 20 m


def cone_of(shape: PanelShape):
    index = next(i for i, patch in enumerate(shape.patches) if isinstance(patch, ConePatch))
    patch = shape.patches[index]
    assert isinstance(patch, ConePatch)
    return index, patch, axis_frame(shape.points[index], shape.directions[index], shape.normals[index], patch)


panels = st.builds(
    random_panel,
    st.integers(0, 10_000),
    half_angle=st.sampled_from(HALF_ANGLES),
    concave=st.booleans(),
    mitre=st.just(0.6),
)


@pytest.mark.parametrize("half_angle", [0.3, -0.2, 0.0])
@pytest.mark.parametrize("sweep", [0.2, 1.4, 3.0, -0.2, -1.4, -3.0])
@pytest.mark.parametrize("slant", [(0.1, -0.1), (0.2, 0.4), (-0.3, 0.2), (-0.1, -0.5), (0.0, 0.0)])
def test_a_cone_is_cut_in_the_plane_all_over_its_sweep(half_angle, sweep, slant):
    """Between the corners, along the generatrices of the angles, at the heights that are told."""
    radius = math.copysign(900.0, sweep)
    shape = folded_panel(
        chain="c",
        half_angle=half_angle,
        radius=radius,
        sweep=sweep,
        widths=(),
        turns=(),
        cut_normals=2 * ((1.0, *slant),),
    )
    _, _, frame = cone_of(shape)
    sections = [
        elliptic_section(frame, cut_cone(frame, point, normal))
        for point, normal in zip(shape.cut_points, shape.cut_normals, strict=True)
    ]
    for end, section in enumerate(sections):
        assert 0.0 <= section.start < min(section.stop, 2.0 * math.pi)
        parameters = np.linspace(section.start, section.stop, 9)
        points = section.points(parameters)
        assert points[[0, -1]] == pytest.approx(shape.corners()[end], abs=LENGTH_ERROR)
        assert (points - shape.cut_points[end]) @ shape.cut_normals[end] == pytest.approx(0.0, abs=LENGTH_ERROR)
        angles, heights = section.sweep_angles(parameters), section.heights(parameters)
        assert frame.points(angles, heights) == pytest.approx(points, abs=LENGTH_ERROR)
        assert abs(section.cosine_axis @ section.sine_axis) < 1e-6
    pieces = as_pieces(sections)
    assert pieces.centers == pytest.approx(np.array([section.center for section in sections]))
    assert pieces.cosine_axes == pytest.approx(np.array([section.cosine_axis for section in sections]))
    assert pieces.sine_axes == pytest.approx(np.array([section.sine_axis for section in sections]))


@pytest.mark.parametrize("lift", [-30.0, 7.0])
@pytest.mark.parametrize("half_angle", [0.3, -0.2])
def test_a_parallel_cone_lies_at_the_same_angles_and_heights_along_the_normals(lift, half_angle):
    _, _, frame = cone_of(folded_panel(half_angle=half_angle))
    angles, heights = np.linspace(0.0, 1.0, 5), np.linspace(-200.0, 300.0, 5)
    wanted = frame.points(angles, heights) + lift * frame.normals(angles)
    assert lifted(frame, lift).points(angles, heights) == pytest.approx(wanted, abs=LENGTH_ERROR)


def test_no_arcs_are_an_empty_table():
    assert as_pieces([]).centers.shape == as_pieces([]).sine_axes.shape == (0, 3)


@given(panels, st.integers(0, 1))
def test_the_section_lies_in_the_cut_plane_and_on_the_cone(shape, end):
    index, patch, frame = cone_of(shape)
    section = elliptic_section(frame, cut_cone(frame, shape.cut_points[end], shape.cut_normals[end]))
    points = section.points(np.linspace(section.start, section.stop, 17))
    assert np.abs((points - shape.cut_points[end]) @ shape.cut_normals[end]).max() < LENGTH_ERROR
    offset = points - (shape.points[index] - patch.radius * shape.normals[index])
    along = offset @ frame.axis
    across = math.copysign(1.0, patch.radius) * np.linalg.norm(offset - np.outer(along, frame.axis), axis=1)
    signed = across * math.cos(patch.half_angle) - along * math.sin(patch.half_angle) - patch.radius
    assert np.abs(signed).max() < LENGTH_ERROR


@given(panels, st.integers(0, 1))
def test_the_section_runs_from_one_ruling_to_the_next(shape, end):
    index, _, frame = cone_of(shape)
    section = elliptic_section(frame, cut_cone(frame, shape.cut_points[end], shape.cut_normals[end]))
    ends = section.points(np.array([section.start, section.stop]))
    assert section.start < section.stop
    assert np.abs(ends - shape.corners()[end, index : index + 2]).max() < LENGTH_ERROR


@given(panels, st.integers(0, 1))
def test_sweep_angles_and_heights_lead_back_to_the_same_points(shape, end):
    _, _, frame = cone_of(shape)
    section = elliptic_section(frame, cut_cone(frame, shape.cut_points[end], shape.cut_normals[end]))
    parameters = np.linspace(section.start, section.stop, 9)
    again = frame.points(section.sweep_angles(parameters), section.heights(parameters))
    assert np.abs(again - section.points(parameters)).max() < LENGTH_ERROR


@given(panels, st.integers(0, 1))
def test_the_radius_range_holds_every_radius_of_the_section(shape, end):
    _, patch, frame = cone_of(shape)
    cut = cut_cone(frame, shape.cut_points[end], shape.cut_normals[end])
    section = elliptic_section(frame, cut)
    heights = section.heights(np.linspace(section.start, section.stop, 101))
    radii = frame.level_radius + heights * math.sin(patch.half_angle)
    low, high = radius_range(cut, patch.sweep)
    assert low - LENGTH_ERROR <= radii.min() < low + 0.1
    assert high - 0.1 < radii.max() <= high + LENGTH_ERROR


@given(st.integers(0, 1000), st.integers(0, 1), st.sampled_from([1e-12, -1e-12, 1e-9]))
def test_a_half_angle_that_vanishes_leaves_the_cylinder(seed, end, half_angle):
    sections = []
    for angle in (0.0, half_angle):
        shape = random_panel(seed, chain="cone", half_angle=angle)
        _, _, frame = cone_of(shape)
        section = elliptic_section(frame, cut_cone(frame, shape.cut_points[end], shape.cut_normals[end]))
        sections.append(section.points(np.linspace(section.start, section.stop, 9)))
    assert np.abs(sections[0] - sections[1]).max() < 1e4 * abs(half_angle) + LENGTH_ERROR


@pytest.mark.parametrize(("tilt", "elliptic"), [(44.9, True), (45.1, False)])
def test_a_cut_as_steep_as_the_cone_is_no_ellipse(tilt, elliptic):
    angle = math.radians(tilt)
    shape = folded_panel(chain="c", widths=(), turns=(), radius=2000.0, half_angle=math.radians(45.0), sweep=1.0)
    _, _, frame = cone_of(shape)
    cut = cut_cone(frame, shape.cut_points[1], math.cos(angle) * frame.axis + math.sin(angle) * frame.radial)
    if elliptic:
        assert elliptic_section(frame, cut).start >= 0.0
    else:
        with pytest.raises(ValueError, match="no ellipse"):
            elliptic_section(frame, cut)


def test_a_cut_along_the_axis_is_refused_and_one_that_leans_a_little_to_it_is_none():
    shape = folded_panel()
    _, _, frame = cone_of(shape)
    leaning = 0.1 * frame.axis + math.sqrt(0.99) * frame.radial
    assert cut_cone(frame, shape.cut_points[0], leaning).rise == pytest.approx(0.1)
    with pytest.raises(ValueError, match="does not cross the axis"):
        cut_cone(frame, shape.cut_points[0], frame.radial)


@given(panels, st.integers(0, 1))
def test_the_section_begins_within_the_first_turn_and_ends_within_one_more(shape, end):
    _, _, frame = cone_of(shape)
    section = elliptic_section(frame, cut_cone(frame, shape.cut_points[end], shape.cut_normals[end]))
    assert 0.0 <= section.start < 2.0 * math.pi
    assert 0.0 < section.stop - section.start < 2.0 * math.pi
