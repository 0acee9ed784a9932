"""A job from regions to a folder of deliveries: what is there stays, what was made before is taken, the rest made."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from cadpanel.delivery.folder import delivery_folder, refuse_if_taken
from cadpanel.delivery.hung import Hung, hung_by
from cadpanel.delivery.manifest import changed_files
from cadpanel.delivery.own_files import JOB, LITTER, REPORT
from cadpanel.delivery.records.report import read_report
from cadpanel.delivery.records.stock import stock_shortfall
from cadpanel.errors import DeliveryError
from cadpanel.jobs.archive import unpacked
from cadpanel.jobs.building import BUILDING, put_together
from cadpanel.jobs.engine.engine import Engine, TellOf
from cadpanel.jobs.region import Region
from cadpanel.jobs.resolved import is_a_job, job_text
from cadpanel.jobs.summary import STOPPED, RowModel, State, SummaryModel, row_of, write_summary
from cadpanel.jobs.task import Task
from cadpanel.jobs.work import MET, MISSED, Made

if TYPE_CHECKING:
    from cadpanel.jobs.results import Results

Part = tuple[Region, Task]
TellRow = Callable[[RowModel], None]
"""Told what came of a region, as soon as that is known."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Place:
    """Where deliveries go.

    Attributes:
        out: the folder, in which each region has one of its own.
        overwrite: whether deliveries that stand there and are others may be replaced.
        fresh: whether those that stand there are made again though they are the same.
        tell: told of every region that is done.
    """

    out: Path
    overwrite: bool = False
    fresh: bool = False
    tell: TellRow = field(default=lambda _: None)


def make_regions(
    parts: Sequence[Part], place: Place, engine: Callable[[], Engine], results: Results | None, tell: TellOf
) -> SummaryModel:
    """Make every region that is not there yet.

    Whatever ends this, what is done is in its place, and the summary says what is not.

    Args:
        parts: the regions with their tasks.
        place: where they go.
        engine: by which they are made; it is asked for only where something is to be made.
        results: what was made before; None where that does not count, and nothing is kept.
        tell: told of the steps of all regions.

    Raises:
        DeliveryError: the folder is refused, or a delivery in it that may not be replaced.
        SettingsError: results cannot be kept.
    """
    there = refuse_or_find(parts, place)
    _write_job(parts, place.out)
    run = _Run(place, results, {region.name: RowModel(region=region.name, state="waiting") for region, _ in parts})
    try:
        for region, _ in parts:
            if region.name in there:
                run.stands(region)
        missing = [part for part in parts if part[0].name not in there and not run.taken(*part)]
        tasks = list({task.key: task for _, task in reversed(missing)}.values())[::-1]  # of the same the first counts
        for made in engine().run(tasks, tell) if tasks else ():
            run.came(made, [part for part in missing if part[1].key == made.key])
    finally:
        summary = run.summary()
        written, said = put_together(place.out, run.hung())
        summary = summary.model_copy(update={"assembly": BUILDING if written else None, "unassembled": said})
        write_summary(summary, place.out)
    return summary


class _Run:
    """What is known of every region so far."""

    def __init__(self, place: Place, results: Results | None, rows: dict[str, RowModel]) -> None:
        self._place, self._results, self._rows = place, results, rows
        self._codes, self._hung = dict[str, int](), dict[str, Hung]()

    def stands(self, region: Region) -> None:
        """A region's delivery is in its place already."""
        report = read_report(self._place.out / region.name / REPORT)
        self._hung[region.name] = hung_by(report)
        said = None if report.summary.tolerance_met else "not everything holds that is asked: see its report"
        said = said or stock_shortfall(report)
        self._tell(row_of(region.name, report, "there", said, 0), MET if said is None else MISSED)

    def taken(self, region: Region, task: Task) -> bool:
        """Whether a region's delivery was made before, and is in its place now."""
        archive = None if self._results is None or self._place.fresh else self._results.get(task.key)
        if archive is None:
            return False
        self._put(region, task, archive, "kept", 0)
        return True

    def came(self, made: Made, parts: Sequence[Part]) -> None:
        """Something came of a task, which is that of one region, or of several that are the same."""
        if made.archive is not None and self._results is not None:
            self._results.put(made.key, made.archive)
        for region, task in parts:
            if made.archive is not None:
                self._put(region, task, made.archive, "made", made.tries)
            else:
                row = RowModel(region=region.name, state="none", tries=made.tries, said=made.said, details=made.details)
                self._tell(row, made.code)

    def summary(self) -> SummaryModel:
        """Of all regions."""
        rows = tuple(self._rows.values())
        stopped = any(row.state == "waiting" for row in rows)
        return SummaryModel(code=STOPPED if stopped else max(self._codes.values(), default=MET), rows=rows)

    def hung(self) -> dict[str, Hung]:
        """Of all deliveries that are in their places, in the order of the job, how they hang in an assembly."""
        return {name: self._hung[name] for name in self._rows if name in self._hung}

    def _put(self, region: Region, task: Task, archive: bytes, state: State, tries: int) -> None:
        target = self._place.out / region.name
        overwrite = self._place.overwrite
        with delivery_folder(target, overwrite=overwrite) as folder:
            said = unpacked(archive, folder)
            report = read_report(folder / REPORT)
            (folder / JOB).write_text(job_text([(region, task)], target), encoding="utf-8")
        self._hung[region.name] = hung_by(report)
        self._tell(row_of(region.name, report, state, said, tries), MET if said is None else MISSED)

    def _tell(self, row: RowModel, code: int) -> None:
        self._rows[row.region], self._codes[row.region] = row, code
        self._place.tell(row)


def refuse_or_find(parts: Sequence[Part], place: Place) -> frozenset[str]:
    """The regions whose deliveries stand in their places as they would be made again.

    Raises:
        DeliveryError: the folder is no job's, or another delivery stands in a place and may not be replaced.
    """
    out = place.out
    try:
        names = {entry.name for entry in out.iterdir()} - LITTER if os.path.lexists(out) else set()
        if names and not (JOB in names and is_a_job(out / JOB)):
            raise DeliveryError(f"'{out}' holds files but no {JOB} that cadpanel wrote: name another folder.")
        found = set()
        for region, task in parts:
            target = out / region.name
            if not place.fresh and _stands(region, task, target):
                found.add(region.name)
            else:
                refuse_if_taken(target, target, overwrite=place.overwrite)
    except DeliveryError:
        raise
    except OSError as error:
        raise DeliveryError(f"'{out}' cannot be read: {error.strerror or error}.") from error
    return frozenset(found)


def _stands(region: Region, task: Task, target: Path) -> bool:
    """Whether the delivery in a folder is of the same task, and as it was written."""
    job = target / JOB
    if not job.is_file() or job.read_text(encoding="utf-8", errors="replace") != job_text([(region, task)], target):
        return False
    try:
        return not changed_files(target)
    except DeliveryError:  # without a manifest nobody can tell
        return False


def _write_job(parts: Sequence[Part], out: Path) -> None:
    """The whole job beside its deliveries, in one step."""
    work = out / f".{JOB}.{os.getpid()}"
    try:
        out.mkdir(parents=True, exist_ok=True)
        work.write_text(job_text(parts, out), encoding="utf-8")
        work.replace(out / JOB)
    except OSError as error:
        work.unlink(missing_ok=True)
        raise DeliveryError(f"'{out}' cannot be written: {error.strerror or error}.") from error
