"""Distances between boundaries: to a sampled outline, to the patches under it, and how far either reaches beyond."""

from dataclasses import replace

import numpy as np
import pytest

from cadpanel.fitting.measures.boundary import outline_distances, overhang, polyline_distance
from cadpanel.geometry.shape import PolygonShape
from tests.instances import random_polygon
from tests.known_panels import alone
from tests.shapes import folded_panel, moved

EXACT = 1e-9
RADIUS = 300.0
COUNT = 17


def arc(angles):
    """Points of an arc, which leaves the plane so that no coordinate is idle."""
    return np.stack([RADIUS * np.cos(angles), RADIUS * np.sin(angles), 40.0 * angles], axis=-1)


ANGLES = np.linspace(0.2, 1.4, COUNT)
STEP = ANGLES[1] - ANGLES[0]
# Half-way between two points the chord is off by this, mm.
SAGITTA = RADIUS * (1.0 - np.cos(STEP / 2.0))


# ------------------------------------------------------------------------------------------------ to a sampled outline
@pytest.mark.parametrize("segment", range(COUNT - 1))
@pytest.mark.parametrize("share", [0.15, 0.5, 0.85])
def test_a_point_of_a_curve_is_on_it_wherever_it_lies_between_the_curves_points(segment, share):
    """The first and the last segment take the cubic of the four outermost points, the others that of those around."""
    point = arc(ANGLES[segment] + share * STEP)
    assert SAGITTA > 0.2
    (found,) = polyline_distance(point[None, None], arc(ANGLES)[None])[0]
    # The error of a cubic is of the fourth order in the step, that of a chord of the second.
    assert found <= 0.01 * SAGITTA


@pytest.mark.parametrize("off", [0.05, 1.0, 20.0])
def test_a_point_off_a_curve_is_as_far_from_it_as_it_was_moved(off):
    angles = ANGLES[:-1] + 0.5 * STEP
    outwards = np.stack([np.cos(angles), np.sin(angles), 0.0 * angles], axis=-1)
    found = polyline_distance((arc(angles) + off * outwards)[None], arc(ANGLES)[None])[0]
    assert found == pytest.approx(np.full(COUNT - 1, off), abs=0.01 * SAGITTA)


def test_a_point_is_as_far_from_a_straight_line_as_from_its_segment_or_its_end():
    line = np.linspace([0.0, 0.0, 0.0], [100.0, 0.0, 0.0], 6)
    points = np.array([[50.0, 3.0, 4.0], [13.0, 0.0, 2.0], [-3.0, 4.0, 0.0], [106.0, 0.0, 8.0], [100.0, 0.0, 0.0]])
    found = polyline_distance(points[None], line[None])[0]
    assert found == pytest.approx([5.0, 2.0, 5.0, 10.0, 0.0], abs=EXACT)


def test_points_of_a_line_with_a_kink_are_on_it():
    line = np.array([[0.0, 0.0, 0.0], [30.0, 0.0, 0.0], [60.0, 0.0, 0.0], [60.0, 40.0, 0.0], [60.0, 80.0, 0.0]])
    points = np.array([[45.0, 0.0, 0.0], [60.0, 20.0, 0.0], [60.0, 60.0, 0.0]])
    assert polyline_distance(points[None], line[None])[0] == pytest.approx(np.zeros(3), abs=EXACT)


def test_points_that_repeat_make_no_distance():
    line = np.repeat(np.linspace([0.0, 0.0, 0.0], [90.0, 0.0, 0.0], 4), 3, axis=0)
    points = np.array([[10.0, 1.0, 0.0], [45.0, 0.0, 2.0], [90.0, 0.0, 0.0]])
    assert polyline_distance(points[None], line[None])[0] == pytest.approx([1.0, 2.0, 0.0], abs=EXACT)


def test_each_panel_has_a_line_of_its_own():
    lines = np.array([arc(ANGLES), arc(ANGLES) + np.array([0.0, 0.0, 500.0])])
    points = np.array([arc(ANGLES), arc(ANGLES)])
    found = polyline_distance(points, lines)
    assert found[0] == pytest.approx(np.zeros(COUNT), abs=EXACT)
    assert found[1].min() > 100.0


# ------------------------------------------------------------------------------------------------------- to the patches
@pytest.mark.parametrize("by", [0.0, 0.5, -12.0])
def test_an_outline_off_the_skin_is_as_far_from_its_patches(by):
    fold = folded_panel(half_angle=0.02)
    found = outline_distances([fold], alone(fold.offset(by)))
    assert found.shape[0] == 1
    assert found == pytest.approx(np.full(found.shape, abs(by)), abs=EXACT)


def test_an_outline_within_the_surface_is_on_the_patches_however_far_it_is_trimmed():
    fold = folded_panel()
    shorter = folded_panel(length=700.0, widths=(150.0, 120.0))
    assert outline_distances([fold], alone(moved(shorter, (0.0, -50.0, 0.0)))).max() == pytest.approx(0.0, abs=EXACT)


def test_panels_with_fewer_edges_are_measured_by_their_own():
    shapes = [random_polygon(1, 3), random_polygon(2, 6)]
    assert outline_distances(shapes, alone(*shapes)).max() <= EXACT
    assert overhang(shapes, alone(*shapes)) == pytest.approx([0.0, 0.0], abs=EXACT)


# ------------------------------------------------------------------------------------------------------------- overhang
@pytest.mark.parametrize("by", [-25.0, -1.0, 1.0, 25.0])
def test_a_boundary_reaches_beyond_by_what_it_is_longer_or_shorter(by):
    fold, other = folded_panel(), folded_panel(length=1000.0 + 2.0 * by)
    assert overhang([other], alone(fold)) == pytest.approx([abs(by)], abs=1e-3)


@pytest.mark.parametrize("by", [-25.0, 25.0])
def test_a_flange_that_is_wider_or_narrower_shows_at_its_free_edge(by):
    fold, other = folded_panel(), folded_panel(widths=(200.0, 200.0 + by))
    assert overhang([other], alone(fold)) == pytest.approx([abs(by)], abs=1e-3)


def test_a_dent_in_the_reference_shows_only_on_the_way_from_the_reference():
    """Between its points the skin's edge is straight: from there the way to the dented outline is short enough."""
    corners = np.array(
        [[0.0, 0.0, 0.0], [800.0, 0.0, 0.0], [900.0, 500.0, 0.0], [400.0, 800.0, 0.0], [-100.0, 500.0, 0.0]]
    )
    shape = PolygonShape(name="a", feature="planar-polygon", outline=corners, normal=np.array([0.0, 0.0, 1.0]))
    whole = alone(shape)
    (panel,) = whole.panels
    first = panel.edges[0].copy()
    first[16, 1] -= 30.0
    dented = replace(whole, panels=(replace(panel, edges=(first, *panel.edges[1:])),))
    assert overhang([shape], dented) == pytest.approx([30.0], abs=EXACT)
    assert overhang([shape], whole) == pytest.approx([0.0], abs=EXACT)


def test_a_spike_of_the_skin_shows_only_on_the_way_from_the_skin():
    """Its edges pass by the reference's all the way; only its tip is far from any point of them."""
    corners = np.array([[0.0, 0.0, 0.0], [1000.0, 10.0, 0.0], [0.0, 20.0, 0.0]])
    shape = PolygonShape(name="a", feature="planar-polygon", outline=corners, normal=np.array([0.0, 0.0, 1.0]))
    longer = replace(shape, outline=corners + np.array([[0.0] * 3, [100.0, 0.0, 0.0], [0.0] * 3]))
    assert overhang([longer], alone(shape)) == pytest.approx([100.0], abs=0.1)


def test_between_the_points_of_an_outline_an_arc_is_no_overhang():
    """The chord is off by its sagitta, which is no distance between two panels that are the same."""
    fold = folded_panel(radius=400.0, sweep=1.5)
    assert overhang([fold], alone(fold))[0] <= 1e-3
