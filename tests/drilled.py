"""Panels with fixing holes, as they are built and as they lie flat."""

from __future__ import annotations

from cadpanel.delivery.panel_fixings import PanelFixings, panel_fixings
from cadpanel.delivery.settings import SheetSettings
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.geometry.fixings import Hole
from cadpanel.geometry.panel import Panel

SHOP = ShopSettings(fixings=(30.0, 450.0, 40.0), k_factor=0.5)


def fixed(shape: Panel, sheet: SheetSettings, shop: ShopSettings = SHOP) -> tuple[PanelFixings, tuple[Hole, ...]]:
    """The holes of a panel, and what drills them."""
    found = panel_fixings(shape, sheet, shop)
    assert found is not None
    return found, found.holes
