"""A document held against the delivery that it lies in: what was moved, changed, lost or added since."""

from __future__ import annotations

from typing import Any

from .documents import folder_of, panels_of, report_of

_SAME_VOLUME = 1e-6
"""Of itself."""
_SAME_PLACE = 1e-3
"""Millimetres."""
_NUMBERS = {"RmsDeviation": "rms_deviation", "LargestDeviation": "max_deviation", "CornerDrift": "max_corner_drift"}


def check(document: Any) -> list[str]:
    """One sentence for everything that differs from the delivery; none where all is as it was delivered.

    Raises:
        DeliveryMissing: there is no report beside the document, or no panel in it.
    """
    report = report_of(folder_of(document))
    told: dict[str, dict[str, Any]] = {panel["name"]: panel for panel in report["panels"]}
    found: dict[str, list[Any]] = {}
    for panel in panels_of(document):
        found.setdefault(panel.PanelName, []).append(panel)
    faults = [f"Panel '{name}' stands {len(own)} times in the document." for name, own in found.items() if len(own) > 1]
    faults += [f"Panel '{name}' is not in the delivery." for name in found if name not in told]
    only = report["settings"].get("only")
    if not only:
        faults += [f"Panel '{name}' is missing in the document." for name in told if name not in found]
    for name, own in found.items():
        if name in told:
            faults += [f"Panel '{name}' {what}." for what in _changed(own[0], told[name])]
    return faults


def _changed(panel: Any, told: dict[str, Any]) -> list[str]:
    faults = []
    place = panel.getGlobalPlacement()
    if place.Base.Length > _SAME_PLACE:
        faults.append(f"was moved by {place.Base.Length:.4g} mm")
    elif panel.Shape.Volume and abs(place.Rotation.Angle) > 1e-9:
        faults.append("was turned")
    volume = panel.Shape.Volume
    if abs(volume - told["volume"]) > _SAME_VOLUME * told["volume"]:
        faults.append(f"has {volume:.6g} mm3 instead of {told['volume']:.6g}")
    if panel.Feature != told["feature"]:
        faults.append(f"is called a {panel.Feature} and was delivered as a {told['feature']}")
    for name, key in _NUMBERS.items():
        if getattr(panel, name).Value != told[key]:
            faults.append(f"says {name} {getattr(panel, name).Value:.6g} instead of {told[key]:.6g}")
    return faults
