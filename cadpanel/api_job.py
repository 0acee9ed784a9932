"""What a Python program calls to make a whole building: every region of a job file, as `cadpanel run` makes them."""

from __future__ import annotations

import os
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path

from cadpanel.delivery.source_date import VARIABLE, source_date
from cadpanel.errors import SettingsError
from cadpanel.jobs.engine.cluster import Cluster
from cadpanel.jobs.engine.engine import Engine, TellOf
from cadpanel.jobs.engine.serial import Serial
from cadpanel.jobs.read import read_job
from cadpanel.jobs.region import Job
from cadpanel.jobs.run import Place, make_regions
from cadpanel.jobs.summary import RowModel, SummaryModel
from cadpanel.jobs.task import parts_of
from cadpanel.kinds import checked

__all__ = ["RowModel", "SummaryModel", "run_job"]


@checked
def run_job(
    job: str | Path,
    out: str | Path | None = None,
    *,
    workers: int | None = None,
    scheduler: str | None = None,
    cache: str | Path | None = None,
    overwrite: bool = False,
    fresh: bool = False,
    tell: Callable[[RowModel], None] | None = None,
) -> SummaryModel:
    """Make every region of a job, each by itself: a delivery in a folder of its own, and a summary of all.

    A region that is refused or fails ends nothing: its row in the summary says why. What is done when this is
    interrupted is not done again.

    Args:
        job: TOML file with the regions; `cadpanel init` writes one.
        out: folder for the deliveries; `out` of the job if not given.
        workers: so many regions at once on this machine; needs the extra 'cluster'. A script calls it below
            `if __name__ == "__main__":`, as every worker reads the script again.
        scheduler: address of a Dask scheduler whose workers do it, "tcp://HOST:PORT".
        cache: folder of earlier results; that of this system for such files if not given.
        overwrite: replace deliveries of regions that have changed since, and go on where a job of other regions was.
        fresh: make all regions anew, whatever was made before.
        tell: called with the row of a region as soon as it is done.

    Returns:
        What summary.json holds: `code` as the exit code of `cadpanel run`, `rows` in the order of the job.

    Raises:
        SettingsError: the job is refused as a whole, or nobody is there to work at it.
        DeliveryError: the folder is no job's, holds another delivery that may not be replaced, or another run is at it.
    """
    place = Place(
        out=target_of(asked := read_job(Path(job)), out),
        overwrite=overwrite,
        fresh=fresh,
        tell=tell or (lambda _: None),
    )
    return run_regions(asked, place, workers=workers, scheduler=scheduler, cache=cache)


def run_regions(
    asked: Job,
    place: Place,
    *,
    workers: int | None = None,
    scheduler: str | None = None,
    cache: str | Path | None = None,
    tell_steps: TellOf = lambda *_: None,
) -> SummaryModel:
    """The same for a job that was read, told of every step of every region.

    Raises:
        SettingsError: workers and a scheduler are asked for at once, or results cannot be kept.
        DeliveryError: the folder is refused.
    """
    if workers is not None and scheduler is not None:
        raise SettingsError("workers start here, and a scheduler has its own: give one of the two")
    if workers is not None and workers < 1:
        raise SettingsError(f"at least 1 worker does the work, not {workers}")
    from cadpanel.jobs.results import Results, usual_folder  # dear at every start, and for jobs alone

    source_date()  # refused before anything else is done
    parts = parts_of(asked.regions, os.environ.get(VARIABLE))
    with ExitStack() as opened:
        results = opened.enter_context(Results(usual_folder() if cache is None else Path(cache)))
        return make_regions(parts, place, _engine(opened, workers, scheduler), results, tell_steps)


def target_of(asked: Job, out: str | Path | None) -> Path:
    """The folder that is asked for.

    Raises:
        SettingsError: there is none.
    """
    target = asked.out if out is None else Path(out)
    if target is None:
        raise SettingsError("the job names no folder to write into: give one (--out), or 'out = \"...\"' in the job")
    return target


def _engine(opened: ExitStack, workers: int | None, scheduler: str | None) -> Callable[[], Engine]:
    """What makes regions; workers are started where something is to be made, and end with the run."""
    if workers is None and scheduler is None:
        return Serial
    cluster = Cluster(workers=workers, scheduler=scheduler)
    return lambda: opened.enter_context(cluster)
