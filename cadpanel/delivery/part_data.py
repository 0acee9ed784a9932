"""What STEP files say of panels besides their shapes: part numbers, attributes, numbers to check an import by."""

from __future__ import annotations

from cadpanel.brep.step.properties import Material, PartData, Validation
from cadpanel.delivery.contents import Contents
from cadpanel.delivery.records.report import PanelModel


def part_number(title: str, name: str) -> str:
    """A panel's number, different from those of other projects: the reference's name and the panel's."""
    return f"{title}/{name}"


def solid_data(contents: Contents) -> tuple[PartData | None, ...]:
    """What panels.step says of every panel; None where the report is from before it said anything."""
    return tuple(_solid(panel, contents) for panel in contents.records)


def skin_data(contents: Contents) -> tuple[PartData | None, ...]:
    """The same for skins.step."""
    return tuple(_skin(panel, contents) for panel in contents.records)


def _solid(panel: PanelModel, contents: Contents) -> PartData | None:
    if panel.surface is None or panel.centroid is None:
        return None
    density, material = contents.shop.density, contents.shop.material
    return PartData(
        number=part_number(contents.title, panel.name),
        description=f"{panel.feature}, {contents.sheet.thickness:g} mm",
        validation=Validation(area=panel.surface, volume=panel.volume, centroid=panel.centroid),
        # A density is always known, and readers of the kernel take it for another attribute where no name stands by.
        material=Material(name=material or f"density {density:g} kg/m3", density=density),
        attributes=_attributes(panel, contents),
    )


def _skin(panel: PanelModel, contents: Contents) -> PartData | None:
    if panel.skin_centroid is None:
        return None
    return PartData(
        number=f"{part_number(contents.title, panel.name)}/skin",
        description=f"skin of {panel.feature}",
        validation=Validation(area=panel.area, volume=None, centroid=panel.skin_centroid),
    )


def _attributes(panel: PanelModel, contents: Contents) -> dict[str, str | float]:
    found: dict[str, str | float] = {"thickness": contents.sheet.thickness, "feature": panel.feature}
    if contents.shop.material:
        found["material"] = contents.shop.material
    if panel.bends:
        found["smallest inner radius"] = min(bend.radius[0] for bend in panel.bends)
        found["largest inner radius"] = max(bend.radius[1] for bend in panel.bends)
    if panel.mass is not None:
        found["mass"] = panel.mass
    if panel.blank is not None:
        found |= {"blank length": panel.blank.width, "blank width": panel.blank.height}
        if panel.blank.stock is not None:
            found["stock sheet"] = panel.blank.stock
    return found
