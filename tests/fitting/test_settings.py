"""Settings that make no sense are refused with one sentence; those at the edge of sense are not."""

import math
from typing import Any

import pytest

from cadpanel.errors import SettingsError
from cadpanel.features.catalogue import CATALOGUE, feature, polygon
from cadpanel.features.feature import Feature
from cadpanel.features.patches import Cone, Cylinder, Plane
from cadpanel.fitting.settings import FitSettings, Weights
from cadpanel.terms.limits.catalogue import LIMITS

ASKED = [limit for limit in LIMITS if limit.asked]
EMPTY = ("gap_tolerance", "joint_tolerance", "step", "shift")
NUMBERS = (*EMPTY, *(limit.name for limit in ASKED), "restarts", "seed", "energy", "tau")


@pytest.mark.parametrize("name", NUMBERS)
@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, -1.0, -1e-12])
def test_numbers_that_are_none_infinite_or_negative_are_refused(name, value):
    how: dict[str, Any] = {name: value}
    with pytest.raises(SettingsError, match="must be"):
        FitSettings(**how)


@pytest.mark.parametrize("name", NUMBERS)
@pytest.mark.parametrize("value", ["1", None, [1.0], 1j])
def test_what_is_no_number_is_refused_by_the_settings_name(name, value):
    how: dict[str, Any] = {name: value}
    if value is None and name in (*EMPTY, "energy"):
        assert getattr(FitSettings(**how), name) is None
        return
    with pytest.raises(SettingsError, match=r"must be a (whole )?number, not"):
        FitSettings(**how)


@pytest.mark.parametrize("name", ["restarts", "seed"])
def test_half_a_restart_or_seed_is_refused(name):
    how: dict[str, Any] = {name: 1.5}
    with pytest.raises(SettingsError, match=r"must be a whole number, not 1\.5"):
        FitSettings(**how)


def test_weights_that_are_no_weights_are_refused():
    how: dict[str, Any] = {"weights": (1.0, 1.0, 1.0)}
    with pytest.raises(SettingsError, match="must be Weights or None"):
        FitSettings(**how)


@pytest.mark.parametrize(
    ("name", "value"), [("gap", 1e300), ("deviation", 1e-300), ("drift", 1e-300), ("drift", "1"), ("gap", None)]
)
def test_weights_that_no_double_can_hold_together_are_refused(name, value):
    how: dict[str, Any] = {name: value}
    with pytest.raises(SettingsError, match=f"{name} weight must be"):
        Weights(**how)


@pytest.mark.parametrize(
    ("name", "least", "most"),
    [
        *((name, 1e-3, None) for name in EMPTY),
        *((limit.name, limit.least, None if math.isinf(limit.most) else limit.most) for limit in ASKED),
        ("restarts", 0, 1000),
        ("seed", 0, None),
        ("energy", 0.0, None),
        ("tau", 1e-12, 1e3),
    ],
)
def test_numbers_may_be_at_the_ends_of_their_ranges_but_not_beyond(name, least, most):
    how: dict[str, Any] = {name: least}
    assert getattr(FitSettings(**how), name) == least
    for beyond in (least - 1e-4, *([] if most is None else [most + 1e-4])):
        how = {name: beyond}
        with pytest.raises(SettingsError, match=f"not {beyond:g}".replace("+", r"\+")):
            FitSettings(**how)
    if most is not None:
        how = {name: most}
        assert getattr(FitSettings(**how), name) == most


@pytest.mark.parametrize("name", ["gap", "deviation", "drift"])
@pytest.mark.parametrize("value", [math.nan, math.inf, -1.0])
def test_weights_that_are_none_infinite_or_negative_are_refused(name, value):
    how: dict[str, Any] = {name: value}
    with pytest.raises(SettingsError, match=f"{name} weight"):
        Weights(**how)


def test_a_gap_may_weigh_nothing_but_deviation_and_drift_may_not():
    assert Weights(gap=0.0).gap == 0.0
    for name in ("deviation", "drift"):
        how: dict[str, Any] = {name: 0.0}
        with pytest.raises(SettingsError, match="wander off"):
            Weights(**how)


@pytest.mark.parametrize(("name", "value"), [("method", "magic"), ("tilt", "loose"), ("feature", "sphere")])
def test_words_that_are_not_known_are_refused_with_those_that_are(name, value):
    how: dict[str, Any] = {name: value}
    with pytest.raises(SettingsError, match=r"concurrent|free|plane-cone-plane"):
        FitSettings(**how)


def test_local_fits_take_no_weights():
    with pytest.raises(SettingsError, match="takes no weights"):
        FitSettings(method="local", weights=Weights())


@pytest.mark.parametrize("name", [*CATALOGUE, "cone-spline-3", "planar-polygon"])
def test_every_name_of_the_catalogue_is_a_feature_of_four_cornered_panels(name):
    how = FitSettings(feature=name)
    assert (how.feature_name, how.automatic) == (name, False)
    assert how.feature_for(4).name == name


def test_a_polygon_has_as_many_corners_as_its_panel():
    how = FitSettings(feature="planar-polygon")
    assert [how.feature_for(corners).corner_count for corners in (3, 4, 5, 8)] == [3, 4, 5, 8]
    assert how.feature_for(5) == polygon(5)


def test_a_composed_feature_is_taken_as_it_is():
    composed = Feature(Plane(width=200.0), Cone(), Plane(), name="bracket")
    how = FitSettings(feature=composed)
    assert how.feature_for(4) is composed
    assert (how.feature_name, how.automatic) == ("bracket", False)


def test_the_tilt_holds_the_cuts_of_a_named_feature_and_a_composed_one_says_it_itself():
    assert FitSettings(tilt="fixed").feature_for(4) == feature("plane-cone-plane", tilt="fixed")
    assert FitSettings(tilt="fixed").feature_for(4) != feature("plane-cone-plane")
    upright = Feature(Plane(), Cone(), Plane(), cuts="upright")
    assert FitSettings(feature=upright).tilt == "free"
    with pytest.raises(SettingsError, match="leave the tilt out"):
        FitSettings(feature=upright, tilt="fixed")


def test_the_automatic_feature_is_chosen_by_the_largest_deviation_and_a_named_one_is_judged_by_it():
    how = FitSettings(feature="auto", max_deviation=5.0)
    assert (how.automatic, how.feature_name) == (True, "auto")
    with pytest.raises(SettingsError, match="is chosen by a largest deviation: give one, too"):
        FitSettings(feature="auto")
    assert not FitSettings(feature="cone", max_deviation=5.0).automatic


@pytest.mark.parametrize("value", [0.0, -1.0, math.nan, math.inf, "5"])
def test_a_largest_deviation_that_is_none_is_refused(value):
    how: dict[str, Any] = {"feature": "auto", "max_deviation": value}
    with pytest.raises(SettingsError, match="largest deviation must be"):
        FitSettings(**how)


@pytest.mark.parametrize("radius", [5.0, -5.0, (1.0, 5.0), (-9.0, -2.0)])
def test_a_radius_tighter_than_the_shop_can_roll_is_refused(radius: Any) -> None:
    tight = Feature(Plane(), Cylinder(radius=radius), Plane())
    with pytest.raises(SettingsError, match=r"the radius of patch 1 of .* is tighter than the least radius of 10 mm"):
        FitSettings(feature=tight)
    assert FitSettings(feature=tight, min_radius=1.0).feature is tight


@pytest.mark.parametrize("feature", [None, 3, ["cylinder"], Plane()])
def test_what_is_no_feature_is_refused(feature: Any) -> None:
    with pytest.raises(SettingsError, match="a feature is named, or is a Feature"):
        FitSettings(feature=feature)
