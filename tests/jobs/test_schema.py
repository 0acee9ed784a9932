from __future__ import annotations

from dataclasses import fields

import pytest
from pydantic import ValidationError

from cadpanel.errors import SettingsError
from cadpanel.fitting.settings import FitSettings, Weights
from cadpanel.jobs.schema import KINDS, asked, made, region_values


def test_every_field_of_all_settings_may_be_given_and_nothing_else() -> None:
    assert list(asked()) == [field.name for kind in KINDS for field in fields(kind)]
    assert sum(len(fields(kind)) for kind in KINDS) == len(asked())  # no name stands for two settings
    with pytest.raises(ValidationError):
        region_values().validate_python({"reference": "a.step", "tolerance": 1})
    with pytest.raises(ValidationError):
        region_values().validate_python({"thickness": 1})


@pytest.mark.parametrize("name", asked())
def test_no_setting_takes_a_value_of_any_type(name: str) -> None:
    with pytest.raises(ValidationError):
        region_values().validate_python({"reference": "a.step", name: object()})


@pytest.mark.parametrize(
    ("text", "plain", "name"),
    [
        ("2x3", [2, 3], "grid"),
        ("1200.5,2400", [1200.5, 2400], "stations"),
        ("N-01,*3", ["N-01", "*3"], "only"),
        ("1500x3000,2500x4000", [[1500, 3000], [2500, 4000]], "stock"),
        ("8@350,25", [8, 350, 25], "fixings"),
    ],
)
def test_what_the_command_line_has_as_text_may_be_text_or_numbers(text: str, plain: object, name: str) -> None:
    values = [region_values().validate_python({"reference": "", name: value})[name] for value in (text, plain)]
    found = [made({name: value}) for value in values]
    assert found[0] == found[1] != made({})


def test_numbers_mean_what_they_mean_on_the_command_line() -> None:
    _, settings, _, _ = made({"drift_along": 4.0, "weights": "gap=2", "divide": 3, "faces": ["a", "b"]})
    assert settings.drift_along == 0.04
    assert settings.weights == Weights(gap=2.0)
    assert made({"feature": "cone"})[1] == FitSettings(feature="cone")


def test_weights_beside_what_they_take_the_place_of_are_refused() -> None:
    with pytest.raises(SettingsError, match="leave out either 'weights' or 'step'"):
        made({"weights": "gap=1", "step": 2.0})
