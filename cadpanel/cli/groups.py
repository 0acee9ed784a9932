"""The groups in which options stand in the help, in their order."""

from __future__ import annotations

from typing import Any

from cadpanel.delivery.settings import SheetSettings
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.fitting.settings import FitSettings
from cadpanel.reference.settings import ReferenceSettings

INPUT, CUTTING, SHAPE, LIMITS, SHEET, OUTPUT, RUN = GROUPS = (
    "Input",
    "Cutting",
    "Shape",
    "Limits",
    "Sheet",
    "Output",
    "Run",
)

# Where a setting stands of which nothing else is said below, so that a new one has its place at once.
_USUAL: dict[type[Any], str] = {
    ReferenceSettings: CUTTING,
    FitSettings: LIMITS,
    SheetSettings: SHEET,
    ShopSettings: OUTPUT,
}
_SINGLE = {
    **dict.fromkeys(("unit", "faces", "seam_tolerance"), INPUT),
    **dict.fromkeys(("feature", "tilt", "blend"), SHAPE),
    **dict.fromkeys(("density", "stock", "facet_height", "k_factor", "material", "fixings", "returns"), SHEET),
    **dict.fromkeys(("method", "restarts", "seed", "energy", "tau"), RUN),
    "schema": OUTPUT,
}


def group_of(settings: type[Any], name: str) -> str | None:
    """The group of a setting; None for settings that are none of cadpanel's own."""
    return _SINGLE.get(name, _USUAL[settings]) if settings in _USUAL else None


def rank(group: str | None) -> int:
    """Where a group stands; what is in none comes first."""
    return -1 if group is None else GROUPS.index(group)
