"""Blanks of a fit against the sheets of the store, as they are built with returns, and of what is delivered alone."""

from __future__ import annotations

from dataclasses import replace

from cadpanel.delivery.blanks_fit import blanks_fit
from cadpanel.delivery.records.flat_parts import flat_parts
from cadpanel.delivery.settings import SheetSettings
from cadpanel.delivery.shop_settings import ShopSettings
from tests.delivered import fitted

SHEET = SheetSettings()


def test_every_panel_that_is_delivered_has_to_fit_as_it_is_built() -> None:
    result = fitted()
    blanks = [part.size.blank for part in flat_parts(result.shapes, SHEET, ShopSettings())]
    long, wide = max(blank.length for blank in blanks) + 1.0, max(blank.width for blank in blanks) + 1.0
    enough = ShopSettings(stock=((long, wide),))
    assert blanks_fit(result, SHEET, ShopSettings())
    assert blanks_fit(result, SHEET, enough)
    assert not blanks_fit(result, SHEET, replace(enough, returns=(60.0, 3.0)))
    widest = max(range(len(blanks)), key=lambda place: blanks[place].length)
    small = ShopSettings(stock=((blanks[widest].length - 1.0, wide),))
    assert not blanks_fit(result, SHEET, small)
    others = tuple(shape.name for place, shape in enumerate(result.shapes) if place != widest)
    fits_others = all(blank.length < blanks[widest].length - 1.0 for p, blank in enumerate(blanks) if p != widest)
    assert blanks_fit(result, SHEET, replace(small, only=others)) == fits_others
