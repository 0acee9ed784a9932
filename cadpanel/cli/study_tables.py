"""A study as a table."""

from __future__ import annotations

from itertools import groupby

from rich.table import Table
from rich.text import Text

from cadpanel.cli.tables import console, counted, length
from cadpanel.delivery.records.report import SummaryModel
from cadpanel.delivery.records.study import StudyModel

HEADINGS = ("gap allowed", "held", "RMS deviation", "largest deviation", "largest gap", "corner drift", "kink, degrees")


def print_study(study: StudyModel) -> None:
    """A table for each feature and number of panels, and why one was refused."""
    out = console()
    out.print(Text(f"{study.reference.file}: what a gap costs, mm"))
    for (panels, feature), group in groupby(study.rows, key=lambda row: (row.panels, row.feature)):
        rows = list(group)
        title = f"{feature}, {counted(panels, 'panel')}"
        if rows[0].refused is not None:
            out.print(Text(f"{title}: {rows[0].refused}"), soft_wrap=True)
            continue
        table = Table(title=title, title_justify="left", title_style="bold")
        for heading in HEADINGS:
            table.add_column(heading, justify="right")
        table.add_column("")
        for row in rows:
            if row.summary is not None:
                table.add_row(f"{row.gap_tolerance:g}", *_measured(row.summary), "knee" if row.knee else "")
        out.print(table)


def _measured(found: SummaryModel) -> list[Text]:
    held = Text("yes") if found.tolerance_met else Text("no", style="bold red")
    lengths = (
        found.rms_deviation,
        found.max_deviation,
        max(found.max_corner_gap, found.max_seam_gap),
        found.max_corner_drift,
    )
    return [held, *(Text(length(value)) for value in lengths), Text(f"{found.max_kink:.2f}")]
