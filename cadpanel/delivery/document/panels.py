"""A panel, its skin and its flat pattern as objects of a document, with what the report says of them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from cadpanel.delivery.document.neighbours import Neighbour, neighbour_properties
from cadpanel.delivery.document.objects import AnyProperty, Choice, Lines, Number, NumberKind, Words
from cadpanel.delivery.records.blanks import BendModel
from cadpanel.delivery.records.patches import ConePatchModel, CylinderPatchModel
from cadpanel.delivery.records.report import PanelModel
from cadpanel.features.catalogue import CATALOGUE, POLYGON

_PANEL, _FLAT = "Panel", "Flat pattern"
_SPLINES = (3, 5)
FEATURES = (*CATALOGUE, POLYGON, *(f"cone-spline-{cones}" for cones in _SPLINES))
"""The features that users choose from for the next fit."""


def panel_properties(panel: PanelModel, met: Sequence[Neighbour]) -> Iterator[AnyProperty]:
    """All of a panel's own, its bends and its neighbours."""
    yield _name(panel)
    yield Words(name="Feature", group=_PANEL, tip="shape feature, as it was fitted", value=panel.feature)
    options = FEATURES if panel.feature in FEATURES else (*FEATURES, panel.feature)
    tip = "shape feature to fit next: change it, and run Fit of the cadpanel workbench"
    yield Choice(name="WantedFeature", group=_PANEL, tip=tip, options=options, value=panel.feature)
    numbers: list[tuple[str, str, NumberKind, float]] = [
        ("RmsDeviation", "of the drawing from the panel, root mean square", "Length", panel.rms_deviation),
        ("LargestDeviation", "of the drawing from the panel", "Length", panel.max_deviation),
        ("Hausdorff", "largest distance between trimmed skin and drawing, both ways", "Length", panel.hausdorff),
        ("CornerDrift", "farthest corner from where the drawing has it", "Length", panel.max_corner_drift),
        ("SkinArea", "of the skin", "Area", panel.area),
        ("SheetVolume", "of the sheet", "Volume", panel.volume),
    ]
    yield from _numbers(numbers, _PANEL)
    if panel.mass is not None:
        yield Number(name="MassKg", group=_PANEL, tip="of the sheet, kg", kind="Float", value=panel.mass)
    yield Lines(name="Notes", group=_PANEL, tip="what the fabricator should know", value=panel.notes)
    yield from _bends(panel)
    yield from neighbour_properties(met)


def skin_properties(panel: PanelModel) -> Iterator[AnyProperty]:
    """Those of the faces that approximate the drawing."""
    yield _name(panel)
    yield Number(name="SkinArea", group=_PANEL, tip="of the skin", kind="Area", value=panel.area)


def flat_properties(panel: PanelModel) -> Iterator[AnyProperty]:
    """Those of the flat pattern."""
    yield _name(panel)
    blank = panel.blank
    assert blank is not None  # reports from before there were flat parts have no document
    numbers: list[tuple[str, str, NumberKind, float]] = [
        ("BlankLength", "longer side of the smallest rectangle about it", "Length", blank.width),
        ("BlankWidth", "shorter side of it", "Length", blank.height),
        ("BlankArea", "inside the exact contour; its arcs are within the chord that was asked for", "Area", blank.area),
    ]
    yield from _numbers(numbers, _FLAT)
    if blank.stock is not None:
        yield Words(name="Stock", group=_FLAT, tip="smallest sheet of the stock that it fits on", value=blank.stock)


def least_radius(panel: PanelModel) -> float | None:
    """The least radius of the skin anywhere on the panel, mm; None where it is flat."""
    return min((patch.radius_min for patch in _round(panel)), default=None)


def _bends(panel: PanelModel) -> Iterator[AnyProperty]:
    told: dict[int, BendModel] = {bend.patch: bend for bend in panel.bends}
    places = [place for place, patch in enumerate(panel.patches) if patch.kind != "plane"]
    for number, (place, patch) in enumerate(zip(places, _round(panel), strict=True), start=1):
        prefix, heading = f"Bend{number}", f"Bend {number}"
        yield Words(name=f"{prefix}Kind", group=heading, tip="cone or cylinder", value=patch.kind)
        half_angle = patch.half_angle if isinstance(patch, ConePatchModel) else 0.0
        numbers: list[tuple[str, str, NumberKind, float]] = [
            (f"{prefix}RadiusLeast", "least radius of the skin", "Length", patch.radius_min),
            (f"{prefix}RadiusLargest", "largest radius of the skin", "Length", patch.radius_max),
            (f"{prefix}HalfAngle", "between the axis and the rulings", "Angle", half_angle),
            (f"{prefix}Sweep", "by which the sheet turns about the axis", "Angle", abs(patch.sweep)),
        ]
        if place in told:
            inner = told[place].radius
            numbers += [
                (f"{prefix}InnerRadiusLeast", "least radius of the sheet's inner face", "Length", inner[0]),
                (f"{prefix}InnerRadiusLargest", "largest radius of the sheet's inner face", "Length", inner[1]),
            ]
        yield from _numbers(numbers, heading)
        if place in told:
            tip = "down: away from who looks at the outer face"
            yield Words(name=f"{prefix}Direction", group=heading, tip=tip, value=told[place].direction)
    least = least_radius(panel)
    if least is not None:
        tip = "least radius of the skin in any bend"
        yield Number(name="LeastRadius", group="All bends", tip=tip, kind="Length", value=least)


def _round(panel: PanelModel) -> list[ConePatchModel | CylinderPatchModel]:
    return [patch for patch in panel.patches if isinstance(patch, ConePatchModel | CylinderPatchModel)]


def _name(panel: PanelModel) -> Words:
    return Words(name="PanelName", group=_PANEL, tip="the panel's name in every file of the delivery", value=panel.name)


def _numbers(told: Sequence[tuple[str, str, NumberKind, float]], group: str) -> Iterator[Number]:
    for name, tip, kind, value in told:
        yield Number(name=name, group=group, tip=tip, kind=kind, value=value)
