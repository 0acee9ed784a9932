"""The tree of a document: panels by strip and feature, seams, skins and flat patterns, and the schedule."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from cadpanel.delivery.contents import Contents
from cadpanel.delivery.document.colors import FLAT, SEAM, SKIN, ramp, share
from cadpanel.delivery.document.neighbours import neighbours, seam_properties
from cadpanel.delivery.document.objects import (
    AnyProperty,
    Body,
    DocumentObject,
    Group,
    Look,
    Number,
    Place,
    Sheet,
    Words,
)
from cadpanel.delivery.document.panels import flat_properties, panel_properties, skin_properties
from cadpanel.delivery.records.report import PanelModel, SeamModel
from cadpanel.delivery.schedule.rows import schedule_rows, strip_of

PANELS, SEAMS, SKINS, FLATS, SCHEDULE = "Panels", "Seams", "Skins", "Flats", "Schedule"
"""Names of what stands at the top of the tree."""
_HIDDEN = Look(visible=False)
_SEAM_LOOK = Look(lines=SEAM, line_width=3.0)
_SKIN_LOOK = Look(visible=False, faces=SKIN)
_FLAT_LOOK = Look(visible=False, faces=FLAT)


def tree(contents: Contents) -> list[DocumentObject]:
    """All objects of a delivery's document, every group before what stands in it."""
    return [
        *_panels(contents),
        *_seams(contents),
        *_beside(contents.records, SKINS, "Skins", "skin"),
        *_beside(contents.records, FLATS, "Flat patterns", "flat"),
        Sheet(name=SCHEDULE, label="Schedule", cells=list(schedule_rows(contents))),
    ]


def panel_file(place: int) -> str:
    """Where the archive keeps the solid of the panel at that place; FreeCAD tells by the ending that it is binary."""
    return f"panel{place + 1}.bin"


def skin_file(place: int) -> str:
    """Where it keeps the skin."""
    return f"skin{place + 1}.bin"


def flat_file(place: int) -> str:
    """Where it keeps the flat pattern."""
    return f"flat{place + 1}.bin"


def seam_file(place: int) -> str:
    """Where it keeps the lines of the seam at that place among those that are drawn."""
    return f"seam{place + 1}.bin"


def drawn_seams(contents: Contents) -> list[SeamModel]:
    """The seams of which at least one panel is delivered."""
    own = {panel.name for panel in contents.records}
    return [seam for seam in contents.seams if own & set(seam.panels)]


def _panels(contents: Contents) -> Iterator[DocumentObject]:
    yield Group(name=PANELS, label="Panels", properties=list(_of_all(contents)))
    met = neighbours(contents.seams)
    deviations = [panel.max_deviation for panel in contents.records]
    least, largest = min(deviations), max(deviations)
    strips: dict[str, str] = {}
    features: dict[tuple[str, str], str] = {}
    for place, panel in enumerate(contents.records):
        strip = strip_of(panel.name)
        if strip and strip not in strips:
            strips[strip] = f"Strip{len(strips) + 1}"
            yield Group(name=strips[strip], label=f"Strip {strip}", parent=PANELS)
        kind = strip, panel.feature
        if kind not in features:
            features[kind] = f"Feature{len(features) + 1}"
            label = f"{strip} {panel.feature}".strip()
            yield Group(name=features[kind], label=label, parent=strips.get(strip, PANELS))
        yield Body(
            name=f"Panel{place + 1}",
            label=panel.name,
            parent=features[kind],
            file=panel_file(place),
            look=Look(faces=ramp(share(panel.max_deviation, least, largest))),
            properties=list(panel_properties(panel, met.get(panel.name, []))),
        )


def _of_all(contents: Contents) -> Iterator[AnyProperty]:
    heading = "Delivery"
    yield Words(name="Reference", group=heading, tip="what was approximated", value=contents.title)
    thickness = contents.sheet.thickness
    yield Number(name="Thickness", group=heading, tip="of the sheet", kind="Length", value=thickness)
    if contents.joint is not None:
        tip = "clear width between sheets that was asked for"
        yield Number(name="Joint", group=heading, tip=tip, kind="Length", value=contents.joint)
    tip = "which face of the sheet is the fitted skin"
    yield Words(name="SkinSide", group=heading, tip=tip, value=contents.sheet.skin_side)
    tip = "what to add to coordinates to have those of the model"
    yield Place(name="Origin", group=heading, tip=tip, value=contents.origin)


def _seams(contents: Contents) -> Iterator[DocumentObject]:
    yield Group(name=SEAMS, label="Seams")
    for place, seam in enumerate(drawn_seams(contents)):
        yield Body(
            name=f"Seam{place + 1}",
            label=" | ".join(seam.panels),
            parent=SEAMS,
            file=seam_file(place),
            look=_SEAM_LOOK,
            properties=list(seam_properties(seam)),
        )


def _beside(panels: Sequence[PanelModel], name: str, label: str, word: str) -> Iterator[DocumentObject]:
    """Skins or flat patterns, hidden."""
    yield Group(name=name, label=label, look=_HIDDEN)
    skins = name == SKINS
    for place, panel in enumerate(panels):
        yield Body(
            name=f"{word.title()}{place + 1}",
            label=f"{panel.name} {word}",
            parent=name,
            file=(skin_file if skins else flat_file)(place),
            look=_SKIN_LOOK if skins else _FLAT_LOOK,
            properties=list((skin_properties if skins else flat_properties)(panel)),
        )
