"""Flat parts of known panels, and deliveries of a small strip, for all tests of what the shop gets."""

from __future__ import annotations

from collections.abc import Sequence

from cadpanel.delivery.records.flat_parts import FlatPart, flat_parts
from cadpanel.delivery.records.from_fit import panel_records, seam_records, with_flat_parts
from cadpanel.delivery.records.report import PanelModel, SeamModel
from cadpanel.delivery.settings import SheetSettings
from cadpanel.delivery.sheets import build_panels
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.fitting.result import FitResult
from cadpanel.geometry.panel import Panel
from tests.delivered import fitted

SHEET = SheetSettings()


def parts_of(shapes: Sequence[Panel], shop: ShopSettings | None = None) -> tuple[FlatPart, ...]:
    """The panels in 3 mm sheet."""
    return flat_parts(shapes, SHEET, shop or ShopSettings())


def strip_records(
    shop: ShopSettings | None = None,
) -> tuple[tuple[PanelModel, ...], tuple[SeamModel, ...], tuple[FlatPart, ...]]:
    """What the report says of the small strip, and its parts."""
    return records_of(fitted(), shop)


def records_of(
    result: FitResult, shop: ShopSettings | None = None
) -> tuple[tuple[PanelModel, ...], tuple[SeamModel, ...], tuple[FlatPart, ...]]:
    """The same of any fit."""
    asked = shop or ShopSettings()
    built = build_panels(result.shapes, SHEET, result.reference.seams, shop=shop)
    parts = flat_parts([panel.shape for panel in built.panels], SHEET, asked)
    records = with_flat_parts(panel_records(result, built), built.panels, parts, asked.density)
    return records, seam_records(result.reference, result.measures, built.joints), parts
