"""The difference of two deliveries as a table."""

from __future__ import annotations

from collections import Counter

from rich.table import Table
from rich.text import Text

from cadpanel.cli.tables import console, counted, length
from cadpanel.delivery.records.difference import DifferenceModel, PanelDifference

HEADINGS = (
    "corners moved",
    "contour",
    "bend lines",
    "holes",
    "inner radius",
    "sweep, degrees",
    "cut again",
    "bend again",
)


def print_difference(found: DifferenceModel) -> None:
    """One row for every panel that is not the same, and how many there are of each kind."""
    out = console()
    for what, (before, now) in found.sheet.items():
        out.print(Text(f"{what}: {before or 'not named'} before, {now or 'not named'} now"), soft_wrap=True)
    if found.same:
        out.print(Text(f"Nothing differs by more than {found.tolerance:g} mm: {counted(len(found.panels), 'panel')}."))
        return
    table = Table(title=f"{found.before} and {found.now}, mm", title_justify="left", title_style="bold")
    table.add_column("panel")
    table.add_column("")
    for heading in HEADINGS:
        table.add_column(heading, justify="right")
    for panel in found.panels:
        if panel.status != "same":
            table.add_row(*_cells(panel))
    if table.row_count:
        out.print(table)
    counts = Counter(panel.status for panel in found.panels)
    out.print(Text(", ".join(f"{count} {status}" for status, count in counts.items()) + "."), soft_wrap=True)
    again = [panel.name for panel in found.panels if panel.cut_again]
    out.print(Text(f"Blanks to cut again: {', '.join(again) or 'none'}."), soft_wrap=True)


def _cells(panel: PanelDifference) -> list[Text]:
    renamed = panel.before is not None and panel.before != panel.name
    sizes = [panel.moved, panel.contour, panel.bend_lines, panel.holes, panel.radius]
    told = ["" if size is None else length(size) for size in sizes]
    told.append("" if panel.sweep is None else f"{panel.sweep:.2f}")
    return [
        Text(f"{panel.name} (was {panel.before})" if renamed else panel.name),
        Text(panel.status),
        *map(Text, told),
        *(Text("yes" if again else "", style="bold") for again in (panel.cut_again, panel.bend_again)),
    ]
