"""Returns in a delivery: part of solid, flat pattern, bends and report, proved, and said where there are none."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from cadpanel.arrays import Array
from cadpanel.delivery.contents import Contents
from cadpanel.delivery.deliver import deliver
from cadpanel.delivery.earlier import with_earlier
from cadpanel.delivery.panel_returns import returned
from cadpanel.delivery.return_checks import return_faults
from cadpanel.delivery.settings import SheetSettings
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.delivery.verify import verify
from cadpanel.errors import PanelError
from cadpanel.fitting.result import FitResult
from cadpanel.fitting.rules.book import rules_of
from cadpanel.fitting.run import fit
from cadpanel.fitting.settings import FitSettings
from cadpanel.geometry.sheet_checks import SkinSide
from tests.delivered import fitted
from tests.fitted_grids import fitted as fitted_grid
from tests.fitted_grids import gable
from tests.flat_parts import records_of, strip_records
from tests.instances import random_polygon
from tests.shapes import random_panel
from tests.thorough import cases, thorough

SHOP = ShopSettings(returns=(30.0, 2.5), k_factor=0.4, fixings=(6.0, cases(1200.0, 400.0), 12.0))


def earlier_places(folder: Path) -> Array:
    """Where a rule that locks panels to a delivery holds them, mm."""
    asked = FitSettings(rules=rules_of({"lock": [{"panels": "*", "delivery": str(folder)}]}))
    rules = with_earlier(asked, fitted().reference).rules
    assert rules is not None
    return np.array(rules.plain()["lock"][0]["made"])


@thorough
@pytest.mark.parametrize(("ends", "side"), cases([("square", "outer")], [("bevel", "inner"), ("square", "outer")]))
def test_returns_are_part_of_everything_and_proved(tmp_path: Path, ends: str, side: SkinSide) -> None:
    sheet = SheetSettings(ends=ends, skin_side=side, joint=8.0)  # type: ignore[arg-type]
    plain = deliver(fitted(), tmp_path / "plain", sheet, replace(SHOP, returns=None, outputs="step,flats"))
    report = deliver(fitted(), tmp_path / "out", sheet, SHOP)
    assert verify(tmp_path / "out").holds
    # Gaps are those of the fit, returns or none.
    assert report.certificate.max_seam_gap == pytest.approx(plain.certificate.max_seam_gap, abs=1e-6)
    assert report.certificate.overlap == 0.0
    # Panels that are made already are the same, too, with returns or without.
    assert earlier_places(tmp_path / "out") == pytest.approx(earlier_places(tmp_path / "plain"), abs=1e-6)
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


def test_edges_without_a_return_say_why() -> None:
    sheet = SheetSettings()
    bent = random_panel(1, chain="plane-cone-plane")
    assert returned(bent, sheet, ShopSettings()).shape is bent
    curved = tuple(f"It has no return along end {end}, which is curved." for end in (0, 1))
    both = returned(bent, sheet, SHOP)
    assert (both.edges, both.notes) == (("side 0", "side 1"), curved)
    rolled = returned(random_panel(1, chain="plane-cone"), sheet, SHOP)
    assert rolled.edges == ("side 0",)
    assert rolled.notes == ("It has no return along side 1, which is rolled round.", *curved)
    flat = returned(random_panel(1, chain="plane"), sheet, SHOP)
    assert (set(flat.edges), flat.notes, flat.tray) == ({"end 0", "end 1", "side 0", "side 1"}, (), (30.0, 2.5))
    polygon = returned(random_polygon(1, 5), sheet, SHOP)
    assert (polygon.edges, polygon.notes) == (tuple(f"edge {edge}" for edge in range(5)), ())
    with pytest.raises(PanelError, match="ask for one of at least"):
        returned(bent, sheet, ShopSettings(returns=(6.0, 2.5)))


def fitted_gable() -> FitResult:
    """A folded panel whose flange meets a flat pentagon."""
    book = rules_of({"feature": [{"panels": ["panel 2"], "feature": "planar-polygon"}]})
    return fit(gable(0.5), FitSettings(feature="plane-cone-plane", rules=book))


def fitted_quadrilaterals() -> FitResult:
    """Nine flat panels with ends and sides."""
    found: FitResult = fitted_grid("planar-quadrilateral")
    return found


@thorough
@pytest.mark.parametrize(
    ("of", "ends", "side"),
    cases(
        [(fitted_gable, "square", "outer")],
        [(fitted_gable, "bevel", "inner"), (fitted_quadrilaterals, "bevel", "outer")],
    ),
)
def test_returns_at_seams_and_round_flat_panels_keep_joints_as_wide_as_asked(
    tmp_path: Path, of: Callable[[], FitResult], ends: str, side: SkinSide
) -> None:
    sheet = SheetSettings(ends=ends, skin_side=side, joint=12.0)  # type: ignore[arg-type]
    report = deliver(of(), tmp_path / "out", sheet, SHOP)
    assert report.certificate.failures == ()
    assert report.certificate.overlap == 0.0
    assert report.certificate.clear is not None
    assert report.certificate.clear.least >= 12.0 - 1e-6
    for panel in report.panels:
        flat = len(panel.patches) == 1
        assert panel.tray == (SHOP.returns if flat else None)
        assert len(panel.returns) == (len(panel.other_face[0]) * len(panel.other_face) if flat else 2)
    assert verify(tmp_path / "out").holds


def test_a_flat_panel_that_is_not_folded_as_asked_is_seen() -> None:
    (_, record), _, parts = records_of(fitted_gable(), SHOP)
    contents = Contents(title="t", sheet=SheetSettings(), shop=SHOP, records=(record,), seams=(), parts=parts[1:])
    assert return_faults(contents) == ()
    for change, said in (
        ({"tray": (31.0, 2.5)}, "returns are 31 mm long"),
        ({"returns": record.returns[1:]}, f"its {record.returns[0]} has no return"),
        ({"returns": (), "tray": None}, "has no return, and nothing is in its way"),
    ):
        assert said in " ".join(return_faults(replace(contents, records=(record.model_copy(update=change),))))
    assert "not asked for" in " ".join(return_faults(replace(contents, shop=replace(SHOP, returns=None))))


def test_a_return_that_is_missing_too_long_or_too_round_is_seen() -> None:
    records, seams, parts = strip_records(SHOP)
    contents = Contents(title="t", sheet=SheetSettings(), shop=SHOP, records=records, seams=seams, parts=parts)
    assert return_faults(contents) == ()
    assert "its side 0 has no return" in " ".join(
        return_faults(replace(contents, records=(records[0].model_copy(update={"returns": ("side 1",)}),)))
    )
    for returns, said in (
        ((31.0, 2.5), "has a return of 30 mm, 31 mm were asked for"),
        ((30.0, 2.6), "is folded round 5.5 mm on its skin, 5.6 mm were asked for"),
        (None, "has a return that was not asked for"),
    ):
        assert said in " ".join(return_faults(replace(contents, shop=replace(SHOP, returns=returns))))
