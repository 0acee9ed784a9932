"""Every refusal: a panel that just passes, the smallest change that fails, and the panel's name in the message."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cadpanel.errors import PanelError
from cadpanel.geometry.chain_checks import (
    LARGEST_HALF_ANGLE,
    LARGEST_RADIUS,
    check_chain,
)
from cadpanel.geometry.patches import ConePatch
from cadpanel.geometry.sheet_checks import check_buildable
from tests.geometry.refused import refused
from tests.shapes import CHAINS, folded_panel, moved, random_panel


@given(st.integers(0, 10_000), st.sampled_from(sorted(CHAINS)), st.booleans())
def test_panels_of_building_size_are_buildable(seed, chain, concave):
    check_buildable(random_panel(seed, chain=chain, concave=concave), 3.0)


@pytest.mark.parametrize("field", ["points", "directions", "normals", "cut_points", "cut_normals"])
@pytest.mark.parametrize("number", [math.nan, math.inf])
def test_numbers_that_are_not_finite_are_refused(field, number):
    shape = folded_panel()
    array = getattr(shape, field).copy()
    array[0, 0] = number
    refused(replace(shape, **{field: array}), "not finite")


@pytest.mark.parametrize("field", ["radius", "half_angle", "sweep"])
def test_patch_numbers_that_are_not_finite_are_refused(field):
    shape = folded_panel()
    numbers = {"radius": 200.0, "half_angle": 0.0, "sweep": 1.0, field: math.nan}
    cone = ConePatch(radius=numbers["radius"], half_angle=numbers["half_angle"], sweep=numbers["sweep"])
    patches = (shape.patches[0], cone, shape.patches[2])
    refused(replace(shape, patches=patches), "not finite")


def test_a_side_that_is_none_is_refused():
    refused(folded_panel(), "the skin side is 'left'; give outer or inner", skin_side="left")


@pytest.mark.parametrize("thickness", [0.0, -1.0, 1e-9, 1e308, math.nan, math.inf])
def test_a_thickness_that_is_not_positive_is_refused(thickness):
    refused(folded_panel(), "thickness", thickness)


def test_too_few_rulings_are_refused():
    shape = folded_panel()
    refused(replace(shape, points=shape.points[:3]), "rulings")


def test_frames_must_be_orthonormal():
    shape = folded_panel()
    replace(shape, directions=shape.directions * (1.0 + 1e-11)).check()
    refused(replace(shape, directions=shape.directions * (1.0 + 1e-9)), "orthonormal")


def test_rulings_must_follow_from_the_patches():
    shape = folded_panel()
    aside = np.array([[0.0] * 3, [0.0] * 3, [0.0, 0.0, 1.0], [0.0, 0.0, 1.0]])
    replace(shape, points=shape.points + 1e-9 * aside).check()
    refused(replace(shape, points=shape.points + 1e-7 * aside), "walk the rulings")


def test_a_point_may_slide_along_its_ruling():
    shape = folded_panel()
    replace(shape, points=shape.points + np.array([[1.0], [20.0], [-30.0], [4.0]]) * shape.directions).check()


@pytest.mark.parametrize("along", [0.3, -200.0])
def test_where_a_cone_ends_the_point_may_slide_along_its_own_ruling_too(along):
    """Not along another one, which leans against it."""
    shape = folded_panel(half_angle=0.3)
    behind = np.array([[0.0], [0.0], [along], [along]])
    replace(shape, points=shape.points + behind * shape.directions).check()
    refused(replace(shape, points=shape.points + behind * shape.directions[0]), "walk the rulings")


@pytest.mark.parametrize(("end_radius", "passes"), [(0.2, True), (0.05, False), (-5.0, False)])
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_an_apex_inside_the_panel_is_refused(end_radius, passes, side):
    half_angle = 0.1
    radius = (500.0 * math.sin(half_angle) + end_radius) / math.cos(half_angle)
    # Both cuts square to the ruling, so that its own end is the tightest place.
    shape = folded_panel(chain="c", widths=(), turns=(), radius=side * radius, half_angle=half_angle, sweep=side * 1.0)
    if passes:
        shape.check()
    else:
        with pytest.raises(PanelError, match="apex of patch 1 falls inside"):
            shape.check()


@pytest.mark.parametrize(("tilt", "passes"), [(41.0, True), (43.0, False), (89.0, False)])
def test_a_cut_too_oblique_for_an_ellipse_is_refused(tilt, passes):
    shape = folded_panel(
        chain="c", widths=(), turns=(), radius=4000.0, half_angle=math.radians(45.0), sweep=0.5, length=500.0
    )
    axis = np.array([1.0, 0.0, -1.0]) / math.sqrt(2.0)
    radial = np.array([1.0, 0.0, 1.0]) / math.sqrt(2.0)
    cut = math.cos(math.radians(tilt)) * axis + math.sin(math.radians(tilt)) * radial
    shape = replace(shape, cut_normals=np.array([cut, cut]))
    if passes:
        shape.check()
    else:
        with pytest.raises(PanelError, match="no ellipse"):
            shape.check()


@pytest.mark.parametrize(("tilt", "passes"), [(79.0, True), (81.0, False), (90.0, False), (120.0, False)])
def test_a_ruling_parallel_to_a_cut_is_refused(tilt, passes):
    normal = (math.cos(math.radians(tilt)), math.sin(math.radians(tilt)), 0.0)
    shape = folded_panel(cut_normals=(normal, normal))
    if passes:
        check_buildable(shape, 3.0)
    else:
        refused(shape, "nearly parallel")


@pytest.mark.parametrize(("left", "passes"), [(0.2, True), (0.05, False), (-20.0, False)])
def test_cuts_that_cross_at_an_edge_are_refused(left, passes):
    slope = (1000.0 - left) / (2.0 * 300.0)
    shape = folded_panel(chain="p", widths=(300.0,), turns=(0.0,), cut_normals=((1.0, slope, 0.0), (1.0, -slope, 0.0)))
    if passes:
        shape.check()
    else:
        with pytest.raises(PanelError, match="cross inside the panel"):
            shape.check()


@pytest.mark.parametrize(("left", "passes"), [(0.2, True), (0.05, False), (-20.0, False)])
def test_cuts_that_cross_only_between_two_rulings_are_refused(left, passes):
    # On a cylinder of radius 200 swept by 2 rad, cuts that lean along the middle radial meet first in the middle.
    middle = np.array([0.0, -math.sin(1.0), math.cos(1.0)])
    rise = 200.0 * (1.0 - math.cos(1.0))
    slope = (1000.0 - left) / (2.0 * rise)
    shape = folded_panel(chain="c", widths=(), turns=(), sweep=2.0)
    cuts = np.array([np.array([1.0, 0.0, 0.0]) - slope * middle, np.array([1.0, 0.0, 0.0]) + slope * middle])
    cuts /= np.linalg.norm(cuts, axis=1, keepdims=True)
    shape = replace(shape, cut_normals=cuts)
    if passes:
        shape.check()
    else:
        with pytest.raises(PanelError, match="on patch 1"):
            shape.check()


@pytest.mark.parametrize(("turn", "passes"), [(0.37, True), (0.39, False)])
def test_a_flange_that_turns_inside_out_is_refused(turn, passes):
    shape = folded_panel(turns=(0.0, turn))
    if passes:
        shape.check()
    else:
        refused(shape, "flange of patch 3 turns inside out")


def test_a_sweep_against_the_radius_is_refused():
    refused(folded_panel(sweep=-1.0), "turns inside out")


@pytest.mark.parametrize(("sweep", "passes"), [(3.14, True), (3.15, False)])
def test_a_fold_of_half_a_turn_is_refused(sweep, passes):
    shape = folded_panel(sweep=sweep)
    if passes:
        shape.check()
    else:
        refused(shape, "less than 180")


@pytest.mark.parametrize(("thickness", "passes"), [(199.8, True), (200.05, False), (500.0, False)])
@pytest.mark.parametrize(("side", "skin_side"), [(1.0, "outer"), (-1.0, "inner")])
def test_a_sheet_thicker_than_its_inner_radius_is_refused(thickness, passes, side, skin_side):
    shape = folded_panel(radius=side * 200.0, sweep=side * 1.0)
    if passes:
        check_buildable(shape, thickness, skin_side)
    else:
        refused(shape, "thicker than the radius of patch 2 allows", thickness, skin_side)


def test_a_sheet_on_the_outside_of_the_bend_may_be_thicker_than_its_radius():
    check_buildable(folded_panel(), 300.0, "inner")


@pytest.mark.parametrize(("last_width", "passes"), [(90.0, True), (500.0, False)])
def test_a_fold_that_runs_into_itself_is_refused(last_width, passes):
    shape = folded_panel(
        chain="pcpcp", radius=50.0, sweep=3.0, widths=(300.0, 200.0, last_width), turns=(0.0, 0.0, 0.0)
    )
    if passes:
        shape.check()
    else:
        refused(shape, "runs into itself")


@pytest.mark.parametrize(("distance", "passes"), [(9e6, True), (1.1e7, False)])
def test_map_coordinates_are_refused(distance, passes):
    shape = moved(folded_panel(), (distance, 0.0, 0.0))
    if passes:
        shape.check()
    else:
        refused(shape, "local origin")


def test_a_patch_as_flat_as_a_plane_is_refused():
    refused(folded_panel(radius=1e9, sweep=1e-6), "use a plane")


@pytest.mark.parametrize(("sweep", "passes"), [(1e-3, True), (4e-4, False)])
def test_a_patch_without_width_is_refused(sweep, passes):
    shape = folded_panel(sweep=sweep)
    if passes:
        shape.check()
    else:
        refused(shape, "wide at the")


def test_a_half_angle_near_a_right_angle_is_refused():
    refused(folded_panel(half_angle=1.45), "half angle")


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_half_angle_is_refused_from_just_beyond_the_largest_one_on(side):
    """Only that is told of here: what else is wrong with so steep a cone is another refusal's matter."""

    def said(half_angle):
        with pytest.raises(PanelError) as refused:
            check_chain(folded_panel(half_angle=side * half_angle))
        return str(refused.value)

    assert "the half angle of patch 2" not in said(LARGEST_HALF_ANGLE)
    assert "the half angle of patch 2" in said(math.nextafter(LARGEST_HALF_ANGLE, 2.0))


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_radius_is_refused_from_just_beyond_the_largest_one_on(side):
    def said(radius):
        sweep = side * 300.0 / radius
        try:
            check_chain(folded_panel(radius=side * radius, sweep=sweep))
        except PanelError as error:
            return str(error)
        return ""

    assert "the normal radius of patch 2" not in said(LARGEST_RADIUS)
    assert "the normal radius of patch 2" in said(math.nextafter(LARGEST_RADIUS, math.inf))
