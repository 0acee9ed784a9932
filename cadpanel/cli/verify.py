"""The command `cadpanel verify`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from cadpanel.brep.isolation.client import start_reader
from cadpanel.cli import options
from cadpanel.cli.printable import complain
from cadpanel.cli.steps import steps


def verify(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="A folder that 'cadpanel fit' wrote.")],
    reference: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="What the panels approximate: deviation and drift are proved as well."),
    ] = None,
    quiet: options.Quiet = False,
) -> None:
    """Read a delivery's files again and hold them against its report: every face, edge and vertex, names, gaps, flats.

    What needs the reference, deviation, drift and the turn of seams, is proved with --reference, and else listed.

    Exit codes: 0 all holds; 1 something does not, and it says what; 2 a file is missing or cannot be read.
    """
    with steps(quiet=quiet) as shown:
        shown.begin("Read back and verify", folder.name)
        start_reader()
        # Here, not above: help should not wait for them.
        from cadpanel.cli.tables import console, print_certificate
        from cadpanel.delivery.verify import verify as verify_delivery

        found = verify_delivery(folder, reference)
    if not quiet:
        print_certificate(found.certificate, str(folder))
        if not found.report.summary.tolerance_met:
            console().print("Note: the report says that its tolerance is not met.")
    if not found.holds:
        complain("\n".join(("The proof does not hold:", *found.failures, "")))
        raise typer.Exit(1)
    if not quiet:
        console().print("Everything holds.")
        console().print(f"Not proved: {', '.join(found.unproved)}.")
