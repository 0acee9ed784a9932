"""The two STEP files of a delivery: their names, titles and colours."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from cadpanel.delivery.contents import Contents
from cadpanel.delivery.outputs.output import Delivery, Output
from cadpanel.delivery.settings import Schema
from cadpanel.delivery.source_date import source_date

if TYPE_CHECKING:
    from cadpanel.brep.kernel.types import Shell, Solid
    from cadpanel.brep.step.file import Color
    from cadpanel.brep.step.products import Header
    from cadpanel.brep.step.properties import PartData
    from cadpanel.delivery.sheets import PanelSheet

PANELS = "panels.step"
SKINS = "skins.step"
STEP = "step"
"""What both are called together where outputs are chosen; they are always there."""
Place = tuple[float, float, float]
AT_HOME: Place = (0.0, 0.0, 0.0)
PALETTE: tuple[Color, ...] = (
    (0.62, 0.68, 0.73),
    (0.76, 0.72, 0.65),
    (0.66, 0.73, 0.68),
    (0.72, 0.68, 0.74),
)
"""Quiet colours that tell neighbours apart, sRGB."""


class PanelsStep(Output):
    """The sheets as solids, one product a panel."""

    name = "panels"
    files = (PANELS,)
    always = True

    def write(self, folder: Path, delivery: Delivery) -> None:
        """See `Output.write`."""
        from cadpanel.delivery.part_data import solid_data

        data = [found for found in solid_data(delivery) if found is not None]
        schema, title = delivery.sheet.schema, delivery.title
        write_solids(folder / PANELS, delivery.panels, title, schema, delivery.placed, data, header_of(delivery))


class SkinsStep(Output):
    """The skins as open shells, one product a panel."""

    name = "skins"
    files = (SKINS,)
    always = True

    def write(self, folder: Path, delivery: Delivery) -> None:
        """See `Output.write`."""
        from cadpanel.delivery.part_data import skin_data

        data = [found for found in skin_data(delivery) if found is not None]
        schema, title = delivery.sheet.schema, delivery.title
        write_skins(folder / SKINS, delivery.panels, title, schema, delivery.placed, data, header_of(delivery))


def write_solids(
    path: Path,
    panels: Sequence[PanelSheet],
    title: str,
    schema: Schema = "AP242",
    placed: Place = AT_HOME,
    data: Sequence[PartData] = (),
    header: Header | None = None,
) -> None:
    """Write one solid a panel; the origin of their coordinates is placed somewhere in the assembly, mm.

    Args:
        path: the file.
        panels: what is written.
        title: name of the assembly.
        schema: "AP242" or "AP214".
        placed: where the origin lies.
        data: what is said of each; its number, feature, and numbers to check it by, if empty.
        header: who wrote it; nobody, now, if None.

    Raises:
        DeliveryError: the file cannot be written.
    """
    from cadpanel.brep.step.properties import PartData
    from cadpanel.delivery.part_data import part_number

    said = data or [
        PartData(number=part_number(title, panel.shape.name), description=panel.shape.feature, validation=panel.check)
        for panel in panels
    ]
    _write(path, (panel.solid for panel in panels), panels, f"{title} panels", schema, placed, said, header)


def write_skins(
    path: Path,
    panels: Sequence[PanelSheet],
    title: str,
    schema: Schema = "AP242",
    placed: Place = AT_HOME,
    data: Sequence[PartData] = (),
    header: Header | None = None,
) -> None:
    """Write one open shell a panel, under the same names, in the same colours and at the same place.

    Raises:
        DeliveryError: the file cannot be written.
    """
    from cadpanel.brep.step.properties import PartData
    from cadpanel.delivery.part_data import part_number

    said = data or [
        PartData(number=f"{part_number(title, panel.shape.name)}/skin", validation=panel.skin_check) for panel in panels
    ]
    _write(path, (panel.skin for panel in panels), panels, f"{title} skins", schema, placed, said, header)


def _write(
    path: Path,
    shapes: Iterable[Solid | Shell],
    panels: Sequence[PanelSheet],
    title: str,
    schema: Schema,
    placed: Place,
    said: Sequence[PartData],
    header: Header | None,
) -> None:
    """One shape of each panel under its name and in its colour."""
    from cadpanel.brep.step.file import write_step
    from cadpanel.brep.step.products import Header

    named = ((panel.shape.name, shape, colour(i)) for i, (panel, shape) in enumerate(zip(panels, shapes, strict=True)))
    header = header or Header(date=source_date())
    write_step(path, named, title=title, schema=schema, placed=placed, data=said, header=header)


def header_of(contents: Contents) -> Header:
    """Who writes, when, and in which coordinates.

    Raises:
        SettingsError: SOURCE_DATE_EPOCH is no number of seconds.
    """
    from cadpanel.brep.step.products import Header

    shop = contents.shop
    return Header(date=source_date(), author=shop.author, organization=shop.organization, note=contents.where)


def colour(place: int) -> Color:
    """The colour of the panel at that place."""
    return PALETTE[place % len(PALETTE)]
