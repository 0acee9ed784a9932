"""What can be built just at a bound, and is refused just beyond it."""

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
    POINT_TOLERANCE,
    SMALLEST_CUT_COSINE,
    SMALLEST_RADIUS,
    check_chain,
    check_chain_sheet,
)
from cadpanel.geometry.cone_sections import axis_frame
from cadpanel.geometry.limits import LARGEST_COORDINATE, SMALLEST_LENGTH
from cadpanel.geometry.patches import ConePatch
from cadpanel.geometry.sheet_checks import check_buildable
from tests.geometry.refused import refused
from tests.shapes import folded_panel, moved, random_panel

# A thickness that leaves the smallest radius of a bend of both together to the last digit, mm.
THIN = 0.0625


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


def nearing_cuts(seed, concave, lean, left):
    """A cone whose cuts come as near to each other somewhere, and how far apart they are at its two rulings."""
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
    return replace(shape, cut_points=np.array([first, first + apart * way])), min(lengths[0], lengths[-1])


def passes_or_tells(shape, left):
    """A cone of which so much is left at its shortest passes if it is enough; how much it is else is told."""
    if left > SMALLEST_LENGTH:
        shape.check()
        return
    with pytest.raises(PanelError, match=r"cross inside the panel: only .* are left between them on patch 1") as caught:
        shape.check()
    found = re.search("only (.*) mm are left", str(caught.value))
    assert found is not None
    assert float(found.group(1)) == pytest.approx(left, rel=0.01, abs=2e-3)


LEFT = [0.11, 0.09, -5.0]


@pytest.mark.parametrize("left", LEFT)
@pytest.mark.parametrize(("seed", "concave"), [(1, False), (2, False), (3, True)])
def test_how_much_is_left_between_two_cuts_is_told(seed, concave, left):
    shape, at_rulings = nearing_cuts(seed, concave, 0.5, left)
    assert at_rulings > 1.0
    passes_or_tells(shape, left)


@settings(max_examples=25)
@given(st.integers(0, 10_000), st.booleans(), st.floats(0.2, 0.5), st.sampled_from(LEFT))
def test_cuts_may_come_as_near_to_each_other_within_a_cone_as_at_its_rulings(seed, concave, lean, left):
    """Wherever over the sweep it is, in cones that widen either way."""
    shape, at_rulings = nearing_cuts(seed, concave, lean, left)
    assume(at_rulings > 1.0)
    passes_or_tells(shape, left)


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize(("left", "passes"), [(0.15, True), (0.05, False)])
def test_the_other_face_of_a_square_sheet_may_come_as_near_to_its_axis_as_any(side, left, passes):
    """Where its ends lie on the skin's own normals, not in the planes that cut the skin."""
    bend = folded_panel(radius=side * 10.0, sweep=side * 1.2).squared(-side * 3.0)
    away = bend.offset(-side * (10.0 - left))
    if passes:
        check_chain_sheet(bend, away, 10.0 - left)
    else:
        with pytest.raises(PanelError, match="thicker than the radius of patch 2 allows, 10 mm at its tightest"):
            check_chain_sheet(bend, away, 10.0 - left)
        with pytest.raises(PanelError, match=r"apex of patch 2 falls inside .* comes down to 0.05 mm"):
            check_chain(away)
