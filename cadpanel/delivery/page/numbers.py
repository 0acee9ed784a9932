"""What a page tells in numbers: those of the report, as far as they are known before the files are proved."""

from __future__ import annotations

from typing import Any

from cadpanel.delivery.contents import Contents
from cadpanel.delivery.records.patches import ConePatchModel, CylinderPatchModel
from cadpanel.delivery.records.report import PanelModel, SeamModel, SummaryModel

Numbers = dict[str, Any]
"""What JSON can hold."""
# More than are shown: a number that is rounded twice may end up on the wrong side.
_DIGITS = 9
_OF_SUMMARY = (
    "max_corner_gap",
    "max_seam_gap",
    "max_width",
    "max_step",
    "max_shift",
    "max_kink",
    "rms_deviation",
    "max_deviation",
    "hausdorff",
    "max_corner_drift",
)


def page_numbers(contents: Contents) -> Numbers:
    """Title, sheet, summary, the panels that are delivered and all seams of theirs."""
    shown = {record.name for record in contents.records}
    sheet, shop = contents.sheet, contents.shop
    return {
        "title": contents.title,
        "sheet": {"thickness": sheet.thickness, "joint": sheet.joint, "skin_side": sheet.skin_side},
        "density": shop.density,
        "origin": list(contents.origin),
        "summary": None if contents.summary is None else _summary(contents.summary),
        "panels": [_panel(record) for record in contents.records],
        "seams": [_seam(seam) for seam in contents.seams if shown & set(seam.panels)],
    }


def _summary(summary: SummaryModel) -> Numbers:
    found: Numbers = {key: _rounded(getattr(summary, key)) for key in _OF_SUMMARY}
    return {**found, "tolerance_met": summary.tolerance_met}


def _panel(record: PanelModel) -> Numbers:
    blank = record.blank
    return {
        "name": record.name,
        "feature": record.feature,
        "rms": _rounded(record.rms_deviation),
        "deviation": _rounded(record.max_deviation),
        "hausdorff": _rounded(record.hausdorff),
        "drift": _rounded(record.max_corner_drift),
        "area": _rounded(record.area),
        "mass": None if record.mass is None else _rounded(record.mass),
        "blank": None
        if blank is None
        else {"width": _rounded(blank.width), "height": _rounded(blank.height), "stock": blank.stock},
        "bends": [
            {
                "direction": bend.direction,
                "radius": [_rounded(radius) for radius in bend.radius],
                "sweep": _rounded(bend.sweep),
                "hits": bend.hits,
            }
            for bend in record.bends
        ],
        "radii": [
            [_rounded(patch.radius_min), _rounded(patch.radius_max)]
            for patch in record.patches
            if isinstance(patch, ConePatchModel | CylinderPatchModel)
        ],
        "notes": list(record.notes),
    }


def _seam(seam: SeamModel) -> Numbers:
    return {
        "panels": list(seam.panels),
        "edges": list(seam.edges),
        "corner_gap": _rounded(seam.max_corner_gap),
        "gap": _rounded(seam.max_seam_gap),
        "width": _rounded(seam.width),
        "step": _rounded(seam.step),
        "shift": _rounded(seam.shift),
        "kink": _rounded(seam.max_kink),
    }


def _rounded(value: float) -> float:
    """A number without the digits that nobody sees; the report has all of them."""
    return float(f"{value:.{_DIGITS}g}")
