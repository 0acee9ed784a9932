"""The command `cadpanel study`."""

from __future__ import annotations

from contextlib import nullcontext
from functools import partial
from pathlib import Path
from typing import Annotated

import typer
from rich.text import Text

from cadpanel.brep.isolation.client import start_reader
from cadpanel.cli import options
from cadpanel.cli.groups import OUTPUT
from cadpanel.cli.steps import Steps, steps
from cadpanel.cli.time_left import TimeLeft
from cadpanel.delivery.folder import delivery_folder
from cadpanel.delivery.records.study import StudyModel
from cadpanel.delivery.study_files import write_study_files
from cadpanel.fitting.settings import FitSettings
from cadpanel.reference.model import Reference
from cadpanel.reference.settings import ReferenceSettings

_READ = "Read reference"


@options.made_of_settings
def study(
    reference: options.ReferenceFile,
    settings: Annotated[
        tuple[FitSettings, ...],
        options.Without(("weights", "method", "energy", "tau")),
        options.Each({"feature": "--feature", "gap_tolerance": "--gap"}),
    ],
    how: Annotated[tuple[ReferenceSettings, ...], options.Each({"divide": "--divide"})],
    out: Annotated[
        Path | None,
        typer.Option(
            "--out",
            metavar="DIR",
            parser=options.folder_named,
            help="Folder for study.csv, .json, .png and .svg.",
            rich_help_panel=OUTPUT,
        ),
    ] = None,
    overwrite: options.Overwrite = False,
    quiet: options.Quiet = False,
) -> None:
    """Fit every combination of gaps, features and numbers of panels, and tell what each of them costs.

    No row is worse than a fit of its own, nor than what a row with a tighter gap holds already. Nothing is built.

    Exit codes: 0 the study is written; 2 refused.
    """
    with nullcontext() if out is None else delivery_folder(out, overwrite=overwrite) as folder:
        with steps(quiet=quiet) as shown:
            found = _run(reference, how, settings, shown)
        missing = "" if folder is None else write_study_files(found, folder)
    if not quiet:
        from cadpanel.cli.study_tables import print_study
        from cadpanel.cli.tables import console

        print_study(found)
        if out is not None:
            console().print(Text(f"Written: {out}. {missing}".rstrip()), soft_wrap=True)


def _run(file: Path, how: tuple[ReferenceSettings, ...], settings: tuple[FitSettings, ...], shown: Steps) -> StudyModel:
    start_reader()
    # Here, not above: the CAD kernel takes seconds to load, and neither help nor a refusal should wait for it.
    from cadpanel.brep.read import read_reference
    from cadpanel.delivery.earlier import with_earlier
    from cadpanel.delivery.records.study_rows import study_record
    from cadpanel.studies.trade_off import most_fits, trade_off

    def read(one: ReferenceSettings) -> Reference:
        shown.begin(_READ, file.name)
        return read_reference(file, one)

    fits, begun, left = len(how) * most_fits(settings), 0, TimeLeft()

    def tell(point: FitSettings, of: Reference, count: int, excess: float, rms: float) -> None:
        nonlocal begun
        begun += count == 0
        fitted = f"{point.feature_name}, {len(of.panels)} panels, {point.widest_gap:g} mm"
        step = f"Fit {begun} of {fits} at most: {fitted}"
        if count == 0:
            shown.begin(step, left=partial(left.said, begun - 1, fits))
        else:
            shown.solving(step, count, excess, rms)

    return study_record(trade_off([partial(read, one) for one in how], settings, tell, prepare=with_earlier))
