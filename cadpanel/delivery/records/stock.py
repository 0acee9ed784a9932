"""Which panels fit no sheet of the store, in a sentence."""

from __future__ import annotations

import math

from cadpanel.delivery.chosen_panels import chosen_panels
from cadpanel.delivery.records.report import ReportModel

# Panels that are named; the others are counted.
_NAMED = 5


def stock_shortfall(report: ReportModel) -> str | None:
    """What to say of delivered panels that fit no sheet of the stock, and of how large one must be; None if all fit."""
    stock = report.settings.stock
    if not stock:
        return None
    own = set(chosen_panels([panel.name for panel in report.panels], report.settings.only))
    blanks = {panel.name: panel.blank for panel in report.panels if panel.blank is not None and panel.name in own}
    unfit = {name: blank for name, blank in blanks.items() if blank.stock is None}
    if not unfit:
        return None
    shown = [f"'{name}' ({blank.width:.0f} x {blank.height:.0f} mm)" for name, blank in list(unfit.items())[:_NAMED]]
    more = f" and {len(unfit) - _NAMED} more" if len(unfit) > _NAMED else ""
    sheets = " or ".join(f"{length:g}x{width:g}" for length, width in stock)
    long, wide = (max(getattr(blank, side) for blank in unfit.values()) for side in ("width", "height"))
    return (
        f"{len(unfit)} of {len(blanks)} blanks fit no sheet of {sheets} mm: {', '.join(shown)}{more}; give --stock "
        f"a sheet of {math.ceil(long)}x{math.ceil(wide)} mm, too, or cut the surface into more panels"
    )
