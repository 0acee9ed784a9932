"""Drawings on paper: a page for each panel and one for all, words that another reader finds, the same bytes again."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import pytest
from pypdf import PdfReader

from cadpanel.delivery.deliver import deliver
from cadpanel.delivery.outputs.drawings_pdf import DRAWINGS
from cadpanel.delivery.pages.proof import page_texts
from cadpanel.delivery.records.report import ReportModel
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.delivery.verify import verify
from cadpanel.errors import DeliveryError
from tests.delivered import fitted
from tests.thorough import thorough

SHOP = ShopSettings(outputs="pdf", mesh_chord=5.0, material="EN AW-5754", author="N. N.", fixings=(6.5, 450.0, 40.0))


@pytest.fixture(scope="module")
def delivery(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, ReportModel]:
    out = tmp_path_factory.mktemp("pdf") / "out"
    return out, deliver(fitted(), out, shop=SHOP)


def test_every_panel_has_a_page_with_its_numbers(delivery: tuple[Path, ReportModel]) -> None:
    out, report = delivery
    first, *pages = page_texts(out / DRAWINGS)
    assert len(pages) == len(report.panels)
    assert report.certificate.outputs["pdf"] == {"pages": 4}
    for text, panel in zip(pages, report.panels, strict=True):
        name = panel.name.replace(" ", "")
        assert name in first
        assert panel.blank is not None
        assert f"{panel.blank.width:.1f}x{panel.blank.height:.1f}mm" in text
        assert f"{panel.blank.edges['side 0']:.1f}" in text
        assert f"{panel.bends[0].radius[0]:.1f}-{panel.bends[0].radius[1]:.1f}" in text
        for words in ("thisfaceout", "EN AW-5754".replace(" ", ""), "N.N.", f"{panel.mass:.2f}kg", "scale"):
            assert words in text
        assert f"fixingholes{len(panel.fixings)}of6.5mm" in text
    assert "end1:N2" in pages[0]
    for page, panel in zip(PdfReader(out / DRAWINGS).pages[1:], report.panels, strict=True):
        contents = page.get_contents()
        assert contents is not None
        # Nothing but circles is round on a page, and each of them is four curves.
        assert len(re.findall(rb"(?<=\d) c\b", contents.get_data())) == 4 * len(panel.fixings) > 0


@thorough
def test_the_same_delivery_gives_the_same_bytes_at_the_same_date(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    for name in ("one", "two"):
        deliver(fitted(), tmp_path / name, shop=replace(SHOP, only=("N 1",)))
    one, two = ((tmp_path / name / DRAWINGS).read_bytes() for name in ("one", "two"))
    assert one == two
    assert b"D:20231114221320" in one
    assert "2023-11-14" in page_texts(tmp_path / "one" / DRAWINGS)[1]


@thorough
def test_what_is_not_the_reports_is_told(delivery: tuple[Path, ReportModel], tmp_path: Path) -> None:
    out, _ = delivery
    whole = (out / DRAWINGS).read_bytes()
    assert verify(out).holds
    deliver(fitted(), tmp_path / "less", shop=replace(SHOP, only=("N 1", "N 3")))
    deliver(fitted(), tmp_path / "thick", shop=replace(SHOP, k_factor=0.0))
    try:
        (out / DRAWINGS).write_bytes((tmp_path / "less" / DRAWINGS).read_bytes())
        less = verify(out).failures
        (out / DRAWINGS).write_bytes((tmp_path / "thick" / DRAWINGS).read_bytes())
        other = verify(out).failures
        for damage in (b"", b"%PDF-1.4\n", whole[: len(whole) // 2]):
            (out / DRAWINGS).write_bytes(damage)
            with pytest.raises(DeliveryError, match=r"drawings\.pdf' cannot be read: it is no whole PDF file"):
                verify(out)
    finally:
        (out / DRAWINGS).write_bytes(whole)
    # The manifest speaks first.
    assert less[1:] == ("'drawings.pdf' has 3 pages instead of 4.",)
    assert len(other) == 4
    assert "'drawings.pdf': the page of panel 'N 1' does not say" in other[1]
