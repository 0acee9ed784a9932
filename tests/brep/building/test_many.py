"""Sheets that the second interpreter checks and measures are those that are built by one alone, digit for digit."""

from dataclasses import replace

import numpy as np
import pytest

from cadpanel.brep.building import many
from cadpanel.brep.building.many import Measured, make_sheets, measure_sheets
from cadpanel.brep.building.wanted import Sheet
from cadpanel.brep.isolation.client import READER
from cadpanel.brep.kernel.kept import kept_binary
from cadpanel.errors import DeliveryError, PanelError
from cadpanel.features.catalogue import feature
from tests.instances import random_shapes


@pytest.fixture(autouse=True)
def every_number(monkeypatch):
    monkeypatch.setattr(many, "WORTHWHILE_PANELS", 0)
    monkeypatch.setattr(many, "processors", lambda: 2)
    monkeypatch.setattr(many, "CHUNK", 2)


def wanted(count, thickness=3.0):
    return [
        Sheet(shape=shape, thickness=thickness, skin_side="outer")
        for shape in random_shapes(feature("plane-cone-plane"), 7, count)
    ]


def numbers(found):
    return [(one.area, *one.centroid.tolist(), one.skin_area, *one.skin_centroid.tolist(), one.volume) for one in found]


def test_what_the_second_interpreter_measures_is_what_one_alone_does():
    sheets = wanted(5)
    assert numbers(READER.ask(many._request(sheets))) == numbers(measure_sheets(sheets))


def test_with_and_without_help_the_same_sheets_come_in_their_order(monkeypatch):
    sheets = wanted(7)
    told: list[int] = []
    helped = make_sheets(sheets, told.append)
    assert sum(told) == 7
    monkeypatch.setattr(many, "processors", lambda: 1)
    alone = make_sheets(sheets, told.append)
    assert numbers(one.measured for one in helped) == numbers(one.measured for one in alone)
    for one, other in zip(helped, alone, strict=True):
        assert kept_binary(one.solid) == kept_binary(other.solid)
        assert kept_binary(one.skin) == kept_binary(other.skin)


@pytest.mark.parametrize("places", [(0,), (6,), (2, 6), (5, 6)])
def test_of_sheets_that_cannot_be_built_the_first_is_told(places):
    sheets = wanted(7)
    for place in places:
        sheets[place] = replace(sheets[place], thickness=-1.0)
    with pytest.raises(PanelError) as first:
        make_sheets([sheets[places[0]]], lambda _: None)
    with pytest.raises(PanelError) as found:
        make_sheets(sheets, lambda _: None)
    assert str(found.value) == str(first.value)


def test_what_the_second_interpreter_fails_over_is_built_here(monkeypatch):
    def fails(_):
        raise DeliveryError("it crashed")

    monkeypatch.setattr(READER, "ask", fails)
    assert len(make_sheets(wanted(5), lambda _: None)) == 5


def test_whatever_else_goes_wrong_there_is_not_hidden(monkeypatch):
    def fails(_):
        raise KeyError("a fault of the program")

    monkeypatch.setattr(READER, "ask", fails)
    with pytest.raises(KeyError):
        make_sheets(wanted(5), lambda _: None)


def test_centroids_are_of_the_solid_and_of_the_skin():
    (one,) = measure_sheets(wanted(1))
    assert isinstance(one, Measured)
    assert np.linalg.norm(one.centroid - one.skin_centroid) < 10.0
