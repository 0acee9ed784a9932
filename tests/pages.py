"""A page of a small strip whose panels have names that no page should trip over."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

from cadpanel.delivery.outputs.output import Delivery
from cadpanel.delivery.outputs.report_html import PAGE, ReportHtml
from cadpanel.delivery.page.scene import Scene, scene_of
from cadpanel.delivery.records.flat_parts import flat_parts
from cadpanel.delivery.records.from_fit import panel_records, seam_records, with_flat_parts
from cadpanel.delivery.records.summary import summary
from cadpanel.delivery.settings import SheetSettings
from cadpanel.delivery.sheets import build_panels
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.fitting.result import FitResult
from tests.delivered import fitted

NAMES = ("<script>window.broken = 1</script>", '"it\'s" & </script><b>', "Dach 🏛️ Süd")


def renamed(result: FitResult, names: tuple[str, ...] = NAMES) -> FitResult:
    """The same fit of panels with other names."""
    panels = tuple(replace(panel, name=name) for panel, name in zip(result.reference.panels, names, strict=True))
    shapes = tuple(replace(shape, name=name) for shape, name in zip(result.shapes, names, strict=True))  # type: ignore[type-var]
    return replace(result, reference=replace(result.reference, panels=panels), shapes=shapes)


@cache
def strange() -> FitResult:
    """The fit of the strip under these names."""
    return renamed(fitted())


@cache
def scene() -> Scene:
    """What the page shows."""
    return scene_of(
        strange(), [panel.shape for panel in delivery().panels], [panel.other for panel in delivery().panels]
    )


@cache
def delivery() -> Delivery:
    """What the page of the strip is made of."""
    result, sheet, shop = strange(), SheetSettings(), ShopSettings()
    built = build_panels(result.shapes, sheet, result.reference.seams)
    parts = flat_parts([panel.shape for panel in built.panels], sheet, shop)
    return Delivery(
        panels=built.panels,
        title="<b>strip</b>",
        sheet=sheet,
        shop=shop,
        records=with_flat_parts(panel_records(result, built), built.panels, parts, shop.density),
        seams=seam_records(result.reference, result.measures, built.joints),
        shapes=tuple(panel.shape for panel in built.panels),
        parts=parts,
        summary=summary(result.measures, result.local, result.settings),
        result=result,
    )


def write_page(folder: Path) -> Path:
    """The page in a folder."""
    ReportHtml().write(folder, delivery())
    return folder / PAGE
