"""report.html in Chromium: it loads clean, shows every panel, answers mouse and keyboard, and shuts nobody out."""

from __future__ import annotations

from collections.abc import Iterator
from importlib.resources import files
from itertools import combinations
from typing import Any

import numpy as np
import pytest

from tests.browser.chromium import chromium, drawn, pixels
from tests.delivered import fitted
from tests.pages import NAMES, write_page

pytestmark = pytest.mark.browser

MODES = ("Deviation", "Gap", "Step", "Kink", "Feature", "Radius")
AT_FIRST = """
const told = (id, value, event) => {
  const element = document.getElementById(id);
  element.value = value;
  element.dispatchEvent(new Event(event));
};
cadpanel.choose("");
told("apart", 0, "input");
told("axis", "", "change");
told("find", "", "input");
if (document.getElementById("ghost").checked) document.getElementById("ghost").click();
document.querySelector("input[value=Deviation]").click();
document.querySelector("#views button").click();
document.getElementById("tab-panels").click();
"""
SEAMS = [f"{NAMES[0]} | {NAMES[1]}", f"{NAMES[1]} | {NAMES[2]}"]


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> str:
    return write_page(tmp_path_factory.mktemp("page")).as_uri()


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    with chromium() as opened:
        yield opened


@pytest.fixture(scope="module")
def loaded(browser: Any, address: str) -> Any:
    browser.get(address)
    assert browser.execute_script("return document.body.dataset.ready") == "true"
    drawn(browser)
    return browser


@pytest.fixture
def page(loaded: Any) -> Any:
    """The page as it is when it has been loaded."""
    loaded.execute_script(AT_FIRST)
    drawn(loaded)
    return loaded


def chosen(page: Any) -> str:
    return str(page.execute_script("return document.body.dataset.chosen ?? ''"))


def click_in_picture(page: Any, name: str) -> None:
    from selenium.webdriver import ActionChains

    canvas = page.find_element("id", "canvas")
    x, y = page.execute_script("return cadpanel.placeOf(arguments[0])", name)
    size = canvas.size
    ActionChains(page).move_to_element_with_offset(
        canvas, x - size["width"] / 2, y - size["height"] / 2
    ).click().perform()
    drawn(page)


def test_it_loads_without_a_complaint_and_asks_for_no_other_file(page: Any) -> None:
    assert page.get_log("browser") == []
    assert page.execute_script("return performance.getEntriesByType('resource').map((entry) => entry.name)") == []


def test_every_panel_and_seam_is_told_of_and_names_stay_text(page: Any) -> None:
    rows = {
        which: [row.get_attribute("textContent") for row in page.find_elements("css selector", f"#pane-{which} .link")]
        for which in ("panels", "seams")
    }
    assert rows == {"panels": list(NAMES), "seams": SEAMS}
    assert page.find_element("id", "subtitle").text == "3 panels, 2 seams, sheet of 3 mm"
    assert page.title.startswith("<b>strip</b> ")
    assert page.find_element("id", "title").text == "<b>strip</b>"
    page.execute_script("cadpanel.choose(arguments[0])", NAMES[0])
    assert page.find_element("css selector", "#details h2").text == NAMES[0]
    assert page.execute_script("return window.broken") is None
    assert page.find_elements("css selector", "#title *, h2 *, .link *") == []


def test_all_panels_are_one_mesh(page: Any) -> None:
    assert page.execute_script("return cadpanel.drawCalls()") == 2  # the sheets, and the lines of the seams


def test_nothing_is_drawn_again_while_nothing_moves(page: Any) -> None:
    frames = [page.execute_script("return cadpanel.frames()")]
    for _ in range(10):
        drawn(page)
    frames.append(page.execute_script("return cadpanel.frames()"))
    page.find_elements("css selector", "#views button")[1].click()
    drawn(page)
    frames.append(page.execute_script("return cadpanel.frames()"))
    assert frames[0] == frames[1] < frames[2] <= frames[1] + 2


def test_a_click_chooses_the_panel_or_the_seam_under_it(page: Any) -> None:
    for name in NAMES:
        click_in_picture(page, name)
        assert chosen(page) == name
    click_in_picture(page, SEAMS[1])
    assert chosen(page) == SEAMS[1]
    assert len(page.find_elements("css selector", "#details figure svg")) == 4
    from selenium.webdriver import ActionChains

    canvas = page.find_element("id", "canvas")
    corner = (4 - canvas.size["width"] / 2, 4 - canvas.size["height"] / 2)
    ActionChains(page).move_to_element_with_offset(canvas, *corner).click().perform()
    assert chosen(page) == ""


def test_the_worst_panel_and_the_worst_seam_are_one_click_away(page: Any) -> None:
    measures = fitted().measures
    tiles = page.find_elements("class name", "tile")
    tiles[0].click()
    assert chosen(page) == NAMES[int(measures.max_deviation.argmax())]
    shown = page.find_element("css selector", "#details dd").text
    assert float(shown.removesuffix(" mm")) == pytest.approx(measures.max_deviation.max(), abs=0.006)
    tiles[1].click()
    assert chosen(page) == SEAMS[int(measures.seam_gap.argmax())]


def test_every_way_of_colouring_is_another_picture_and_none_is_blank(page: Any) -> None:
    canvas = page.find_element("id", "canvas")
    pictures = {}
    for mode in MODES:
        page.execute_script("document.querySelector(`input[value=${arguments[0]}]`).click()", mode)
        drawn(page)
        pictures[mode] = pixels(canvas)
        assert page.find_element("id", "legend").is_displayed()
        assert pictures[mode].std(axis=(0, 1)).min() > 0.01
    for one, other in combinations(MODES, 2):
        differs = np.abs(pictures[one] - pictures[other]).max(axis=-1) > 0.05
        assert differs.mean() > 2e-4, (one, other)


def test_sliders_and_the_reference_change_the_picture(page: Any) -> None:
    canvas = page.find_element("id", "canvas")
    before = pixels(canvas)
    moves = (
        "const e = document.getElementById('apart'); e.value = 60; e.dispatchEvent(new Event('input'))",
        "const e = document.getElementById('axis'); e.value = '0'; e.dispatchEvent(new Event('change'))",
        "const e = document.getElementById('cut-from'); e.value = 300; e.dispatchEvent(new Event('input'))",
        "const e = document.getElementById('axis'); e.value = '2'; e.dispatchEvent(new Event('change'))",
        "document.getElementById('ghost').click()",
    )
    for move in moves:
        page.execute_script(move)
        drawn(page)
        after = pixels(canvas)
        assert (np.abs(after - before).max(axis=-1) > 0.05).mean() > 1e-3, move
        before = after


def test_tables_sort_and_are_searched(page: Any) -> None:
    heads = page.find_elements("css selector", "#pane-panels th button")
    heads[2].click()
    order = np.argsort(-fitted().measures.max_deviation)
    links = page.find_elements("css selector", "#pane-panels .link")
    assert [link.text for link in links] == [NAMES[place] for place in order]
    page.find_element("id", "find").send_keys("süd")
    shown = [link.text for link in page.find_elements("css selector", "#pane-panels .link") if link.is_displayed()]
    assert shown == [NAMES[2]]


def test_blanks_about_a_name_are_nothing_that_is_looked_for(page: Any) -> None:
    looked = "const e = document.getElementById('find'); e.value = arguments[0]; e.dispatchEvent(new Event('input'));"
    page.execute_script(looked, f"  {NAMES[1].upper()}|{NAMES[2]} ")
    links = page.find_elements("css selector", "#pane-seams tr:not([hidden]) .link")
    assert [link.get_attribute("textContent") for link in links] == [SEAMS[1]]


def test_a_section_leaves_something_and_gives_way_to_what_is_looked_for(page: Any) -> None:
    told = (
        "const told = (id, value, event) => { const e = document.getElementById(id); e.value = value; "
        "e.dispatchEvent(new Event(event)); }; told('axis', '0', 'change'); told('cut-from', 1000, 'input');"
        "return ['cut-from', 'cut'].map((id) => Number(document.getElementById(id).value));"
    )
    start, stop = page.execute_script(told)
    assert 0 < start < stop == 500
    axis = page.find_element("id", "axis")
    page.execute_script("cadpanel.choose(arguments[0])", NAMES[0])
    page.execute_script("cadpanel.choose(arguments[0])", NAMES[2])
    assert axis.get_attribute("value") == ""  # one of the two ends lies outside


def test_the_right_button_chooses_nothing(page: Any) -> None:
    from selenium.webdriver import ActionChains

    canvas = page.find_element("id", "canvas")
    x, y = page.execute_script("return cadpanel.placeOf(arguments[0])", NAMES[1])
    ActionChains(page).move_to_element_with_offset(
        canvas, x - canvas.size["width"] / 2, y - canvas.size["height"] / 2
    ).context_click().perform()
    assert chosen(page) == ""


def test_the_keyboard_turns_the_picture_and_lets_go(page: Any) -> None:
    canvas = page.find_element("id", "canvas")
    page.execute_script("cadpanel.choose(arguments[0])", NAMES[1])
    drawn(page)
    before = pixels(canvas)
    canvas.send_keys("\ue012" * 3)  # arrow left
    drawn(page)
    assert (np.abs(pixels(canvas) - before).max(axis=-1) > 0.05).mean() > 1e-2
    canvas.send_keys("\ue00c")  # escape
    assert chosen(page) == ""


def test_axe_finds_no_serious_fault(page: Any) -> None:
    page.execute_script((files("axe_core_python") / "axe.min.js").read_text(encoding="utf-8"))
    for name in ("", NAMES[0], SEAMS[0]):
        page.execute_script("cadpanel.choose(arguments[0])", name)
        found = page.execute_async_script("const done = arguments[0]; axe.run().then(done)")
        assert len(found["passes"]) > 20
        faults = [(fault["id"], fault["impact"], fault["nodes"][0]["html"]) for fault in found["violations"]]
        assert [fault for fault in faults if fault[1] in ("serious", "critical")] == []


def test_a_narrow_window_needs_no_scrolling_sideways(page: Any) -> None:
    page.execute_cdp_cmd(
        "Emulation.setDeviceMetricsOverride", {"width": 360, "height": 740, "deviceScaleFactor": 1, "mobile": False}
    )
    try:
        assert page.execute_script("return document.documentElement.scrollWidth") <= 360
        assert page.find_element("id", "canvas").size["height"] >= 280
    finally:
        page.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})


def test_on_paper_there_are_both_tables_and_no_sliders(page: Any) -> None:
    page.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "print"})
    try:
        assert all(page.find_element("id", pane).is_displayed() for pane in ("pane-panels", "pane-seams"))
        assert not page.find_element("id", "sliders").is_displayed()
        for button in page.find_elements("css selector", "th button"):  # Chromium repeats text on every sheet, no boxes
            assert button.value_of_css_property("display") == "contents"
    finally:
        page.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": ""})


def test_without_webgl_the_tables_are_still_there(browser: Any, address: str) -> None:
    none = {"source": "HTMLCanvasElement.prototype.getContext = () => null;"}
    script = browser.execute_cdp_cmd("Page.addScriptToEvaluateOnNewDocument", none)
    try:
        browser.get(address)
        assert browser.find_element("id", "nothing").is_displayed()
        browser.find_elements("css selector", "#pane-panels .link")[1].click()
        assert chosen(browser) == NAMES[1]
    finally:
        browser.execute_cdp_cmd("Page.removeScriptToEvaluateOnNewDocument", script)
