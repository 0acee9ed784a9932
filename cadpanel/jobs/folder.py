"""The folder of a job: whether it is one, which deliveries in it are as the job asks, and which are of no region."""

from __future__ import annotations

import os
import tomllib
from collections.abc import Collection, Sequence
from pathlib import Path

from cadpanel.delivery.folder import refuse_if_taken
from cadpanel.delivery.manifest import changed_files
from cadpanel.delivery.own_files import JOB, LITTER, MARKS_OF_A_DELIVERY, REPORT
from cadpanel.delivery.whole_file import is_left_of, write_whole
from cadpanel.errors import DeliveryError
from cadpanel.jobs.building import BUILDING, listed
from cadpanel.jobs.lock import LOCK
from cadpanel.jobs.region import Region
from cadpanel.jobs.resolved import is_a_job, job_text
from cadpanel.jobs.summary import SUMMARY, SUMMARY_TABLE
from cadpanel.jobs.task import Task

_WRITTEN = frozenset({JOB, BUILDING, SUMMARY, SUMMARY_TABLE})


def refuse_no_folder_of_a_job(out: Path) -> None:
    """Refuse a folder of something else.

    Raises:
        DeliveryError: it is a delivery, or holds files and is no job's, or cannot be read.
    """
    try:
        names = {entry.name for entry in out.iterdir()} - LITTER if os.path.lexists(out) else set()
        names = {name for name in names if name != LOCK and not is_left_of(name, _WRITTEN)}
        if names & set(MARKS_OF_A_DELIVERY):
            raise DeliveryError(f"'{out}' is a delivery, and regions do not go into one: name another folder.")
        if names and not (JOB in names and is_a_job(out / JOB)):
            raise DeliveryError(f"'{out}' holds files but no {JOB} that cadpanel wrote: name another folder.")
    except DeliveryError:
        raise
    except OSError as error:
        raise DeliveryError(f"'{out}' cannot be read: {error.strerror or error}.") from error


def refuse_or_find(parts: Sequence[tuple[Region, Task]], out: Path, *, overwrite: bool, fresh: bool) -> frozenset[str]:
    """The regions whose deliveries stand in their places as they would be made again, and are not to be.

    Args:
        parts: the regions with their tasks.
        out: the folder.
        overwrite: whether other deliveries that stand in their places may be replaced, and a job of other regions.
        fresh: whether all are to be made again.

    Raises:
        DeliveryError: another delivery stands in a place, or the folder is of a job with other regions, and may not be
            replaced.
    """
    try:
        names = {region.name for region, _ in parts}
        lacking = [] if overwrite else [name for name in regions_of(out / JOB) if name not in names]
        if lost := [name for name in lacking if is_delivered(out / name)]:
            raise DeliveryError(
                f"'{out}' holds deliveries of regions that this job lacks ({listed(lost)}): name another folder, or go "
                "on here with --overwrite, which leaves them where they are."
            )
        found = set()
        for region, task in parts:
            target = out / region.name
            if not fresh and stands(region, task, target):
                found.add(region.name)
            else:
                refuse_if_taken(target, target, overwrite=overwrite)
    except DeliveryError:
        raise
    except OSError as error:
        raise DeliveryError(f"'{out}' cannot be read: {error.strerror or error}.") from error
    return frozenset(found)


def stands(region: Region, task: Task, target: Path) -> bool:
    """Whether the delivery in a folder is of the same task, and as it was written.

    Raises:
        OSError: a file cannot be read.
    """
    job = target / JOB
    if not job.is_file() or job.read_text(encoding="utf-8", errors="replace") != job_text([(region, task)], target):
        return False
    try:
        return not changed_files(target)
    except DeliveryError:  # without a manifest nobody can tell
        return False


def begin_folder(parts: Sequence[tuple[Region, Task]], out: Path) -> None:
    """Clear what killed runs have left there, and write down the whole job beside its deliveries.

    Raises:
        DeliveryError: it cannot be written.
    """
    try:
        for entry in out.iterdir():
            if is_left_of(entry.name, _WRITTEN) and entry.is_file():
                entry.unlink()
        write_whole(out / JOB, job_text(parts, out).encode())
    except OSError as error:
        raise DeliveryError(f"'{out}' cannot be written: {error.strerror or error}.") from error


def told_of_others(out: Path, names: Collection[str], outdated: Sequence[str]) -> tuple[str, ...]:
    """What is said of deliveries in the folder that are not what the job asks for.

    Args:
        out: the folder.
        names: of the job's regions.
        outdated: those of them whose deliveries an earlier run made, and which were not made again.

    Raises:
        OSError: the folder cannot be read.
    """
    said = []
    if outdated:
        said.append(f"Still there as an earlier run delivered it, not as this job asks: {listed(outdated)}.")
    strange = sorted(entry.name for entry in out.iterdir() if entry.name not in names and is_delivered(entry))
    if strange:
        said.append(
            f"Delivered in '{out}' by an earlier job and no region of this one: {listed(strange)}; delete what is not "
            "wanted any more."
        )
    return tuple(said)


def is_delivered(folder: Path) -> bool:
    """Whether a folder holds a delivery, of whichever job."""
    return not folder.name.startswith(".") and (folder / REPORT).is_file()


def regions_of(job: Path) -> list[str]:
    """The names of the regions in a job that was written here; none where there is no job.

    Raises:
        DeliveryError: somebody has changed it so that it cannot be read.
        OSError: it cannot be read at all.
    """
    if not job.is_file():
        return []
    try:
        return list(tomllib.loads(job.read_text(encoding="utf-8"))["regions"])
    except (ValueError, KeyError, TypeError) as error:
        raise DeliveryError(
            f"'{job}' was changed since cadpanel wrote it, and is no job any more ({error}): run the job into "
            "another folder, or with --overwrite."
        ) from error
