"""The command `cadpanel run`."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Annotated

import typer

from cadpanel.api_job import run_regions, target_of
from cadpanel.cli import options
from cadpanel.cli.groups import OUTPUT, RUN
from cadpanel.cli.printable import complain
from cadpanel.cli.region_lines import region_lines
from cadpanel.jobs.read import read_job
from cadpanel.jobs.run import Place

JobFile = Annotated[
    Path, typer.Argument(metavar="JOB", help="TOML file with the regions of a building; 'cadpanel init' writes one.")
]
JobOut = Annotated[
    Path | None,
    typer.Option(
        "--out",
        metavar="DIR",
        parser=options.folder_named,
        help="Folder for a delivery a region and the summary; 'out' of the job if not given.",
        rich_help_panel=OUTPUT,
    ),
]
Replace = Annotated[
    bool,
    typer.Option(
        "--overwrite",
        help="Replace deliveries of regions that have changed since, and go on where a job of other regions has been.",
        rich_help_panel=OUTPUT,
    ),
]
Workers = Annotated[
    int | None,
    typer.Option(
        "--workers",
        metavar="N",
        min=1,
        help="Work at so many regions at once on this machine; needs the extra 'cluster'.",
        rich_help_panel=RUN,
    ),
]
Scheduler = Annotated[
    str | None,
    typer.Option(
        "--scheduler",
        metavar="ADDRESS",
        help="Let the workers of this Dask scheduler work, tcp://HOST:PORT.",
        rich_help_panel=RUN,
    ),
]
Kept = Annotated[
    Path | None,
    typer.Option(
        "--cache",
        metavar="DIR",
        help="Folder of earlier results; that of this system for such files if not given.",
        rich_help_panel=RUN,
    ),
]
Fresh = Annotated[
    bool,
    typer.Option(
        "--fresh",
        help="Make all regions anew, whatever was made before; with --overwrite where deliveries stand.",
        rich_help_panel=RUN,
    ),
]


def run(
    job: JobFile,
    out: JobOut = None,
    overwrite: Replace = False,
    workers: Workers = None,
    scheduler: Scheduler = None,
    cache: Kept = None,
    fresh: Fresh = False,
    quiet: options.Quiet = False,
    tell_steps: options.TellSteps = False,
) -> None:
    """Make every region of a job, each by itself: a delivery in a folder of its own, and a summary of all.

    The whole job is checked before anything runs. What stands in the folder unchanged stays, what was made before with
    the same content is taken from the cache, and what is done when a run is stopped is not done again.

    Exit codes: 0 all is well; 1 a tolerance, the stock or the proof of a region does not hold; 2 the job or a region is
    refused; 3 a region failed as nobody foresaw, and the summary says where; 130 after Ctrl-C.
    """
    began = time.perf_counter()
    asked = read_job(job)
    target = target_of(asked, out)
    with region_lines(len(asked.regions), quiet=quiet, told=tell_steps) as shown:
        place = Place(out=target, overwrite=overwrite, fresh=fresh, tell=shown.done)
        summary = run_regions(asked, place, workers=workers, scheduler=scheduler, cache=cache, tell_steps=shown.tell)
    if not quiet:
        from cadpanel.cli.summary_table import print_summary

        print_summary(summary, target, time.perf_counter() - began)
    elif not tell_steps:
        for row in summary.rows:
            if row.said:
                complain(f"{row.region}: {row.said}\n")
        for remark in summary.remarks:
            complain(f"{remark}\n")
    if summary.code:
        raise typer.Exit(summary.code)
