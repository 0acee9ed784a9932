"""The command `cadpanel init`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer
from rich.text import Text

from cadpanel.brep.files.text_check import require_files
from cadpanel.brep.isolation.client import start_reader
from cadpanel.cli import options
from cadpanel.cli.groups import OUTPUT
from cadpanel.cli.steps import steps
from cadpanel.errors import DeliveryError
from cadpanel.reference.settings import ReferenceSettings


@options.made_of_settings
def init(
    reference: options.ReferenceFile,
    how: Annotated[ReferenceSettings, options.Only(("unit", "faces", "seam_tolerance"))],
    output: Annotated[
        Path,
        typer.Option("--output", "-o", metavar="FILE", help="The job file to write.", rich_help_panel=OUTPUT),
    ] = Path("job.toml"),
    quiet: options.Quiet = False,
) -> None:
    """Write a job file for a reference, with comments: its surfaces, and for each a way to cut it that gives panels.

    The file is measured as 'inspect' does, and ways to cut are tried until one gives panels that can be fitted; change
    it to what you want, and 'cadpanel run' it.

    Exit codes: 0 the job is written; 2 refused, or no way was found.
    """
    if output.exists():
        raise DeliveryError(f"'{output}' exists already: name another file by --output")
    require_files(reference, how)
    with steps(quiet=quiet) as shown:
        shown.begin("Measure and try ways to cut", reference.name)
        start_reader()
        # Here, not above: neither help nor a refusal should wait for the CAD kernel.
        from cadpanel.jobs.begin import begun_job

        text = begun_job(reference, how, output.absolute().parent)
    try:
        output.parent.mkdir(parents=True, exist_ok=True)
        with output.open("x", encoding="utf-8") as file:
            file.write(text)
    except OSError as error:
        raise DeliveryError(f"'{output}' cannot be written: {error.strerror or error}") from error
    if not quiet:
        from cadpanel.cli.tables import console

        console().print(Text(f"Written: {output}. Run it: cadpanel run {output} --out DIR"), soft_wrap=True)
