"""Names in any alphabet are printed and read back as they are, and what no font shows is said by its code."""

from __future__ import annotations

import io

import pytest
from pypdf import PdfReader

from cadpanel.delivery.pages.fonts import BOLD, REGULAR, runs, shown, width_in_points
from cadpanel.delivery.pages.paper import Paper

NAMES = ("Süd-01", "Панель 7", "Πάνελ ω", "面板-七 臺", "パネル 込 畑", "패널 3")


@pytest.mark.parametrize("bold", [False, True])
def test_names_of_many_scripts_are_read_back_as_they_were_printed(bold: bool) -> None:
    paper = Paper("t", "")
    for row, name in enumerate(NAMES):
        assert shown(name) == name
        paper.words(name, (20.0, 20.0 + 10.0 * row), 5.0, bold=bold)
    text = PdfReader(io.BytesIO(paper.data()), strict=True).pages[0].extract_text()
    assert [name for name in NAMES if "".join(name.split()) not in "".join(text.split())] == []


def test_each_sign_is_shown_by_a_font_that_has_it() -> None:
    assert runs("Ω-面板 패널", bold=True) == [
        (BOLD, "Ω-"),
        ("STSong-Light", "面板"),
        (BOLD, " "),
        ("HYGothic-Medium", "패널"),
    ]
    assert runs("", bold=True) == []
    assert width_in_points("面板", 10.0) == 20.0
    assert {font for font, _ in runs("Панель Πάνελ Süd")} == {REGULAR}


@pytest.mark.parametrize("sign", ["\n", "\U0001f3e0", "\u05d0", "\u0633", "\u0301", "\u0e34"])
def test_a_sign_that_would_come_out_wrong_stands_as_its_code(sign: str) -> None:
    assert shown(f"q{sign}7") == f"q<U+{ord(sign):04X}>7"
