"""Do the blanks of a fit's panels fit the sheets of the store?"""

from __future__ import annotations

from cadpanel.delivery.chosen_panels import chosen_panels
from cadpanel.delivery.records.flat_parts import flat_parts
from cadpanel.delivery.settings import SheetSettings
from cadpanel.delivery.sheets import build_panels, say_nothing
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.fitting.result import FitResult


def blanks_fit(result: FitResult, sheet: SheetSettings, shop: ShopSettings) -> bool:
    """Whether every panel that would be delivered, as it is built with joints and returns, fits a sheet of the stock.

    Raises:
        PanelError: a panel cannot be built.
    """
    if not shop.stock:
        return True
    built = build_panels(result.shapes, sheet, result.reference.seams, say_nothing, result.own_joints(), shop)
    shapes = [panel.shape for panel in built.panels]
    own = set(chosen_panels([shape.name for shape in shapes], shop.only))
    parts = flat_parts(shapes, sheet, shop)
    return all(part.blank.stock is not None for shape, part in zip(shapes, parts, strict=True) if shape.name in own)
