"""What is asked of a delivery is checked when it is asked."""

import pytest

from cadpanel.delivery.shop_settings import ShopSettings, layers_of, stock_of
from cadpanel.errors import SettingsError


@pytest.mark.parametrize(
    ("setting", "value", "message"),
    [
        ("k_factor", 1.5, "K-factor must be between 0 and 1"),
        ("chord", 0.0, "chord tolerance must be between"),
        ("roll_pitch", 0.0, "pitch of the rulings must be at least 1 mm"),
        ("density", float("nan"), "density must be between"),
        ("facet_height", -1.0, "facet height must be between"),
        ("dxf_name_length", 4, "longest name of a drawing must be between 8 and 120"),
        ("dxf_name_length", 20.5, "must be a whole number"),
        ("dxf_entities", "splines", "drawn as polyline or lines"),
        ("dxf_contour_only", 1, "is yes or no"),
        ("origin", "far", "the origin is local or kept"),
        ("outputs", "", "outputs are chosen by their names"),
        ("only", ("a", " "), "panels are chosen by their names"),
        ("stock", ((1500.0,),), "a sheet of the stock has two sides"),
        ("returns", (30.0,), "returns have a length and an inner radius in mm"),
        ("returns", (30.0, 0.0), "the inner radius of returns must be between 0.1 mm and 1000 mm"),
        ("fixings", (6.5, 400.0), "have a diameter, a pitch and a distance from edges"),
        ("fixings", (6.5, 14.0, 20.0), "the pitch of fixing holes must be at least 14.3 mm, not 14 mm"),
        ("fixings", (6.5, 400.0, 7.0), "the distance of fixing holes from the edge must be at least 7.8 mm"),
        ("stock", ((1500.0, -1.0),), "a sheet of the stock has two sides"),
        ("stock", ("1500x3000",), "a sheet of the stock has two sides"),
        ("dxf_layers", (("CUTS", "0"),), "there is no layer 'CUTS'"),
        ("dxf_layers", (("CUT", "a/b"),), "is no name for a layer"),
        ("dxf_layers", (("CUT", "a"), ("CUT", "b")), "a layer has one name"),
        ("dxf_layers", (("CUT", "mark"),), "needs a layer of its own"),
    ],
)
def test_a_setting_that_is_none_is_refused(setting, value, message):
    with pytest.raises(SettingsError, match=message):
        ShopSettings(**{setting: value})


def test_words_become_settings():
    assert stock_of("1500x3000, 2000 X 4000.5") == ((1500.0, 3000.0), (2000.0, 4000.5))
    assert layers_of("CUT=0, BEND=Folds") == (("CUT", "0"), ("BEND", "Folds"))
    settings = ShopSettings(outputs="step,flats", only='NW-*,"a, b"', dxf_layers=layers_of("CUT=0"))
    assert settings.outputs == ("step", "flats")
    assert settings.only == ("NW-*", "a, b")
    assert (settings.layer("CUT"), settings.layer("MARK")) == ("0", "MARK")


@pytest.mark.parametrize("text", ["1500", "1500x", "x3000", "1500x3000;", "0x0x0", "-1x5"])
def test_stock_that_is_no_list_of_sheets_is_refused(text):
    with pytest.raises(SettingsError, match="written like 1500x3000"):
        stock_of(text)


def test_layers_that_are_no_pairs_are_refused():
    with pytest.raises(SettingsError, match="written like CUT=0"):
        layers_of("CUT,BEND=2")
