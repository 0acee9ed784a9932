"""Polygons of flat sheet: area, volume, edges, and every refusal with a neighbour that passes."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cadpanel.errors import PanelError
from cadpanel.geometry.limits import LARGEST_COORDINATE, SMALLEST_LENGTH, THICKEST_SHEET, THINNEST_SHEET
from cadpanel.geometry.polygon_checks import FLATNESS, check_polygon, polygon_area
from cadpanel.geometry.shape import PolygonShape, edge_corners
from cadpanel.geometry.sheet_checks import check_buildable, other_face
from cadpanel.geometry.volume import sheet_volume
from tests.instances import random_polygon
from tests.shapes import folded_panel

seeds, counts = st.integers(0, 10_000), st.integers(3, 9)


def flat(*corners, name="A-01"):
    """A polygon in the plane z = 0, its normal upwards."""
    outline = np.array([(*corner, 0.0)[:3] for corner in corners], dtype=float)
    return PolygonShape(name=name, feature="planar-polygon", outline=outline, normal=np.array([0.0, 0.0, 1.0]))


def square(side=1000.0):
    return flat((0.0, 0.0), (side, 0.0), (side, side), (0.0, side))


def passes(shape):
    check_polygon(shape)
    shape.check()
    check_buildable(shape, 3.0)


def refused(shape, reason):
    for check in (check_polygon, PolygonShape.check, lambda one: check_buildable(one, 3.0)):
        with pytest.raises(PanelError, match=reason) as caught:
            check(shape)
        assert caught.value.panel == shape.name
        assert caught.value.reason.endswith(".")


# ------------------------------------------------------------------------------------------------------------ measures
def test_areas_and_volumes_are_those_of_closed_forms():
    triangle = flat((0.0, 0.0), (300.0, 0.0), (0.0, 400.0))
    assert polygon_area(triangle) == pytest.approx(60_000.0, rel=1e-14)
    assert square().area() == pytest.approx(1e6, rel=1e-14)
    for skin_side in ("outer", "inner"):
        assert sheet_volume(triangle, 2.5, skin_side) == pytest.approx(150_000.0, rel=1e-14)


@given(seeds, counts)
def test_the_area_is_that_of_the_triangles_about_any_point(seed, count):
    shape = random_polygon(seed, count)
    spans = shape.outline - np.random.default_rng(seed).uniform(-1000.0, 1000.0, 3)
    area = 0.5 * (np.cross(spans, np.roll(spans, -1, axis=0)) @ shape.normal).sum()
    assert polygon_area(shape) == pytest.approx(area, rel=1e-9)
    passes(shape)


@given(seeds, counts, st.integers(0, 8))
def test_it_does_not_matter_which_corner_is_told_first(seed, count, first):
    shape = random_polygon(seed, count)
    turned = replace(shape, outline=np.roll(shape.outline, first, axis=0))
    assert polygon_area(turned) == pytest.approx(polygon_area(shape), rel=1e-12)


@given(seeds, counts, st.floats(-100.0, 100.0))
def test_the_other_face_is_parallel_and_as_large(seed, count, distance):
    shape = random_polygon(seed, count)
    away = shape.offset(distance)
    assert (away.outline - shape.outline) @ shape.normal == pytest.approx(distance, abs=1e-9)
    assert polygon_area(away) == pytest.approx(polygon_area(shape), rel=1e-9)
    assert other_face(shape, 3.0, "inner").outline == pytest.approx(shape.offset(3.0).outline, abs=1e-12)
    assert other_face(shape, 3.0, "outer").outline == pytest.approx(shape.offset(-3.0).outline, abs=1e-12)


def test_a_polygon_has_no_cones_to_straighten():
    shape = random_polygon(1, 5)
    straight = shape.straightened()
    assert straight.shape is shape
    assert (straight.patches, straight.largest_move) == ((), 0.0)
    assert [patch.kind for patch in shape.patches] == ["plane"]


# ------------------------------------------------------------------------------------------------------------ refusals
@pytest.mark.parametrize("number", [math.nan, math.inf])
def test_numbers_that_are_not_finite_are_refused(number):
    passes(square())
    refused(flat((0.0, 0.0), (number, 0.0), (0.0, 1000.0)), "not finite")
    refused(replace(square(), normal=np.array([0.0, 0.0, number])), "not finite")


@pytest.mark.parametrize(("distance", "fine"), [(LARGEST_COORDINATE, True), (LARGEST_COORDINATE * 1.001, False)])
def test_map_coordinates_are_refused(distance, fine):
    shape = flat((distance - 1000.0, 0.0), (distance, 0.0), (distance, 1000.0))
    if fine:
        passes(shape)
    else:
        refused(shape, "move the model to a local origin")


@pytest.mark.parametrize(("off", "fine"), [(0.9 * FLATNESS, True), (3.0 * FLATNESS, False), (1.0, False)])
def test_a_corner_off_the_plane_is_refused(off, fine):
    shape = flat((0.0, 0.0), (1000.0, 0.0, off), (1000.0, 1000.0), (0.0, 1000.0))
    if fine:
        passes(shape)
    else:
        refused(shape, "off their plane")


def test_corners_just_as_far_off_their_plane_as_may_be_pass():
    off = FLATNESS
    passes(flat((0.0, 0.0, off), (1000.0, 0.0, -off), (1000.0, 1000.0, off), (0.0, 1000.0, -off)))
    off = math.nextafter(FLATNESS, 1.0)
    refused(flat((0.0, 0.0, off), (1000.0, 0.0, -off), (1000.0, 1000.0, off), (0.0, 1000.0, -off)), "off their plane")


@pytest.mark.parametrize(
    ("length", "fine"),
    [(1.01 * SMALLEST_LENGTH, True), (0.99 * SMALLEST_LENGTH, False), (0.0, False)],
)
def test_an_edge_too_short_is_refused_by_its_number(length, fine):
    shape = flat((0.0, 0.0), (1000.0, 0.0), (1000.0, 1000.0), (1000.0 - length, 1000.0), (0.0, 500.0))
    if fine:
        passes(shape)
    else:
        refused(shape, "edge 2 is only .* merge its two corners")


@pytest.mark.parametrize("size", [1.5 * SMALLEST_LENGTH, 0.3, 1.0, 1e6])
def test_a_square_of_any_size_passes_as_long_as_its_edges_are_long_enough(size):
    """And one whose edges keep away from each other by less than a millimetre."""
    passes(square(size))
    passes(flat((0.0, 0.0), (size, 0.0), (size, size), (0.0, size), (0.8 * size, 0.5 * size)))


@given(seeds, counts)
def test_its_plane_and_first_edge_are_its_ruling(seed, count):
    shape = random_polygon(seed, count)
    point, direction, normal = shape.rulings()
    edge = shape.outline[1] - shape.outline[0]
    assert point == pytest.approx(shape.outline[:1])
    assert np.linalg.norm(edge) * direction[0] == pytest.approx(edge, abs=1e-9)
    assert normal == pytest.approx(shape.normal[None])


@pytest.mark.parametrize("away", [0.0, 2.0**23, 2.0**30])
def test_where_a_polygon_stands_costs_its_area_no_digits(away):
    """From its first corner, the numbers are as small as the panel."""
    shape = flat((0.0, 0.0), (0.5, 0.0), (0.5, 0.25), (0.0, 0.25))
    assert polygon_area(replace(shape, outline=shape.outline + away)) == 0.125


def test_an_edge_of_just_the_smallest_length_passes():
    passes(flat((0.0, 0.0), (SMALLEST_LENGTH, 0.0), (1000.0, 1000.0), (0.0, 1000.0)))


@given(seeds, counts)
def test_an_outline_that_runs_the_wrong_way_is_refused(seed, count):
    shape = random_polygon(seed, count)
    refused(replace(shape, outline=shape.outline[::-1]), "turned inside out")
    refused(replace(shape, normal=-shape.normal), "turned inside out")


@pytest.mark.parametrize(("x", "fine"), [(-300.0, True), (999.0, True), (1000.0, False), (1001.0, False)])
def test_edges_that_meet_or_cross_are_refused(x, fine):
    """A corner is pulled across the panel until it touches the opposite edge; the area stays positive."""
    shape = flat((0.0, 0.0), (1000.0, 0.0), (1000.0, 1000.0), (0.0, 1000.0), (x, 400.0))
    assert polygon_area(shape) > 0.0
    if fine:
        passes(shape)
    else:
        refused(shape, "crosses itself")


def test_a_corner_of_four_that_is_pulled_through_the_edge_before_it_is_refused():
    """Of four edges two that do not share a corner are next but one."""
    through = flat((0.0, 0.0), (1000.0, 0.0), (700.0, 900.0), (300.0, -50.0))
    assert polygon_area(through) > 0.0
    refused(through, "crosses itself")
    passes(flat((0.0, 0.0), (1000.0, 0.0), (700.0, 900.0), (300.0, 50.0)))


def test_corners_in_one_line_are_refused():
    refused(flat((0.0, 0.0), (1000.0, 0.0), (2000.0, 0.0)), "crosses itself or is turned inside out")


def test_a_bow_tie_is_refused_although_its_edges_are_long():
    refused(flat((0.0, 0.0), (1000.0, 0.0), (0.0, 600.0), (1000.0, 1000.0)), "crosses itself or is turned inside out")
    refused(flat((0.0, 0.0), (1000.0, 1000.0), (1000.0, 0.0), (0.0, 600.0)), "crosses itself or is turned inside out")


@pytest.mark.parametrize("thickness", [True, "3", None, 3j])
def test_a_thickness_that_is_no_number_is_refused(thickness):
    with pytest.raises(PanelError, match=r"the sheet thickness is .* give a number"):
        check_buildable(square(), thickness)


@pytest.mark.parametrize("thickness", [THINNEST_SHEET, THICKEST_SHEET])
def test_a_sheet_of_a_thickness_within_the_limits_passes_and_one_beyond_is_refused(thickness):
    check_buildable(square(), thickness)
    beyond = thickness * (0.99 if thickness == THINNEST_SHEET else 1.01)
    with pytest.raises(PanelError, match="the sheet thickness is"):
        check_buildable(square(), beyond)


# --------------------------------------------------------------------------------------------------------------- edges
def test_edges_of_a_chain_are_its_ends_and_its_sides():
    corners = folded_panel().corners()
    assert np.array_equal(edge_corners(corners, "end 0"), corners[0])
    assert np.array_equal(edge_corners(corners, "end 1"), corners[1])
    assert np.array_equal(edge_corners(corners, "side 0"), corners[:, 0])
    assert np.array_equal(edge_corners(corners, "side 1"), corners[:, -1])


@pytest.mark.parametrize("count", [3, 5, 6])
def test_edges_of_a_polygon_follow_each_other(count):
    corners = random_polygon(2, count).corners()
    edges = [edge_corners(corners, f"edge {i}") for i in range(count)]
    for one, other in zip(edges, edges[1:] + edges[:1], strict=True):
        assert np.array_equal(one[1], other[0])
    assert np.array_equal(edges[0][0], corners[0, 0])


@pytest.mark.parametrize("edge", ["end 2", "side 2", "edge 0", "end", "end -1", "end x", "", "corner 0"])
def test_an_edge_that_a_chain_does_not_have_is_an_error(edge):
    with pytest.raises(ValueError, match="has no edge"):
        edge_corners(folded_panel().corners(), edge)


@pytest.mark.parametrize("edge", ["edge 5", "end 0", "side 1", "edge -1", "edge"])
def test_an_edge_that_a_polygon_does_not_have_is_an_error(edge):
    corners = random_polygon(2, 5).corners()
    assert edge_corners(corners, "edge 4").shape == (2, 3)
    with pytest.raises(ValueError, match="has no edge"):
        edge_corners(corners, edge)
