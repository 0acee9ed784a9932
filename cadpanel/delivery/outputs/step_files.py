"""The two STEP files of a delivery: their names, titles and colours."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from cadpanel.delivery.outputs.output import Delivery, Output
from cadpanel.delivery.settings import Schema

if TYPE_CHECKING:
    from cadpanel.brep.step.file import Color
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
        write_solids(folder / PANELS, delivery.panels, delivery.title, delivery.sheet.schema, delivery.placed)


class SkinsStep(Output):
    """The skins as open shells, one product a panel."""

    name = "skins"
    files = (SKINS,)
    always = True

    def write(self, folder: Path, delivery: Delivery) -> None:
        """See `Output.write`."""
        write_skins(folder / SKINS, delivery.panels, delivery.title, delivery.sheet.schema, delivery.placed)


def write_solids(
    path: Path, panels: Sequence[PanelSheet], title: str, schema: Schema = "AP242", placed: Place = AT_HOME
) -> None:
    """Write one solid a panel; the origin of their coordinates is placed somewhere in the assembly, mm.

    Raises:
        DeliveryError: the file cannot be written.
    """
    from cadpanel.brep.step.file import write_step

    shapes = [(panel.shape.name, panel.solid, colour(i)) for i, panel in enumerate(panels)]
    write_step(path, shapes, title=f"{title} panels", schema=schema, placed=placed)


def write_skins(
    path: Path, panels: Sequence[PanelSheet], title: str, schema: Schema = "AP242", placed: Place = AT_HOME
) -> None:
    """Write one open shell a panel, under the same names, in the same colours and at the same place.

    Raises:
        DeliveryError: the file cannot be written.
    """
    from cadpanel.brep.step.file import write_step

    shapes = [(panel.shape.name, panel.skin, colour(i)) for i, panel in enumerate(panels)]
    write_step(path, shapes, title=f"{title} skins", schema=schema, placed=placed)


def colour(place: int) -> Color:
    """The colour of the panel at that place."""
    return PALETTE[place % len(PALETTE)]
