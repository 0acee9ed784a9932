"""Panels of a length that may be shortened: they are until their blanks fit, and else stay as they were asked for."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from cadpanel.errors import PanelError
from cadpanel.jobs.stocked import SHORTER, fitted_to_stock
from cadpanel.reference.settings import ReferenceSettings
from tests.delivered import fitted

LONG = ReferenceSettings(panel_length=2000.0)


def fit_of(how: ReferenceSettings) -> Any:
    base = fitted()
    return replace(base, reference=replace(base.reference, settings=how))


def shorter_than(length: float) -> Any:
    return lambda result: (result.reference.settings.panel_length or 0.0) <= length


def test_panels_are_shortened_until_their_blanks_fit_and_a_note_says_so() -> None:
    found = fitted_to_stock(LONG, fit_of, shorter_than(1500.0), lambda: False)
    length = found.reference.settings.panel_length
    assert length == pytest.approx(2000.0 * SHORTER**2)
    assert f"at most {length:.6g} mm long and not 2000 mm" in found.reference.notes[-1]
    assert found.baselines.reference is found.reference


@pytest.mark.parametrize("how", [LONG, ReferenceSettings(divide=4)])
def test_what_fits_or_has_no_length_is_fitted_once(how: ReferenceSettings) -> None:
    asked = []

    def once(one: ReferenceSettings) -> Any:
        asked.append(one)
        return fit_of(one)

    found = fitted_to_stock(how, once, lambda _: how is LONG, lambda: False)
    assert asked == [how]
    assert found.reference.notes == fitted().reference.notes


def test_where_nothing_fits_cannot_be_cut_or_is_stopped_panels_are_as_asked_for() -> None:
    asked: list[float] = []

    def cut(how: ReferenceSettings) -> Any:
        asked.append(how.panel_length or 0.0)
        if len(asked) == 3:
            raise PanelError("S1-09", "too short")
        return fit_of(how)

    assert fitted_to_stock(LONG, cut, lambda _: False, lambda: False).reference.settings == LONG
    assert len(asked) == 3
    assert fitted_to_stock(LONG, fit_of, lambda _: False, lambda: False).reference.settings == LONG
    answers = iter([False, True])
    assert fitted_to_stock(LONG, fit_of, lambda _: False, lambda: next(answers)).reference.settings == LONG
    assert list(answers) == []


def test_shorter_panels_that_cannot_be_built_refuse_nothing() -> None:
    """Nobody asked for them; whether blanks fit is asked of panels as they are built, returns and all."""

    def built(result: Any) -> bool:
        if result.reference.settings != LONG:
            raise PanelError("S1-09", "its return does not fit")
        return False

    assert fitted_to_stock(LONG, fit_of, built, lambda: False).reference.settings == LONG
