"""The two STEP files of a delivery: their names, titles and colours."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from cadpanel.brep.step.file import Color, write_step
from cadpanel.delivery.settings import Schema
from cadpanel.delivery.sheets import PanelSheet

PALETTE: tuple[Color, ...] = (
    (0.62, 0.68, 0.73),
    (0.76, 0.72, 0.65),
    (0.66, 0.73, 0.68),
    (0.72, 0.68, 0.74),
)
"""Quiet colours that tell neighbours apart, sRGB."""


def write_solids(path: Path, panels: Sequence[PanelSheet], title: str, schema: Schema = "AP242") -> None:
    """Write one solid a panel.

    Raises:
        DeliveryError: the file cannot be written.
    """
    shapes = [(panel.shape.name, panel.solid, colour(i)) for i, panel in enumerate(panels)]
    write_step(path, shapes, title=f"{title} panels", schema=schema)


def write_skins(path: Path, panels: Sequence[PanelSheet], title: str, schema: Schema = "AP242") -> None:
    """Write one open shell a panel, under the same names and in the same colours.

    Raises:
        DeliveryError: the file cannot be written.
    """
    shapes = [(panel.shape.name, panel.skin, colour(i)) for i, panel in enumerate(panels)]
    write_step(path, shapes, title=f"{title} skins", schema=schema)


def colour(place: int) -> Color:
    """The colour of the panel at that place."""
    return PALETTE[place % len(PALETTE)]
