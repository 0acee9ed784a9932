"""What came of a job, as a table."""

from __future__ import annotations

from pathlib import Path

from rich.table import Table
from rich.text import Text

from cadpanel.cli.tables import console, counted
from cadpanel.jobs.summary import RowModel, SummaryModel

_NOTHING = "-"


def print_summary(summary: SummaryModel, out: Path, seconds: float) -> None:
    """A row a region, what is wrong with some, and where all of it is."""
    table = Table(title="Regions", title_justify="left", title_style="bold")
    table.add_column("region", overflow="fold")
    for heading in ("panels", "RMS\ndeviation, mm", "largest\ndeviation, mm", "largest\ngap, mm", "largest\nstep, mm"):
        table.add_column(heading, justify="right")
    for heading in ("held", "state"):
        table.add_column(heading)
    for row in summary.rows:
        numbers = (row.rms_deviation, row.max_deviation, row.max_seam_gap, row.max_step)
        table.add_row(
            Text(row.region),
            _NOTHING if row.panels is None else str(row.panels),
            *(_NOTHING if number is None else f"{number:.2f}" for number in numbers),
            _NOTHING if row.met is None else "yes" if row.met else "no",
            row.state,
        )
    shown = console()
    shown.print(table)
    for row in summary.rows:
        if row.said:
            shown.print(Text(f"{row.region}: {row.said}"), soft_wrap=True)
    if summary.unassembled:
        begin = f"Not all regions hang in {summary.assembly}" if summary.assembly else "No assembly of all regions"
        shown.print(Text(f"{begin}: {summary.unassembled}"), soft_wrap=True)
    for remark in summary.remarks:
        shown.print(Text(remark), soft_wrap=True)
    shown.print(Text(_end(summary.rows, out, seconds)), soft_wrap=True)


def _end(rows: tuple[RowModel, ...], out: Path, seconds: float) -> str:
    done = [row for row in rows if row.panels is not None]
    panels = sum(row.panels or 0 for row in done)
    made = sum(row.state == "made" for row in rows)
    return (
        f"Written: {out}, {counted(len(done), 'region')} of {len(rows)} with {counted(panels, 'panel')}, "
        f"{made} made now, in {seconds:.1f} s."
    )
