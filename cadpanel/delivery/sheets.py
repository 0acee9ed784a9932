"""From fitted panels to exact solids and skins, with what the report says of each. Nothing is written here."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from cadpanel.brep.building.sheet import build_panel
from cadpanel.brep.kernel.types import Shell, Solid
from cadpanel.delivery.settings import SheetSettings
from cadpanel.geometry.panel import Panel
from cadpanel.geometry.volume import sheet_volume

# What is going on, how much of it is done, and of how much.
Progress = Callable[[str, int, int], None]


@dataclass(frozen=True, slots=True, kw_only=True)
class PanelSheet:
    """A panel's sheet as an exact solid, and the formula's numbers to hold it against.

    Attributes:
        shape: the panel as it is built: a cone that is all but a cylinder has become one.
        solid: the sheet.
        skin: the open shell that approximates the reference.
        area: of the skin, mm^2.
        volume: of the sheet, mm^3.
        moved: how far the farthest corner lies from where the fit had it, mm.
        notes: what the fabricator should know, one sentence each.
    """

    shape: Panel
    solid: Solid
    skin: Shell
    area: float
    volume: float
    moved: float
    notes: tuple[str, ...]


def build_panels(
    shapes: Sequence[Panel], sheet: SheetSettings, progress: Progress | None = None
) -> tuple[PanelSheet, ...]:
    """Build the sheet and the skin of every panel.

    Raises:
        PanelError: a panel cannot be built; the message names it, the reason and the remedy.
    """
    tell = progress or say_nothing
    built: list[PanelSheet] = []
    tell("build", 0, len(shapes))
    for shape in shapes:
        built.append(_build(shape, sheet))
        tell("build", len(built), len(shapes))
    return tuple(built)


def say_nothing(_step: str, _done: int, _of: int) -> None:
    """The progress of those who did not ask for it."""


def _build(shape: Panel, sheet: SheetSettings) -> PanelSheet:
    built = build_panel(shape, sheet.thickness, sheet.skin_side)
    straight = built.straightened
    notes = tuple(
        f"The cone of patch {index + 1} is so slender that it is built as a cylinder; "
        f"no corner moves by more than {straight.largest_move:.2g} mm."
        for index in straight.patches
    )
    return PanelSheet(
        shape=straight.shape,
        solid=built.solid,
        skin=built.skin,
        area=straight.shape.area(),
        volume=sheet_volume(straight.shape, sheet.thickness, sheet.skin_side),
        moved=straight.largest_move,
        notes=notes,
    )
