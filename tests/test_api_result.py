"""Results as Python sees them: in short words, panel by panel, as tables, as pictures, and as a page in a notebook."""

from __future__ import annotations

import html
import sys
from typing import Any

import numpy as np
import pytest

import cadpanel as cp
from cadpanel.delivery.page.html import read_page
from cadpanel.delivery.page.notebook import fit_numbers
from cadpanel.delivery.page.numbers import page_numbers
from cadpanel.delivery.pictures.figure import Picture
from cadpanel.delivery.records.report import ReportModel, UnitsModel
from tests.delivered import fitted
from tests.pages import NAMES, delivery, scene, strange


def result() -> cp.FitResult:
    return cp.FitResult.of(fitted())


def test_panels_are_found_by_name_counted_and_gone_through():
    found = result()
    assert found["N 2"] is found.shapes[1]
    assert len(found) == len(found.reference) == 3
    assert [shape.name for shape in found] == [panel.name for panel in found.reference] == ["N 1", "N 2", "N 3"]
    assert found.reference["N 3"] is found.reference.panels[2]


@pytest.mark.parametrize(
    ("name", "said"),
    [("n 2", "perhaps 'N 2'"), ("N2", "perhaps 'N"), ("roof", "there is 'N 1', 'N 2', 'N 3'")],
)
def test_a_name_that_there_is_not_is_refused_with_what_may_have_been_meant(name, said):
    for of in (result(), result().reference):
        with pytest.raises(KeyError, match=f"there is no panel '{name}'; {said}"):
            of[name]


@pytest.mark.parametrize("place", [0, -1, None, slice(0, 2), ["N 1"]])
def test_a_panel_is_found_by_its_name_only_and_is_among_them_by_it_too(place):
    for of in (result(), result().reference):
        with pytest.raises(KeyError, match=r"found by its name.*; there is 'N 1', 'N 2', 'N 3'"):
            of[place]
        assert ("N 1" in of, next(iter(of)) in of, "N 9" in of, place in of) == (True, True, False, False)


def test_pictures_refuse_what_they_do_not_know_in_one_sentence():
    found: Any = result()
    for call, said in (
        (lambda: found.plot(colour="gap"), "perhaps 'color' is meant"),
        (lambda: found.plot_seam("N 1"), "missing a required argument: 'second'"),
        (lambda: found.plot_seam(0, 1), "'first' of plot_seam[(][)] must be a word"),
        (lambda: found.plot_flat(["N 1"]), "'name' of plot_flat[(][)] must be a word"),
    ):
        with pytest.raises(cp.SettingsError, match=said):
            call()


def test_radii_are_told_in_millimetres_and_not_in_powers_of_ten():
    figure = result().plot("radius")
    ticks = [label.get_text() for label in figure.axes[-1].get_xticklabels()]
    assert len(ticks) == 3
    assert all(tick.isdigit() for tick in ticks)


def test_words_for_things_are_short():
    found = result()
    for thing in (found, found.reference, found.measures, found.reference.panels[0], found.shapes[0]):
        assert len(repr(thing)) < 160
        assert "array(" not in repr(thing)
    assert repr(found).startswith("<FitResult of 'arrays': 3 panels, everything held, gaps up to 2.99 mm")


def test_a_table_has_a_row_for_each_panel(monkeypatch):
    table = result().to_dataframe()
    assert list(table.index) == ["N 1", "N 2", "N 3"]
    assert table["max_deviation"].to_numpy() == pytest.approx(fitted().measures.max_deviation)
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(cp.SettingsError, match=r"pip install 'cadpanel\[dataframe\]'"):
        result().to_dataframe()


def test_pictures_are_figures():
    found = result()
    picture = found.plot_deviation("top")
    assert isinstance(picture, Picture)
    assert picture._repr_png_().startswith(b"\x89PNG")
    assert len(found.plot_seam("N 2", "N 1").axes) == 4
    assert found.plot_flat("N 1").axes[0].get_title().startswith("N 1")
    with pytest.raises(KeyError, match="'N 1' and 'N 3' do not meet"):
        found.plot_seam("N 1", "N 3")
    with pytest.raises(KeyError, match="there is no panel 'N 9'"):
        found.plot_flat("N 9")


def test_in_a_notebook_a_result_is_the_page_in_a_frame(tmp_path):
    shown = cp.FitResult.of(strange())._repr_html_()
    assert shown.startswith("<iframe ")
    assert shown.count("<") == 2
    page = html.unescape(shown.partition('srcdoc="')[2].partition('"')[0])
    (tmp_path / "page.html").write_text(page, encoding="utf-8")
    numbers, _ = read_page(tmp_path / "page.html")
    assert [panel["name"] for panel in numbers["panels"]] == list(NAMES)
    assert numbers["seams"][0]["kink"] == pytest.approx(np.degrees(fitted().measures.kink[0]))


def test_the_page_of_a_fit_tells_the_numbers_of_its_delivery():
    told, page = fit_numbers(strange(), scene()), page_numbers(delivery())
    for mine, its in ((told["panels"], page["panels"]), (told["seams"], page["seams"])):
        for one, other in zip(mine, its, strict=True):
            same = {key: value for key, value in other.items() if isinstance(value, float) and one[key] is not None}
            assert {key: one[key] for key in same} == pytest.approx(same, rel=1e-4)
            assert one.keys() == other.keys()


def test_what_functions_give_is_told_in_short_words():
    report = ReportModel.model_construct(panels=(UnitsModel(length="mm", angle="deg"),) * 200)
    for thing in (cp.unroll(fitted().shapes[0]), cp.fit_plane(np.random.default_rng(0).random((20, 3))), report):
        assert len(f"{thing!r}{thing}") < 320
        assert "array(" not in repr(thing)
    assert repr(report) == "<ReportModel: 200 panels>"
