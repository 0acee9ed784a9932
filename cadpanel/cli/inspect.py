"""The command `cadpanel inspect`."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import typer

from cadpanel.brep.files.text_check import require_files
from cadpanel.brep.isolation.client import start_reader
from cadpanel.cli import options
from cadpanel.cli.steps import steps
from cadpanel.reference.settings import ReferenceSettings


@options.made_of_settings
def inspect(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="STEP, IGES, .brep or .3dm file.")],
    how: Annotated[ReferenceSettings, options.Only(("unit", "faces", "seam_tolerance"))],
    as_json: Annotated[bool, typer.Option("--json", help="Print one JSON object instead of tables.")] = False,
) -> None:
    """Measure what a file holds: faces with names, layers and sizes, how they are curved, and the surfaces' lips.

    It says nothing that it did not measure: a dash stands where the file says nothing, or nothing could be measured.

    Exit codes: 0 the file is read; 2 refused.
    """
    require_files(file, how)
    start_reader()
    # Here, not above: neither help nor a refusal should wait for the CAD kernel.
    from cadpanel.brep.survey import survey

    with steps(quiet=False) as shown:
        shown.begin("Read and measure", file.name)
        found = survey(file, how)
    if as_json:
        typer.echo(json.dumps(_finite(asdict(found)), indent=1, ensure_ascii=False))
        return
    from cadpanel.cli.survey_tables import print_survey

    print_survey(found)


def _finite(value: object) -> object:
    """JSON knows no infinity: a radius that is infinite becomes null."""
    if isinstance(value, dict):
        return {key: _finite(inner) for key, inner in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(inner) for inner in value]
    return None if isinstance(value, float) and value == float("inf") else value
