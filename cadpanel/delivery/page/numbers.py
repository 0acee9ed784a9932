"""What a page tells in numbers: those of the report, as far as they are known before the files are proved."""

from __future__ import annotations

from typing import Any

from cadpanel.delivery.contents import Contents
from cadpanel.delivery.records.patches import ConePatchModel, CylinderPatchModel
from cadpanel.delivery.records.report import PanelModel, SeamModel

Numbers = dict[str, Any]
"""What JSON can hold."""
# More than are shown: a number that is rounded twice may end up on the wrong side.
_DIGITS = 9


def page_numbers(contents: Contents) -> Numbers:
    """Title, sheet, verdict, the panels that are delivered and all seams of theirs."""
    shown = {record.name for record in contents.records}
    sheet = contents.sheet
    return {
        "title": contents.title,
        "sheet": {"thickness": sheet.thickness, "joint": sheet.joint, "skin_side": sheet.skin_side},
        "summary": None if contents.summary is None else {"tolerance_met": contents.summary.tolerance_met},
        "panels": [_panel(record) for record in contents.records],
        "seams": [_seam(seam) for seam in contents.seams if shown & set(seam.panels)],
    }


def _panel(record: PanelModel) -> Numbers:
    blank = record.blank
    return {
        "name": record.name,
        "feature": record.feature,
        "rms": _rounded(record.rms_deviation),
        "deviation": _rounded(record.max_deviation),
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
        "gap": _rounded(seam.max_seam_gap),
        "width": _rounded(seam.width),
        "step": _rounded(seam.step),
        "shift": _rounded(seam.shift),
        "kink": _rounded(seam.max_kink),
    }


def _rounded(value: float) -> float:
    """A number without the digits that nobody sees; the report has all of them."""
    return float(f"{value:.{_DIGITS}g}")
