"""A job from regions to a folder of deliveries: what is there stays, what was made before is taken, the rest made."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from cadpanel.delivery.folder import delivery_folder
from cadpanel.delivery.hung import Hung, hung_by
from cadpanel.delivery.own_files import JOB, REPORT
from cadpanel.delivery.records.report import read_report
from cadpanel.delivery.records.stock import stock_shortfall
from cadpanel.errors import CadpanelError, DeliveryError, SettingsError
from cadpanel.jobs.archive import unpacked
from cadpanel.jobs.building import BUILDING, put_together
from cadpanel.jobs.engine.engine import Engine, TellOf
from cadpanel.jobs.folder import (
    begin_folder,
    is_delivered,
    refuse_no_folder_of_a_job,
    refuse_or_find,
    stands,
    told_of_others,
)
from cadpanel.jobs.lock import alone
from cadpanel.jobs.region import Region
from cadpanel.jobs.resolved import job_text
from cadpanel.jobs.summary import STOPPED, RowModel, State, SummaryModel, row_of, write_summary
from cadpanel.jobs.task import Task
from cadpanel.jobs.work import MET, MISSED, REFUSED, Made

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
        DeliveryError: the folder is refused, or a delivery in it that may not be replaced, or another run is at it.
    """
    refuse_no_folder_of_a_job(place.out)
    with alone(place.out):
        there = refuse_or_find(parts, place.out, overwrite=place.overwrite, fresh=place.fresh)
        begin_folder(parts, place.out)
        run = _Run(parts, place, results)
        write_summary(run.summary(), place.out)  # that of an earlier run is of other deliveries, if this one is killed
        try:
            run.make(there, engine, tell)
        except BaseException:
            # What has stopped it says more than what may follow from that, as a kernel that was not loaded to its end.
            with suppress(CadpanelError, OSError, ImportError):
                run.end()
            raise
        return run.end()


class _Run:
    """What is known of every region so far."""

    def __init__(self, parts: Sequence[Part], place: Place, results: Results | None) -> None:
        self._parts, self._place, self._results = parts, place, results
        self._rows = {region.name: RowModel(region=region.name, state="waiting") for region, _ in parts}
        self._codes, self._hung, self._remarks = dict[str, int](), dict[str, Hung](), list[str]()

    def make(self, there: frozenset[str], engine: Callable[[], Engine], tell: TellOf) -> None:
        """Make what is not there, and was not made before.

        Args:
            there: the regions whose deliveries stand in their places.
            engine: by which others are made; it is asked for only where something is to be made.
            tell: told of the steps of all regions.
        """
        for region, _ in self._parts:
            if region.name in there:
                self._stands(region)
        missing = [part for part in self._parts if part[0].name not in there and not self._taken(*part)]
        tasks = list({task.key: task for _, task in reversed(missing)}.values())[::-1]  # of the same the first counts
        for made in engine().run(tasks, tell) if tasks else ():
            self._came(made, [part for part in missing if part[1].key == made.key])

    def summary(self) -> SummaryModel:
        """Of all regions."""
        rows = tuple(self._rows.values())
        stopped = any(row.state == "waiting" for row in rows)
        return SummaryModel(
            code=STOPPED if stopped else max(self._codes.values(), default=MET),
            rows=rows,
            remarks=tuple(self._remarks),
        )

    def end(self) -> SummaryModel:
        """Put the deliveries together that are in their places, and write the summary, whatever comes of the former."""
        out, written, said = self._place.out, False, None
        try:
            written, said = put_together(out, self._in_place())
            self._remarks += told_of_others(out, self._rows, self._outdated())
        finally:
            assembly = BUILDING if written else None
            summary = self.summary().model_copy(update={"assembly": assembly, "unassembled": said})
            write_summary(summary, out)
        return summary

    def _in_place(self) -> list[tuple[Region, Hung]]:
        """All deliveries that are in their places, in the order of the job, with how they hang in an assembly.

        Where all were to be made anew and some were not, that are those of before.
        """
        hanging = []
        for region, task in self._parts:
            target = self._place.out / region.name
            hung = self._hung.get(region.name)
            if hung is None and self._is_there(region, task):
                hung = hung_by(read_report(target / REPORT))
            if hung is not None:
                hanging.append((region, hung))
        return hanging

    def _outdated(self) -> list[str]:
        """The regions in whose places other deliveries are than the job asks for."""
        missed = [(region, task) for region, task in self._parts if region.name not in self._hung]
        return [
            region.name
            for region, task in missed
            if is_delivered(self._place.out / region.name) and not self._is_there(region, task)
        ]

    def _is_there(self, region: Region, task: Task) -> bool:
        """Whether what the job asks for is in its place; what cannot be read is not known to be that."""
        try:
            return stands(region, task, self._place.out / region.name)
        except OSError:
            return False

    def _stands(self, region: Region) -> None:
        """A region's delivery is in its place already."""
        report = read_report(self._place.out / region.name / REPORT)
        self._hung[region.name] = hung_by(report)
        said = None if report.summary.tolerance_met else "not everything holds that is asked: see its report"
        said = said or stock_shortfall(report)
        self._tell(row_of(region.name, report, "there", said, 0), MET if said is None else MISSED)

    def _taken(self, region: Region, task: Task) -> bool:
        """Whether a region's delivery was made before, and was put in its place now, or cannot be."""
        if self._results is None or self._place.fresh:
            return False
        try:
            archive = self._results.get(task.key)
        except SettingsError as error:
            self._go_on_without_results(error)
            return False
        if archive is None:
            return False
        self._put(region, task, archive, "kept", 0)
        return True

    def _came(self, made: Made, parts: Sequence[Part]) -> None:
        """Something came of a task, which is that of one region, or of several that are the same."""
        for region, task in parts:
            if made.archive is not None:
                self._put(region, task, made.archive, "made", made.tries)
            else:
                row = RowModel(region=region.name, state="none", tries=made.tries, said=made.said, details=made.details)
                self._tell(row, made.code)
        if made.archive is not None and self._results is not None:  # only now: it may find no room
            try:
                self._results.put(made.key, made.archive)
            except SettingsError as error:
                self._go_on_without_results(error)

    def _go_on_without_results(self, error: SettingsError) -> None:
        self._results = None
        self._remarks.append(f"Nothing more is taken from earlier results or kept for later ones: {error}.")

    def _put(self, region: Region, task: Task, archive: bytes, state: State, tries: int) -> None:
        """Put a delivery in its place; one for which that is not possible ends nothing."""
        target = self._place.out / region.name
        try:
            with delivery_folder(target, overwrite=self._place.overwrite) as folder:
                said = unpacked(archive, folder)
                report = read_report(folder / REPORT)
                (folder / JOB).write_text(job_text([(region, task)], target), encoding="utf-8")
        except OSError as error:  # a DeliveryError, too
            self._not_put(region, task, error, tries)
            return
        self._hung[region.name] = hung_by(report)
        self._tell(row_of(region.name, report, state, said, tries), MET if said is None else MISSED)

    def _not_put(self, region: Region, task: Task, error: OSError, tries: int) -> None:
        """A delivery could not be put in its place, or not all that was to be done then."""
        target = self._place.out / region.name
        said = str(error) if isinstance(error, DeliveryError) else f"'{target}' cannot be written: {error}."
        # Another has put the same there, or what stood there before could not be deleted.
        if self._is_there(region, task):
            self._remarks += [said] if self._place.overwrite else []
            self._stands(region)
        else:
            self._tell(RowModel(region=region.name, state="none", tries=tries, said=said), REFUSED)

    def _tell(self, row: RowModel, code: int) -> None:
        self._rows[row.region], self._codes[row.region] = row, code
        self._place.tell(row)
