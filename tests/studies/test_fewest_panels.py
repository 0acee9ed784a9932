"""The search for the fewest panels that hold everything: of made-up fits, and of real ones."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from cadpanel.errors import PanelError, ReferenceFileError, SettingsError
from cadpanel.fitting.settings import FitSettings, Weights
from cadpanel.reference.settings import ReferenceSettings
from cadpanel.studies import fewest_panels as module
from cadpanel.studies.fewest_panels import MOST_FITS, TOO_LARGE, fewest_panels
from fixtures.arrays import reference as sampled_lip
from fixtures.lips import Lip
from tests.delivered import fitted
from tests.thorough import thorough

ALLOWED = 10.0
ASKED = FitSettings(gap_tolerance=1.0, max_deviation=ALLOWED)


class MadeUp:
    """Fits whose largest deviation falls with the square of the number of panels, as a strip's does."""

    def __init__(self, alone, together, gap=lambda _: 0.5):
        self.alone, self.together, self.gap, self.fits, self.locals = alone, together, gap, [], []

    def read(self, count):
        template = fitted().reference
        how = ReferenceSettings(divide=count)
        return replace(template, settings=how, panels=(template.panels[0],) * max(count, 3), seams=template.seams)

    def fit(self, reference, how, tell=None, **_):
        count = reference.settings.divide
        if how.method == "local":
            self.locals.append(count)
            return SimpleNamespace(measures=SimpleNamespace(max_deviation=np.array([self.alone(count)])))
        self.fits.append(count)
        tell("concurrent", 1, 1.0, 1.0)
        far, gap = self.together(count), self.gap(count)
        base = fitted()
        corners = (np.full(4, gap),) * 2
        measures = replace(base.measures, max_deviation=np.full(3, far), corner_gaps=corners, seam_gap=np.full(2, gap))
        shapes = (base.shapes[0],) * count
        held = far <= ALLOWED and gap <= how.widest_gap
        return replace(base, reference=reference, settings=how, measures=measures, shapes=shapes, tolerance_met=held)


def search(monkeypatch, made_up, **how):
    monkeypatch.setattr(module, "fit", made_up.fit)
    return fewest_panels(made_up.read, ASKED, **how)


def least(size):
    """The number from which size / number^2 is within what is allowed."""
    return int(np.ceil(np.sqrt(size / ALLOWED) * (1.0 - 1e-12)))


@given(alone=st.floats(1.0, 3e4), dearer=st.floats(1.0, 12.0))
@settings(max_examples=60, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_the_fewest_that_hold_are_found_with_few_fits(monkeypatch, alone, dearer):
    made_up = MadeUp(lambda n: alone / n**2, lambda n: dearer * alone / n**2)
    found = search(monkeypatch, made_up)
    wanted = least(dearer * alone)
    assert len(made_up.fits) <= MOST_FITS
    assert len(set(made_up.fits)) == len(made_up.fits)
    if wanted <= found.most:
        assert found.held
        assert len(found.result.shapes) == wanted
        assert found.shortfall() is None
        assert found.least == least(alone)
    else:
        assert not found.held
    assert [one.count for one in found.tried] == made_up.fits


def test_where_no_number_holds_the_best_is_told_with_its_numbers(monkeypatch):
    made_up = MadeUp(lambda n: 100.0 / n, lambda n: 40.0 + abs(n - 20))
    found = search(monkeypatch, made_up, most=60)
    assert not found.held
    assert found.least == 10
    assert max(made_up.fits) == 60
    assert abs(len(found.result.shapes) - 20) == min(abs(count - 20) for count in made_up.fits)
    sentence = found.shortfall()
    assert sentence is not None
    assert sentence.startswith(
        "no number of panels along each strip from 10 to 60 was found to hold everything (tried: 10,"
    )
    assert f"with {len(found.result.shapes)}, the best of them, the largest deviation of 10 mm is not met" in sentence


def test_what_is_asked_besides_makes_panels_smaller_until_it_will_do(monkeypatch):
    made_up = MadeUp(lambda n: 90.0 / n**2, lambda n: 90.0 / n**2)
    found = search(monkeypatch, made_up, admitted=lambda result: len(result.shapes) >= 11)
    assert found.least == 3
    assert len(found.result.shapes) == 11
    assert {one.count: one.held for one in found.tried}[11]
    assert all(one.missed == TOO_LARGE and TOO_LARGE in str(one) for one in found.tried if not one.held)
    never = search(monkeypatch, made_up, most=20, admitted=lambda _: False)
    assert len(never.result.shapes) == 20


def test_gaps_that_do_not_close_ask_for_more_panels_too(monkeypatch):
    made_up = MadeUp(lambda n: 100.0 / n**2, lambda n: 100.0 / n**2, gap=lambda n: 30.0 / n)
    found = search(monkeypatch, made_up)
    assert found.held
    assert len(found.result.shapes) == 30


def test_a_number_that_cannot_be_cut_or_fitted_is_passed_over(monkeypatch):
    made_up = MadeUp(lambda n: 100.0 / n**2, lambda n: 300.0 / n**2)
    usual_read, usual_fit = made_up.read, made_up.fit

    def read(count):
        if count == 5:
            raise ReferenceFileError("a cut misses the surface.")
        return usual_read(count)

    def refuse(reference, how, *more, **rest):
        if reference.settings.divide < 5:
            raise PanelError("N 1", "no cone comes near it")
        return usual_fit(reference, how, *more, **rest)

    monkeypatch.setattr(module, "fit", refuse)
    found = fewest_panels(read, ASKED)
    assert found.held
    assert len(found.result.shapes) == 6


def test_what_can_never_be_cut_or_fitted_is_refused_with_the_sentence(monkeypatch):
    def read(_):
        raise ReferenceFileError("'roof.step' is no strip.")

    with pytest.raises(ReferenceFileError, match="is no strip"):
        fewest_panels(read, ASKED)

    def refuse(*_, **__):
        raise PanelError("N 1", "no cone comes near it")

    monkeypatch.setattr(module, "fit", refuse)
    with pytest.raises(PanelError, match="no cone comes near it"):
        fewest_panels(MadeUp(abs, abs).read, ASKED, most=9)


def test_it_ends_with_the_best_so_far_when_it_is_told_to(monkeypatch):
    made_up = MadeUp(lambda n: 100.0 / n**2, lambda n: 900.0 / n**2)
    found = search(monkeypatch, made_up, progress=lambda count, step, *_: step == 0 or count < 5)
    assert len(made_up.fits) < 4
    assert not found.held
    hurried = MadeUp(lambda n: 100.0 / n**2, lambda n: 900.0 / n**2)
    assert len(search(monkeypatch, hurried, time_limit=1e-9).tried) == 1
    assert len(hurried.fits) == 1


def test_it_wants_a_largest_deviation_and_tolerances():
    with pytest.raises(SettingsError, match="chosen by a largest deviation"):
        fewest_panels(MadeUp(abs, abs).read, FitSettings())
    with pytest.raises(SettingsError, match="weights hold nothing"):
        fewest_panels(MadeUp(abs, abs).read, FitSettings(max_deviation=5.0, weights=Weights()))


def cut(count, length=6000.0):
    """One lip, cut into so many panels."""
    lip = Lip(
        panels=count,
        panel_length=length / count,
        twist=(2.0 / count,),
        plan=(15.0 / count,),
        rise=(3.0 / count,),
        radius=(320.0, 260.0),
    )
    return sampled_lip(lip)


@thorough
def test_of_a_real_strip_the_number_found_holds_and_one_fewer_does_not():
    asked = FitSettings(gap_tolerance=2.0, max_deviation=8.0)
    found = fewest_panels(cut, asked)
    assert found.held
    assert found.result.measures.max_deviation.max() <= 8.0
    assert found.result.measures.max_seam_gap <= 2.0
    counts = {one.count: one.held for one in found.tried}
    count = len(found.result.shapes)
    assert counts[count]
    assert count == found.least or not counts[count - 1]
    assert found.note() in found.result.reference.notes
    assert found.result.baselines.reference is found.result.reference
