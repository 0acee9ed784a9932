"""The command `cadpanel diff`."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from cadpanel.cli.steps import steps
from cadpanel.errors import SettingsError

DIFFERENT = 1


def diff(
    before: Annotated[Path, typer.Argument(metavar="BEFORE", help="The folder of the earlier delivery.")],
    now: Annotated[Path, typer.Argument(metavar="NOW", help="The folder of the later one.")],
    tolerance: Annotated[float, typer.Option(metavar="MM", help="Lengths that differ by no more are the same.")] = 0.1,
    as_json: Annotated[bool, typer.Option("--json", help="Print one JSON object instead of a table.")] = False,
    as_csv: Annotated[bool, typer.Option("--csv", help="Print comma-separated rows, one a panel.")] = False,
) -> None:
    """Tell which panels changed between two deliveries, by how much, and which blanks must be cut again.

    Panels are known by their names; of blanks the flat contours count, not where they hang.

    Exit codes: 0 nothing differs; 1 something does; 2 a folder is missing or cannot be read.
    """
    if as_json and as_csv:
        raise SettingsError("one form at a time: --json or --csv")
    # Here, not above: help should not wait for it.
    from cadpanel.delivery.diff import diff as diff_deliveries
    from cadpanel.delivery.schedule.csv_text import csv_bytes
    from cadpanel.delivery.schedule.difference_rows import difference_rows

    with steps(quiet=False) as shown:
        shown.begin("Read and compare", now.name)
        found = diff_deliveries(before, now, tolerance=tolerance)
    if as_json:
        typer.echo(found.model_dump_json(by_alias=True, indent=1))
    elif as_csv:
        sys.stdout.buffer.write(csv_bytes(difference_rows(found)))
        sys.stdout.flush()
    else:
        from cadpanel.cli.diff_table import print_difference

        print_difference(found)
    if not found.same:
        raise typer.Exit(DIFFERENT)
