"""Every refusal: a panel that just passes, the smallest change that fails, and the panel's name in the message."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from cadpanel.errors import PanelError
from cadpanel.geometry.chain_checks import (
    FRAME_TOLERANCE,
    LARGEST_HALF_ANGLE,
    LARGEST_RADIUS,
    POINT_TOLERANCE,
    SMALLEST_CUT_COSINE,
    SMALLEST_RADIUS,
    check_chain,
)
from cadpanel.geometry.cone_sections import axis_frame
from cadpanel.geometry.limits import LARGEST_COORDINATE, SMALLEST_LENGTH
from cadpanel.geometry.patches import ConePatch
from cadpanel.geometry.sheet_checks import check_buildable
from tests.shapes import CHAINS, folded_panel, moved, random_panel

# A thickness that leaves the smallest radius of a bend of both together to the last digit, mm.
THIN = 0.0625


def refused(shape, reason, thickness=3.0, skin_side="outer"):
    with pytest.raises(PanelError, match=reason) as caught:
        check_buildable(shape, thickness, skin_side)
    assert caught.value.panel == shape.name
    assert caught.value.reason.count(".") >= 1


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


def test_frames_and_walks_may_be_off_by_just_their_tolerances():
    """A plane whose normals lean, whose second ruling turns, and whose second point stands off."""
    flat = folded_panel(chain="p", widths=(300.0,), turns=(0.0,))
    lean = np.array([FRAME_TOLERANCE, 0.0, 0.0])
    replace(flat, normals=flat.normals + lean).check()
    turned, off = np.zeros((2, 3)), np.zeros((2, 3))
    turned[1, 1], off[1, 2] = FRAME_TOLERANCE, POINT_TOLERANCE
    replace(flat, normals=flat.normals + turned).check()
    replace(flat, points=flat.points + off).check()
    for changed in (
        replace(flat, normals=flat.normals + 1.001 * lean),
        replace(flat, normals=flat.normals + 1.001 * turned),
        replace(flat, points=flat.points + 1.001 * off),
    ):
        with pytest.raises(PanelError, match=r"orthonormal|walk the rulings"):
            changed.check()


def test_a_fold_of_just_half_a_turn_is_refused():
    refused(folded_panel(sweep=math.pi), "less than 180")
    folded_panel(sweep=math.nextafter(math.pi, 0.0)).check()


def test_a_bend_of_just_the_smallest_radius_and_width_passes():
    cone = folded_panel(chain="c", widths=(), turns=(), radius=SMALLEST_RADIUS, sweep=1.0)
    cone.check()
    check_buildable(folded_panel(radius=THIN + SMALLEST_RADIUS), THIN)
    tight = folded_panel(chain="c", widths=(), turns=(), radius=math.nextafter(SMALLEST_RADIUS, 0.0), sweep=1.1)
    refused(tight, "apex of patch 1 falls inside")
    narrow = folded_panel(chain="c", widths=(), turns=(), radius=SMALLEST_RADIUS, sweep=math.nextafter(1.0, 0.0))
    refused(narrow, "patch 1 is only 0.1 mm wide")


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_sheet_on_the_outside_of_a_sharp_bend_may_be_as_thick_as_it_likes(side):
    bend = folded_panel(radius=side * 0.2, sweep=side * 1.0)
    for thickness in (0.05, 1.0, 50.0):
        check_buildable(bend, thickness, "inner" if side > 0.0 else "outer")


def leaning_cuts(cosine):
    """A flat panel whose cuts lean to the rulings by an angle with a cosine."""
    normal = np.array([cosine, math.sqrt(1.0 - cosine**2), 0.0])
    return replace(folded_panel(chain="p", widths=(9.0,), turns=(0.0,)), cut_normals=np.array([normal, normal]))


def test_a_cut_at_just_the_least_angle_to_a_ruling_passes():
    leaning_cuts(SMALLEST_CUT_COSINE).check()
    refused(leaning_cuts(math.nextafter(SMALLEST_CUT_COSINE, 0.0)), "nearly parallel")


@pytest.mark.parametrize("degrees", [9.0, 0.5, -30.0, -90.0])
def test_the_angle_of_a_ruling_to_its_cut_is_told(degrees):
    normal = (math.sin(math.radians(degrees)), math.cos(math.radians(degrees)), 0.0)
    shape = folded_panel(chain="p", widths=(9.0,), turns=(0.0,), cut_normals=(normal, normal))
    refused(shape, f"ruling 1 runs at {degrees:.4g} degrees to the cut plane at the start")


@pytest.mark.parametrize("half_angle", [0.4, -0.6])
def test_a_cut_along_the_axis_of_a_cone_is_refused(half_angle):
    shape = folded_panel(chain="c", widths=(), turns=(), radius=2000.0, half_angle=half_angle, length=200.0)
    sign = math.copysign(1.0, half_angle)
    along = np.array([sign * math.sin(half_angle), 0.0, sign * math.cos(half_angle)])
    refused(replace(shape, cut_normals=np.array([along, along])), "no ellipse")


def test_a_flange_of_just_the_smallest_width_passes_and_one_by_a_last_digit_narrower_does_not():
    folded_panel(chain="p", widths=(SMALLEST_LENGTH,), turns=(0.0,)).check()
    refused(folded_panel(chain="p", widths=(math.nextafter(SMALLEST_LENGTH, 0.0),), turns=(0.0,)), "turns inside out")


def test_a_panel_of_just_the_smallest_length_passes_and_one_by_some_digits_shorter_does_not():
    folded_panel(length=SMALLEST_LENGTH).check()
    refused(folded_panel(length=SMALLEST_LENGTH - 1e-15), "cross inside the panel")


def test_a_corner_just_as_far_out_as_may_be_passes():
    moved(folded_panel(length=1000.0), (LARGEST_COORDINATE - 500.0, 0.0, 0.0)).check()
    refused(moved(folded_panel(length=1000.0), (LARGEST_COORDINATE - 499.0, 0.0, 0.0)), "local origin")


@pytest.mark.parametrize("radius", [200.0, -200.0])
def test_a_fold_that_does_not_turn_is_refused_by_its_sweep(radius):
    refused(folded_panel(radius=radius, sweep=0.0), "fold of patch 2 turns inside out")


def test_a_radius_of_nothing_is_refused_by_its_radius_and_small_ones_pass():
    refused(folded_panel(radius=0.0), "the normal radius of patch 2 is 0 mm")
    for radius in (0.2, 0.25, 1.0, -0.25):
        folded_panel(radius=radius, sweep=math.copysign(1.0, radius)).check()


@pytest.mark.parametrize("field", ["directions", "normals", "cut_normals"])
@pytest.mark.parametrize(("longer", "passes"), [(1e-11, True), (-1e-11, True), (1e-9, False), (-1e-9, False)])
def test_every_frame_and_cut_must_be_of_length_one(field, longer, passes):
    shape = folded_panel()
    changed = replace(shape, **{field: getattr(shape, field) * (1.0 + longer)})
    if passes:
        changed.check()
    else:
        refused(changed, "orthonormal")


@pytest.mark.parametrize("lean", [1e-9, -1e-9])
@pytest.mark.parametrize("ruling", [0, 1, 2, 3])
def test_every_normal_must_be_square_to_its_ruling(ruling, lean):
    shape = folded_panel()
    normals = shape.normals.copy()
    normals[ruling] += lean * shape.directions[ruling]
    refused(replace(shape, normals=normals), "orthonormal")


@pytest.mark.parametrize("by", [1e-7, -1e-7])
@pytest.mark.parametrize("what", ["half_angle", "sweep"])
def test_rulings_must_follow_from_every_number_of_a_cone(what, by):
    shape = folded_panel(half_angle=0.05)
    cone = shape.patches[1]
    assert isinstance(cone, ConePatch)
    changed = replace(cone, **{what: getattr(cone, what) + by})
    refused(replace(shape, patches=(shape.patches[0], changed, shape.patches[2])), "walk the rulings")


def square_to_its_axis(half_angle, side):
    """A cone that is cut square to its axis, some 100 mm from it at its tightest."""
    radius = side * 150.0 + 200.0 * math.tan(half_angle)
    shape = folded_panel(
        chain="c", widths=(), turns=(), radius=radius, half_angle=half_angle, sweep=side * 1.2, length=200.0
    )
    axis = np.array([math.cos(half_angle), 0.0, -math.sin(half_angle)])
    return replace(shape, cut_normals=np.array([axis, axis]))


@pytest.mark.parametrize("half_angle", [0.0, 0.2, 0.4, -0.4])
@pytest.mark.parametrize(("side", "skin_side"), [(1.0, "outer"), (-1.0, "inner")])
def test_the_room_that_is_told_is_the_thickest_sheet_that_can_be_built(half_angle, side, skin_side):
    """Told with four digits, of a cone that is cut square to its axis; on its outside there is room for any sheet."""
    shape = square_to_its_axis(half_angle, side)
    with pytest.raises(PanelError) as caught:
        check_buildable(shape, 2000.0, skin_side)
    found = re.search("patch 1 allows, (.*) mm at its tightest", str(caught.value))
    assert found is not None, caught.value
    room = float(found.group(1))
    check_buildable(shape, 0.995 * room, skin_side)
    refused(shape, "thicker than the radius of patch 1 allows", 1.001 * room, skin_side)
    check_buildable(shape, 1.5 * room, "inner" if skin_side == "outer" else "outer")


def lengths_between_cuts(shape, cut_points):
    """Along many generatrices of a cone alone, mm."""
    (patch,) = shape.patches
    frame = axis_frame(shape.points[0], shape.directions[0], shape.normals[0], patch)
    angles = np.linspace(0.0, patch.sweep, 801)
    at = frame.points(angles, np.zeros(len(angles)))
    along = frame.points(angles, np.ones(len(angles))) - at
    ends = [
        (point - at) @ normal / (along @ normal) for point, normal in zip(cut_points, shape.cut_normals, strict=True)
    ]
    return ends[1] - ends[0]


@settings(max_examples=25)
@given(st.integers(0, 10_000), st.booleans(), st.floats(0.2, 0.5), st.sampled_from([0.11, 0.09, -5.0]))
def test_cuts_may_come_as_near_to_each_other_within_a_cone_as_at_its_rulings(seed, concave, lean, left):
    """Wherever over the sweep it is, in cones that widen either way; how much is left is told."""
    random = np.random.default_rng(seed)
    shape = random_panel(seed, chain="cone", half_angle=float(random.uniform(-0.2, 0.2)), concave=concave, length=600.0)
    middle = shape.normals.mean(axis=0) * (-1.0 if concave else 1.0)
    leaning = shape.cut_normals + lean * np.array([[-1.0], [1.0]]) * middle / np.linalg.norm(middle)
    shape = replace(shape, cut_normals=leaning / np.linalg.norm(leaning, axis=1, keepdims=True))
    first, way = shape.cut_points[0], shape.directions.mean(axis=0)
    low, high = -3000.0, 3000.0  # how far apart the cuts stand
    for _ in range(60):
        apart = 0.5 * (low + high)
        lengths = lengths_between_cuts(shape, [first, first + apart * way])
        low, high = (apart, high) if lengths.min() < left else (low, apart)
    assume(min(lengths[0], lengths[-1]) > 1.0)
    shape = replace(shape, cut_points=np.array([first, first + apart * way]))
    if left > 0.1:
        shape.check()
        return
    with pytest.raises(PanelError, match=r"cross inside the panel: only .* are left between them on patch 1") as caught:
        shape.check()
    found = re.search("only (.*) mm are left", str(caught.value))
    assert found is not None
    assert float(found.group(1)) == pytest.approx(left, rel=0.2, abs=2e-3)
