"""The commands under `cadpanel freecad`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from cadpanel.cli.examples import epilog
from cadpanel.freecad.install import install as install_addon

freecad = typer.Typer(name="freecad", help="The workbench for FreeCAD.", no_args_is_help=True)


@freecad.callback()
def of_freecad() -> None:
    """The workbench for FreeCAD."""


@freecad.command(epilog=epilog("install"))
def install(
    to: Annotated[
        Path | None,
        typer.Option("--to", metavar="DIR", help="FreeCAD's folder of add-ons; what FreeCAD says if left out."),
    ] = None,
) -> None:
    """Put the workbench where FreeCAD finds it: open deliveries, colour, find and check panels, run fits.

    FreeCAD runs this cadpanel in its own Python: install again when that has moved.
    """
    typer.echo(f"The workbench is in {install_addon(to)}: start FreeCAD anew, and choose cadpanel among workbenches.")
