"""A keyword that a step does not know is refused with the one that was meant, or the step that knows it."""

from dataclasses import fields
from inspect import signature
from typing import Any

import pytest

import cadpanel as cp
from cadpanel.api_keywords import check_keywords
from cadpanel.delivery.shop_settings import ShopSettings
from tests.delivered import fitted, strip


@pytest.mark.parametrize(
    ("step", "keyword", "said"),
    [
        ("fit", "gap_tolerence", r"fit\(\) knows no setting 'gap_tolerence'; perhaps 'gap_tolerance'"),
        ("fit", "divide", r"'divide' is no setting of fit\(\): give it to read\(\)"),
        ("read", "thickness", r"'thickness' is no setting of read\(\): give it to deliver\(\)"),
        ("deliver", "output", r"deliver\(\) knows no setting 'output'; perhaps 'outputs'"),
    ],
)
def test_a_wrong_keyword_is_refused_with_the_right_one(step, keyword, said):
    with pytest.raises(cp.SettingsError, match=said):
        check_keywords(step, [keyword])


def test_steps_check_their_keywords_before_they_begin():
    wrong: dict[str, Any] = {"gap_tolerence": 1.0}
    for step in (
        lambda: cp.fit(strip(), **wrong),
        lambda: cp.compare(strip(), **wrong),
        lambda: cp.study(strip(), gaps=[1.0], **wrong),
        lambda: cp.read("none.step", **wrong),
        lambda: cp.deliver(fitted(), "none", **wrong),
    ):
        with pytest.raises(cp.SettingsError, match="knows no setting 'gap_tolerence'"):
            step()


def test_a_file_is_fitted_as_it_is_read(monkeypatch):
    asked = []

    def read_it(path, how):
        asked.append((path, how))
        return strip()

    monkeypatch.setattr("cadpanel.brep.read.read_reference", read_it)
    found = cp.fit("roof.step")
    assert asked == [("roof.step", cp.ReferenceSettings())]
    assert found.measures.overall_rms == fitted().measures.overall_rms
    with pytest.raises(cp.SettingsError, match=r"'reference' of fit\(\) must be Reference or a path, not 7"):
        cp.fit(7)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("function", "settings"),
    [
        (cp.read, cp.ReferenceSettings),
        (cp.fit, cp.FitSettings),
        (cp.study, cp.FitSettings),
        (cp.deliver, ShopSettings),
    ],
)
def test_docstrings_spell_out_every_keyword_with_its_default(function, settings):
    told = function.__doc__.partition("Keywords:")[2].split()
    named = signature(function).parameters
    spelled = {word.partition("=")[0] for word in told if "=" in word}
    assert {one.name for one in fields(settings) if one.name not in named} <= spelled
    assert all(len(line) <= 120 for line in function.__doc__.splitlines())


def test_a_default_stands_with_its_meaning():
    assert "seam_turn=3.0: How far seams may turn from the drawn ones." in str(cp.fit.__doc__)
