"""What a file that came back holds of a delivery, as a table."""

from __future__ import annotations

from collections.abc import Sequence

from rich.table import Table
from rich.text import Text

from cadpanel.brep.proof.returned_solids import SolidBack
from cadpanel.cli.tables import console, counted

NAMES, DIFFERENCES = ("panel", "called there"), ("off, mm", "volume", "area")
EXACT = 1e-6
"""mm, and parts of a volume or an area, below which nothing differs that anybody could measure."""


def print_solids_back(solids: Sequence[SolidBack], heading: str) -> None:
    """One row for every solid that has another name or differs, and the largest differences."""
    worst = [max((abs(size) for size in sizes), default=0.0) for sizes in zip(*map(_sizes, solids), strict=True)]
    if worst:
        off, volume, area = worst
        said = f"off by {off:.2g} mm at most, volumes by {volume:.2g} and areas by {area:.2g} of their own"
        console().print(Text(f"{heading}: {counted(len(solids), 'solid')} of the delivery, {said}."), soft_wrap=True)
    telling = [one for one in solids if one.called != one.name or max(map(abs, _sizes(one))) > EXACT]
    if not telling:
        return
    table = Table()
    for name in NAMES:
        table.add_column(name)
    for difference in DIFFERENCES:
        table.add_column(difference, justify="right")
    for one in telling:
        table.add_row(Text(one.name), Text(one.called), *(f"{size:.2g}" for size in _sizes(one)))
    console().print(table)


def _sizes(one: SolidBack) -> tuple[float, float, float]:
    return one.apart, one.volume, one.area
