"""The command `cadpanel run`."""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from typing import Annotated

import typer

from cadpanel.cli import options
from cadpanel.cli.groups import OUTPUT, RUN
from cadpanel.cli.region_lines import region_lines
from cadpanel.delivery.source_date import VARIABLE, source_date
from cadpanel.errors import SettingsError
from cadpanel.jobs.engine.cluster import Cluster
from cadpanel.jobs.engine.engine import Engine
from cadpanel.jobs.engine.serial import Serial
from cadpanel.jobs.read import read_job
from cadpanel.jobs.run import Place, run_job
from cadpanel.jobs.task import task_of

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
    typer.Option("--overwrite", help="Replace deliveries of regions that have changed since.", rich_help_panel=OUTPUT),
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
    bool, typer.Option("--fresh", help="Make all regions anew, whatever was made before.", rich_help_panel=RUN)
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
    refused; 3 a region failed as nobody foresaw, and the summary says where.
    """
    began = time.perf_counter()
    if workers is not None and scheduler is not None:
        raise SettingsError("--workers start here, and --scheduler has its own: give one of the two")
    asked = read_job(job)
    target = out or asked.out
    if target is None:
        raise SettingsError(f"'{job}' names no folder to write into: give --out, or 'out = \"...\"' in the job")
    source_date()  # refused before anything else is done
    parts = [(region, task_of(region, os.environ.get(VARIABLE))) for region in asked.regions]
    with ExitStack() as opened, region_lines(len(parts), quiet=quiet, told=tell_steps) as shown:
        from cadpanel.jobs.results import Results, usual_folder  # dear at every start, and for jobs alone

        results = opened.enter_context(Results(cache or usual_folder()))
        place = Place(out=target, overwrite=overwrite, fresh=fresh, tell=shown.done)
        summary = run_job(parts, place, _engine(opened, workers, scheduler), results, shown.tell)
    if not quiet:
        from cadpanel.cli.summary_table import print_summary

        print_summary(summary, target, time.perf_counter() - began)
    if summary.code:
        raise typer.Exit(summary.code)


def _engine(opened: ExitStack, workers: int | None, scheduler: str | None) -> Callable[[], Engine]:
    """What makes regions; workers are started where something is to be made, and end with the run."""
    if workers is None and scheduler is None:
        return Serial
    cluster = Cluster(workers=workers, scheduler=scheduler)
    return lambda: opened.enter_context(cluster)
