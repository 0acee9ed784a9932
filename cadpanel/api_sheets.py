"""Sheets of a result, of one of its shapes or of several, for those functions that hand out solids."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from cadpanel.api_keywords import MadeKeywords, SheetKeywords, check_made
from cadpanel.errors import SettingsError
from cadpanel.fitting.result import FitResult
from cadpanel.geometry.panel import Panel

if TYPE_CHECKING:
    from cadpanel.delivery.sheets import PanelSheet

Panels = FitResult | Panel | Sequence[Panel]
"""What can be built: all panels of a result with their joints, one shape, or several that have no neighbours."""


def shapes_of(panels: Panels) -> Sequence[Panel]:
    """The shapes themselves.

    Raises:
        SettingsError: there is none.
    """
    if isinstance(panels, FitResult):
        return panels.shapes
    found = list(panels) if isinstance(panels, Sequence) else [panels]
    if not found:
        raise SettingsError("there is no panel in the list: give a result, or some of its shapes")
    return found


def build_sheets(panels: Panels, sheet: SheetKeywords, made: MadeKeywords) -> tuple[PanelSheet, ...]:
    """Every one as a sheet, with its solid and its skin.

    Raises:
        PanelError: one cannot be built.
        SettingsError: the thickness, joint, side or schema is none, or there is no panel.
    """
    from cadpanel.delivery.settings import SheetSettings
    from cadpanel.delivery.sheets import build_panels
    from cadpanel.delivery.shop_settings import ShopSettings

    check_made(made)
    asked = SheetSettings(**sheet, ends=made.get("ends", "bevel"))
    shop = ShopSettings(fixings=made.get("fixings"), returns=made.get("returns"))
    if isinstance(panels, FitResult):
        return build_panels(panels.shapes, asked, panels.reference.seams, None, panels.own_joints(), shop).panels
    return build_panels(shapes_of(panels), asked, shop=shop).panels


def title_of(panels: Panels) -> str:
    """How a file or a compound of them is called."""
    if isinstance(panels, FitResult):
        return Path(panels.reference.source).stem
    return panels[0].name if isinstance(panels, Sequence) else panels.name
