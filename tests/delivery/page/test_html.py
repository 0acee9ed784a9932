"""The page is one file of text that nothing in it breaks out of, and its numbers are held against the report."""

import json
import re
import shutil
from dataclasses import replace
from html.parser import HTMLParser
from importlib.resources import files

import pytest

from cadpanel.delivery.outputs.report_html import PAGE, ReportHtml
from cadpanel.delivery.page.html import json_text, read_page
from cadpanel.delivery.page.numbers import page_numbers
from cadpanel.errors import DeliveryError
from tests.pages import NAMES, delivery, write_page


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    return write_page(tmp_path_factory.mktemp("page"))


class Elements(HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.tags: list[str] = []
        self.addresses: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        self.addresses += [value for name, value in attrs if name in ("src", "href") and value]


def test_names_that_look_like_markup_are_no_elements_and_nothing_is_fetched(page):
    found = Elements(page.read_text(encoding="utf-8"))
    assert found.tags.count("script") == 4  # numbers, shapes, library, program
    assert set(found.tags) >= {"title", "canvas", "main"}
    assert "b" not in found.tags
    assert found.addresses == ["data:,", "#tables"]


def test_what_the_page_holds_comes_back(page):
    numbers, shapes = read_page(page)
    assert numbers == json.loads(json.dumps(page_numbers(delivery())))
    assert [panel["name"] for panel in shapes["panels"]] == list(NAMES)


@pytest.mark.parametrize("sign", ["</script>", "<!--", "&amp;", "\u2028", "🏛", '"\\'])
def test_any_text_survives_and_no_sign_of_markup_is_left(sign):
    text = json_text({"name": sign})
    assert json.loads(text) == {"name": sign}
    assert not re.search("[<>&\u2028\u2029]", text)


def test_a_page_that_tells_the_report_s_numbers_is_proved(page):
    proof = ReportHtml().prove(page.parent, delivery())
    assert (proof.numbers, proof.failures) == ({"panels": 3}, ())


def test_a_page_that_tells_or_shows_something_else_is_not_proved(page, tmp_path):
    told = delivery()
    shutil.copy(page, tmp_path)
    better = tuple(seam.model_copy(update={"max_seam_gap": 0.1 * seam.max_seam_gap}) for seam in told.seams)
    failures = ReportHtml().prove(tmp_path, replace(told, seams=better)).failures
    assert failures[0] == "'report.html' does not tell the report's numbers."
    assert failures[1].startswith("'report.html' shows a gap of ")
    fewer = replace(told, records=told.records[1:])
    assert "'report.html' does not show the panels that are delivered." in ReportHtml().prove(tmp_path, fewer).failures
    text = page.read_text(encoding="utf-8")
    (tmp_path / PAGE).write_text(re.sub('"topologies":\\[', '"topologies":["AAA",', text), encoding="utf-8")
    (failure,) = ReportHtml().prove(tmp_path, told).failures
    assert failure.startswith("'report.html' holds no panels that could be shown: ")


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("</body>", "<script src='https://example.org/x.js'></script></body>"),
        ("</html>", ""),
        ('{"', '{"x":1,"'),
        ("<style>", "<style>body{display:none}"),
    ],
)
def test_what_stands_in_a_page_besides_its_numbers_is_not_proved(page, tmp_path, old, new):
    text = page.read_text(encoding="utf-8")
    assert old in text
    at = text.rindex(old) if old.startswith("</") else text.index(old)
    (tmp_path / PAGE).write_text(text[:at] + new + text[at + len(old) :], encoding="utf-8")
    assert ReportHtml().prove(tmp_path, delivery()).failures


@pytest.mark.parametrize(
    ("content", "words"),
    [(b"<p>", "holds no cadpanel-numbers"), (b"\xff", "not UTF-8"), (None, "cannot be read: No such file")],
)
def test_what_is_no_page_is_refused_in_one_sentence(tmp_path, content, words):
    if content is not None:
        (tmp_path / PAGE).write_bytes(content)
    with pytest.raises(DeliveryError, match=words):
        read_page(tmp_path / PAGE)


def test_the_library_has_its_licence_beside_it_and_does_not_end_the_script():
    assets = files("cadpanel.delivery.page.assets")
    assert "Permission is hereby granted" in (assets / "three.LICENSE.txt").read_text(encoding="utf-8")
    library = (assets / "three.min.js").read_text(encoding="utf-8")
    assert "@license" in library
    assert "</script" not in library
    assert "<!--" not in library
