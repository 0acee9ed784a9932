"""What an author may say of a feature: its patches, numbers that are fixed or bounded, and what is refused and why."""

import math
from typing import Any

import numpy as np
import pytest

from cadpanel.errors import SettingsError
from cadpanel.features.catalogue import CATALOGUE, for_corners, polygon
from cadpanel.features.catalogue import feature as named
from cadpanel.features.feature import MOST_PATCHES, Feature
from cadpanel.features.numbers import LARGEST, Number
from cadpanel.features.patches import Cone, Cylinder, Plane
from cadpanel.features.polygon import MOST_CORNERS, Polygon
from tests.chains import CHAINS, COMPOSED, FEATURES
from tests.thorough import cases

every_feature = pytest.mark.parametrize("name", sorted(FEATURES))

INDEPENDENT = {
    "planar-rectangle": 8,
    "planar-quadrilateral": 11,
    "cylinder-parallel": 11,
    "cylinder": 13,
    "cone": 14,
    "plane-cylinder-plane": 17,
    "plane-cone-plane": 18,
    "tri-cone": 20,
    "plane-cone-cone-plane": 21,
    "plane-cone-plane-cone-plane": 23,
}


def number_of(of, name):
    return next(number for number in of.numbers if number.name == name)


@pytest.mark.parametrize("name", sorted(CATALOGUE))
def test_catalogue_features_have_as_many_independent_numbers_as_their_kind_of_panel(name):
    of = named(name)
    assert len(of.free) == INDEPENDENT[name]
    assert of.name == name


@pytest.mark.parametrize("corners", [3, 5, 6, 7])
def test_a_polygon_has_three_numbers_for_its_plane_and_two_for_each_corner(corners):
    assert len(Polygon(corners).free) == 3 + 2 * corners


def test_a_polygon_with_four_corners_is_a_chain_with_as_many_numbers():
    of = polygon(4)
    assert isinstance(of, Feature)
    assert len(of.free) == 3 + 2 * 4
    assert of.name == polygon(5).name == "planar-polygon"


@pytest.mark.parametrize(
    ("name", "count"), [("plane-cone-plane", 16), ("plane-cylinder-plane", 15), ("cone", 12), ("cylinder", 11)]
)
def test_fixed_tilt_takes_one_number_from_each_end(name, count):
    assert len(named(name, tilt="fixed").free) == count


def test_fixed_tilt_changes_nothing_where_cuts_are_not_mitred():
    for name, entry in CATALOGUE.items():
        assert (named(name, tilt="fixed") == named(name)) == (entry.cuts != "mitre")


@pytest.mark.parametrize("cones", cases([1, 4], [1, 4, MOST_PATCHES]))
def test_a_cone_spline_has_three_numbers_a_cone(cones):
    assert len(named(f"cone-spline-{cones}").free) == 5 + 3 * cones + 6


@pytest.mark.parametrize("cones", [0, MOST_PATCHES + 1])
def test_a_cone_spline_of_too_few_or_too_many_cones_is_refused(cones):
    with pytest.raises(SettingsError, match=f"between 1 and {MOST_PATCHES} cones, not {cones}"):
        named(f"cone-spline-{cones}")


def test_a_feature_by_corners_is_a_chain_whatever_the_panel_or_a_polygon_that_fits_it():
    assert for_corners("cone")(4) is for_corners("cone")(6)
    assert for_corners("planar-polygon")(6).corner_count == 6
    with pytest.raises(SettingsError, match="there is no feature 'sphere'"):
        for_corners("sphere")


def test_an_unknown_feature_is_refused_with_those_that_exist():
    with pytest.raises(SettingsError) as refused:
        named("plane-sphere-plane")
    assert all(name in str(refused.value) for name in (*CATALOGUE, "planar-polygon", "cone-spline-K"))


def test_an_unknown_tilt_is_refused():
    loose: Any = "loose"
    with pytest.raises(SettingsError, match="'free' or 'fixed'"):
        named("plane-cone-plane", tilt=loose)


def test_unknown_cuts_are_refused_with_those_that_exist():
    askew: Any = "askew"
    with pytest.raises(SettingsError, match="mitre, upright, parallel, square, not 'askew'"):
        Feature(Cone(), cuts=askew)


@pytest.mark.parametrize("count", [0, MOST_PATCHES + 1])
def test_a_chain_without_patches_or_with_too_many_is_refused(count):
    with pytest.raises(SettingsError, match=f"between 1 and {MOST_PATCHES} patches, not {count}"):
        Feature(*count * [Cone()])


@pytest.mark.parametrize("corners", [3, MOST_CORNERS])
def test_a_polygon_has_as_many_corners_as_panels_may_have(corners: int) -> None:
    assert Polygon(corners).corner_count == corners


@pytest.mark.parametrize("corners", [2, MOST_CORNERS + 1])
def test_a_polygon_with_too_few_or_too_many_corners_is_refused(corners):
    with pytest.raises(SettingsError, match=f"between 3 and {MOST_CORNERS} corners, not {corners}"):
        Polygon(corners)


def test_a_feature_is_named_by_its_patches_unless_it_is_given_a_name():
    assert Feature(Plane(), Cylinder(), Plane()).name == "plane-cylinder-plane"
    assert Feature(Cone(), name="gutter").name == "gutter"


def test_the_anchor_is_the_curved_patch_nearest_to_the_middle():
    anchors = {name: of.anchor for name, of in COMPOSED.items()}
    assert anchors["cone-plane-cone"] == 0
    assert anchors["plane-cone"] == 1
    assert anchors["plane-cylinder-plane-cone-plane"] == 1
    assert CHAINS["cone-spline-4"].anchor == 1
    assert CHAINS["tri-cone"].anchor == 1
    assert CHAINS["planar-quadrilateral"].anchor == 0


@pytest.mark.parametrize(("cones", "anchor"), [(1, 0), (2, 0), (3, 1), (4, 1), (5, 2)])
def test_the_anchor_of_a_chain_of_cones_is_the_first_of_those_in_its_middle(cones, anchor):
    assert Feature(*cones * [Cone()]).anchor == anchor


@every_feature
def test_numbers_have_unique_names(name):
    names = [number.name for number in FEATURES[name].numbers]
    assert len(set(names)) == len(names)


@pytest.mark.parametrize("name", sorted(CHAINS))
def test_every_patch_and_cut_finds_its_own_numbers(name):
    of = CHAINS[name]
    names = [number.name for number in of.numbers]
    for i, patch in enumerate(of.patches):
        assert names[of.patch_slice(i)] == [f"patch {i}: {number.name}" for number in patch.numbers()]
    for end in (0, 1):
        assert [names[i] for i in of.cut_numbers[end]] == [
            f"cut {end}: {what}" for what in ("position", "skew", "tilt")
        ]


def test_a_polygon_has_neither_patches_with_numbers_nor_ends():
    assert Polygon(5).numbers[Polygon(5).patch_slice(0)] == ()
    assert Polygon(5).cut_numbers.shape == (0, 3)
    assert not Polygon(5).four_sided
    assert np.array_equal(named("cone").cut_numbers[1], np.arange(11, 14))
    assert named("cone").four_sided


@every_feature
def test_expanding_unknowns_keeps_them_and_fills_in_the_fixed_and_tied_numbers(name):
    of = FEATURES[name]
    unknowns = np.random.default_rng(0).normal(size=(2, len(of.free)))
    values = of.expand(unknowns)
    assert np.array_equal(values[:, of.free], unknowns)
    for i, number in enumerate(of.numbers):
        if number.fixed is not None:
            assert np.all(values[:, i] == number.fixed)
    for tied, source in of.tied if isinstance(of, Feature) else ():
        assert np.array_equal(values[:, tied], values[:, source])


@every_feature
def test_derivatives_by_the_unknowns_are_those_of_the_expansion(name):
    of = FEATURES[name]
    slopes = np.random.default_rng(1).normal(size=(2, 3, len(of.numbers)))
    by_unknowns = of.by_unknowns(slopes.copy())
    one = of.expand(np.zeros((1, len(of.free))))
    spread = of.expand(np.eye(len(of.free))) - one
    assert by_unknowns == pytest.approx(slopes @ spread.T, abs=1e-14)


def test_a_number_that_a_feature_fixes_is_no_unknown():
    of = Feature(Plane(width=0.3), Cone(radius=0.2), Plane(turn=0.0))
    assert len(of.free) == 18 - 3
    values = of.expand(np.zeros((1, len(of.free))))
    assert values[0, of.patch_slice(0).start] == 0.3
    assert values[0, of.patch_slice(1).start] == 0.2


def test_a_number_that_a_feature_bounds_is_an_unknown_with_those_bounds():
    of = Feature(Plane(width=(250.0, None)), Cone(half_angle=(-0.1, 0.2)), Plane(turn=(None, 0.0)))
    assert len(of.free) == 18
    lower, upper = of.bounds()
    bounded = {"patch 0: width": (250.0, math.inf), "patch 1: half_angle": (-0.1, 0.2), "patch 2: turn": (-math.inf, 0)}
    for at, number in enumerate(of.free):
        name = of.numbers[number].name
        assert (lower[at], upper[at]) == bounded.get(name, (-math.inf, math.inf))


@every_feature
def test_bounds_are_those_of_the_unknowns_and_in_order(name):
    of = FEATURES[name]
    lower, upper = of.bounds()
    assert lower.shape == upper.shape == of.free.shape
    assert np.all(lower < upper)


def test_in_other_units_lengths_are_scaled_and_nothing_else():
    of = Feature(Plane(width=500.0, turn=0.1), Cone(radius=(100.0, 300.0), half_angle=(-0.1, 0.1)), Plane())
    scaled = of.in_units(2000.0)
    assert number_of(scaled, "patch 0: width").fixed == 0.25
    assert number_of(scaled, "patch 0: turn").fixed == 0.1
    radius, half_angle = number_of(scaled, "patch 1: radius"), number_of(scaled, "patch 1: half_angle")
    assert (radius.lower, radius.upper) == (0.05, 0.15)
    assert (half_angle.lower, half_angle.upper) == (-0.1, 0.1)
    assert number_of(scaled, "patch 2: width") == number_of(of, "patch 2: width")
    assert number_of(of, "patch 0: width").fixed == 500.0
    assert (scaled.patches, scaled.name, scaled.cuts, scaled.tied) == (of.patches, of.name, of.cuts, of.tied)


@every_feature
def test_a_feature_in_its_own_units_is_itself(name):
    of = FEATURES[name]
    assert of.in_units(1.0) == of
    assert np.array_equal(of.in_units(1.0).free, of.free)


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, True, False, "3", 1j, [100.0, 200.0]])
def test_a_value_that_is_no_finite_number_is_refused_in_one_sentence(value):
    for make in (lambda v: Plane(width=v), lambda v: Cone(radius=v), lambda v: Cylinder(sweep=v)):
        with pytest.raises(
            SettingsError, match=r"^'(width|radius|sweep)' must be a finite number, two bounds or nothing"
        ):
            make(value)


@pytest.mark.parametrize("bounds", [(math.nan, 1.0), (0.0, math.inf), (True, 2.0), (0.0, "1")])
def test_bounds_that_are_no_finite_numbers_are_refused(bounds):
    with pytest.raises(SettingsError, match="'half_angle' must be a finite number, two bounds or nothing"):
        Cone(half_angle=bounds)


@pytest.mark.parametrize("bounds", [(2.0, 1.0), (1.0, 1.0)])
def test_bounds_the_wrong_way_round_or_with_nothing_between_are_refused(bounds):
    with pytest.raises(SettingsError, match=f"bounds of 'width' leave nothing between {bounds[0]:g} and {bounds[1]:g}"):
        Plane(width=bounds)


def test_bounds_that_are_not_two_are_refused():
    three: Any = (1.0, 2.0, 3.0)
    with pytest.raises(SettingsError, match="must be two numbers"):
        Plane(turn=three)


@pytest.mark.parametrize("value", [0, 3, np.float64(2.5), np.int64(7)])
def test_numbers_of_other_kinds_are_taken_for_what_they_are(value):
    assert Number.of("width", "length", value).fixed == float(value)
    assert Number.of("width", "length", (value, None)).lower == float(value)


@pytest.mark.parametrize("radius", [0, 0.0, -0.0])
def test_a_radius_of_zero_is_refused(radius):
    with pytest.raises(SettingsError, match="must not be 0"):
        Cone(radius=radius)


@pytest.mark.parametrize(("radius", "sweep"), [(-300.0, 0.5), (300.0, -0.5), ((None, 0.0), 0.5), (5.0, (-1.0, -0.1))])
def test_a_radius_and_a_sweep_of_different_signs_are_refused(radius, sweep):
    with pytest.raises(SettingsError, match="must have one sign"):
        Cylinder(radius=radius, sweep=sweep)


@pytest.mark.parametrize(
    ("radius", "sweep"), [(-300.0, -0.5), (300.0, 0.5), ((None, 0.0), -0.5), ((-1.0, 1.0), -0.5), (300.0, 0.0)]
)
def test_a_radius_and_a_sweep_that_may_have_one_sign_pass(radius, sweep):
    assert Cylinder(radius=radius, sweep=sweep).kind == "cylinder"


def test_a_cylinder_is_the_cone_of_half_angle_zero():
    assert Cylinder() == Cone(half_angle=0.0)
    assert Cylinder(radius=1.0).kind == "cylinder"
    assert Cone().kind == "cone"
    assert Cone(half_angle=(-0.1, 0.1)).kind == "cone"


def test_features_that_say_the_same_are_equal():
    assert Feature(Plane(), Cone()) == Feature(Plane(), Cone())
    assert hash(Feature(Plane(), Cone())) == hash(Feature(Plane(), Cone()))
    assert Feature(Plane(), Cone()) != Feature(Plane(), Cone(radius=(10.0, 20.0)))
    assert Feature(Plane(), Cone()) != Feature(Plane(), Cone(), cuts="upright")
    assert Polygon(5) == Polygon(5) != Polygon(6)


@pytest.mark.parametrize("patch", ["plane", 3, None, Plane, [Plane()], Feature(Cone())])
def test_what_is_no_patch_is_refused(patch):
    with pytest.raises(SettingsError, match="a feature is made of patches"):
        Feature(patch)


@pytest.mark.parametrize("name", ["", " ", b"roof", 3, "a\nb", "\ud800", ["roof"]])
def test_a_name_that_cannot_be_printed_is_refused(name):
    with pytest.raises(SettingsError, match="the name of a feature must be a word"):
        Feature(Cone(), name=name)


@pytest.mark.parametrize(
    ("patch", "number"),
    [
        (lambda: Plane(width=-5.0), "width"),
        (lambda: Plane(width=(-5.0, 3.0)), "width"),
        (lambda: Plane(turn=2.0), "turn"),
        (lambda: Cone(half_angle=100.0), "half_angle"),
        (lambda: Cone(half_angle=(0.0, 1.6)), "half_angle"),
        (lambda: Cone(sweep=7.0), "sweep"),
        (lambda: Cylinder(sweep=(3.0, 8.0)), "sweep"),
    ],
)
def test_numbers_that_no_panel_has_are_refused(patch, number):
    with pytest.raises(SettingsError, match=f"^'{number}' must lie between"):
        patch()


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_the_largest_number_is_one_and_what_is_larger_is_none(sign):
    assert Number.of("shift", "length", sign * LARGEST).fixed == sign * LARGEST
    with pytest.raises(SettingsError, match="must be a finite number"):
        Number.of("shift", "length", sign * math.nextafter(LARGEST, math.inf))


def test_a_number_may_lie_at_either_end_of_what_it_may_be_and_no_farther_out():
    for value in (1.0, 3.0, (1.0, 3.0), (None, 3.0), None):
        Number.of("shift", "length", value).require(1.0, 3.0, "so it is")
    for beyond in (math.nextafter(1.0, 0.0), math.nextafter(3.0, 4.0)):
        with pytest.raises(SettingsError, match="'shift' must lie between 1 and 3: so it is"):
            Number.of("shift", "length", beyond).require(1.0, 3.0, "so it is")


@pytest.mark.parametrize("radius", [10**400, 1e300, -1e12])
def test_a_radius_beyond_all_bounds_is_refused(radius):
    with pytest.raises(SettingsError, match=r"^'radius' must be a finite number"):
        Cylinder(radius=radius)


def test_two_planes_side_by_side_are_one_even_where_their_numbers_do_not_depend_on_each_other():
    with pytest.raises(SettingsError, match="the 2 planes of 'plane-plane' are one"):
        Feature(Plane(width=3.0, turn=0.0), Plane())


@pytest.mark.parametrize(
    ("value", "sign"),
    [(None, 0), (0.0, 0), (2.0, 1), (-2.0, -1), ((0.0, 2.0), 1), ((-2.0, 0.0), -1), ((0.0, None), 1), ((-1.0, 1.0), 0)],
)
def test_the_sign_of_a_number_is_what_its_author_leaves_it(value, sign):
    assert Number.of("sweep", "angle", value).sign == sign
