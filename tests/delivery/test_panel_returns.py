"""Returns in a delivery: part of solid, flat pattern, bends and report, proved, and said where there are none."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import pytest

from cadpanel.delivery.contents import Contents
from cadpanel.delivery.deliver import deliver
from cadpanel.delivery.panel_returns import returned
from cadpanel.delivery.records.report import ReportModel
from cadpanel.delivery.return_checks import return_faults
from cadpanel.delivery.settings import SheetSettings
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.delivery.verify import verify
from cadpanel.errors import PanelError
from cadpanel.geometry.sheet_checks import SkinSide
from tests.delivered import fitted
from tests.flat_parts import strip_records
from tests.instances import random_polygon
from tests.shapes import random_panel
from tests.thorough import cases

SHOP = ShopSettings(returns=(30.0, 2.5), k_factor=0.4, fixings=(6.0, 400.0, 12.0))


@pytest.mark.parametrize(("ends", "side"), cases([("square", "outer")], [("bevel", "inner"), ("square", "outer")]))
def test_returns_are_part_of_everything_and_proved(tmp_path: Path, ends: str, side: SkinSide) -> None:
    sheet = SheetSettings(ends=ends, skin_side=side, joint=8.0)  # type: ignore[arg-type]
    plain = deliver(fitted(), tmp_path / "plain", sheet, replace(SHOP, returns=None))
    report = deliver(fitted(), tmp_path / "out", sheet, SHOP)
    assert verify(tmp_path / "out").holds
    # Gaps are those of the fit, returns or none.
    assert report.certificate.max_seam_gap == pytest.approx(plain.certificate.max_seam_gap, abs=1e-6)
    assert report.certificate.overlap == 0.0
    allowance = 0.5 * math.pi * (2.5 + 0.4 * 3.0)
    for panel, was in zip(report.panels, plain.panels, strict=True):
        assert panel.returns == ("side 0", "side 1")
        assert [bend.direction for bend in panel.bends] == 3 * ["down"]
        assert panel.bends[0].radius == pytest.approx((2.5, 2.5))
        assert panel.bends[0].sweep == pytest.approx(90.0)
        assert panel.volume > was.volume
        assert panel.blank is not None
        assert was.blank is not None
        # Each leg and its allowance, less what the fold takes of the flange.
        grown = 2.0 * (30.0 - 2.0 * 5.5 + allowance)
        length = 0.5 * (was.blank.edges["side 0"] + was.blank.edges["side 1"])
        assert panel.blank.area - was.blank.area == pytest.approx(grown * length, rel=0.02)


def test_panels_and_sides_without_a_return_say_why() -> None:
    sheet = SheetSettings()
    flat = random_panel(1, chain="plane-cone-plane")
    assert returned(flat, (), sheet, ShopSettings()).shape is flat
    both = returned(flat, (), sheet, SHOP)
    assert (both.sides, both.notes) == (("side 0", "side 1"), ())
    one = returned(flat, {"side 1", "end 0"}, sheet, SHOP)
    assert (one.sides, one.notes) == (("side 0",), ("It has no return along side 1, which meets a neighbour.",))
    rolled = returned(random_panel(1, chain="plane-cone"), (), sheet, SHOP)
    assert (rolled.sides, rolled.notes) == (("side 0",), ("It has no return along side 1, which is rolled round.",))
    polygon = returned(random_polygon(1, 5), (), sheet, SHOP)
    assert (polygon.sides, polygon.notes) == ((), ("It has no returns: only panels with two sides have.",))
    with pytest.raises(PanelError, match="ask for one of at least"):
        returned(flat, (), sheet, ShopSettings(returns=(6.0, 2.5)))


def test_a_return_that_is_missing_too_long_or_too_round_is_seen(tmp_path: Path) -> None:
    report: ReportModel = deliver(fitted(), tmp_path / "out", SheetSettings(), SHOP)
    _, _, parts = strip_records()
    contents = Contents(
        title="t", sheet=SheetSettings(), shop=SHOP, records=report.panels, seams=report.seams, parts=parts
    )
    assert return_faults(contents) == ()
    assert "its side 0 has no return" in " ".join(
        return_faults(replace(contents, records=(report.panels[0].model_copy(update={"returns": ("side 1",)}),)))
    )
    for returns, said in (
        ((31.0, 2.5), "has a return of 30 mm, 31 mm were asked for"),
        ((30.0, 2.6), "is folded round 5.5 mm on its skin, 5.6 mm were asked for"),
        (None, "has a return that was not asked for"),
    ):
        assert said in " ".join(return_faults(replace(contents, shop=replace(SHOP, returns=returns))))
