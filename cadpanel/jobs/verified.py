"""The proof of a job's folder: every delivery in it by itself, and the assembly on top of them by their reports."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

from cadpanel.brep.step.hung_files import hung_files
from cadpanel.delivery.hung import Hung, hung_by
from cadpanel.delivery.outputs.step_files import PANELS
from cadpanel.delivery.own_files import JOB, MARKS_OF_A_DELIVERY
from cadpanel.delivery.sheets import Progress
from cadpanel.errors import CadpanelError, DeliveryError
from cadpanel.jobs.building import BUILDING
from cadpanel.jobs.folder import is_delivered, regions_of
from cadpanel.jobs.resolved import is_a_job


@dataclass(frozen=True, slots=True, kw_only=True)
class VerifiedRegion:
    """What the delivery of a region shows.

    Attributes:
        name: of the region.
        panels: how many the delivery has; 0 where it cannot be read.
        failures: one sentence for everything that does not hold.
        refused: why it cannot be read; empty where it can.
        hung: how it hangs in the assembly; None where it cannot be read.
    """

    name: str
    panels: int = 0
    failures: tuple[str, ...] = ()
    refused: str = ""
    hung: Hung | None = None

    @property
    def holds(self) -> bool:
        """Whether the delivery is what its report promises."""
        return not self.refused and not self.failures


def is_folder_of_a_job(folder: Path) -> bool:
    """Whether a folder is that of a job and no delivery, which may hold the job that it was made by.

    Raises:
        OSError: it cannot be read.
    """
    job = folder / JOB
    marked = any((folder / mark).is_file() for mark in MARKS_OF_A_DELIVERY)
    return not marked and job.is_file() and is_a_job(job)


def delivered_regions(out: Path) -> tuple[str, ...]:
    """The names of a job's regions in their order, and of all other deliveries in its folder.

    Raises:
        DeliveryError: the folder, or the job in it, cannot be read.
    """
    try:
        asked = regions_of(out / JOB)
        others = sorted(entry.name for entry in out.iterdir() if entry.name not in asked and is_delivered(entry))
    except DeliveryError:
        raise
    except OSError as error:
        raise DeliveryError(f"'{out}' cannot be read: {error.strerror or error}.") from error
    return (*asked, *others)


def verified_region(folder: Path, progress: Progress) -> VerifiedRegion:
    """Verify the delivery of a region.

    Args:
        folder: of the delivery.
        progress: told the step and how much of it is done of how much.
    """
    from cadpanel.delivery.verify import verify  # it loads the kernel

    if not is_delivered(folder):
        return VerifiedRegion(name=folder.name, refused=f"{JOB} has the region, and it is not delivered: run the job.")
    try:
        found = verify(folder, progress=progress)
    except CadpanelError as error:
        return VerifiedRegion(name=folder.name, refused=str(error))
    return VerifiedRegion(
        name=folder.name, panels=len(found.report.panels), failures=found.failures, hung=hung_by(found.report)
    )


def assembly_faults(out: Path, hung: Mapping[str, Hung]) -> Iterator[str]:
    """One sentence for everything that the assembly on top of deliveries says otherwise than their reports.

    Args:
        out: the folder of the job.
        hung: of the deliveries that can be read, by their names, how they hang.
    """
    path = out / BUILDING
    if not os.path.lexists(path):
        return
    try:
        files = hung_files(path)
    except DeliveryError as error:
        yield str(error)
        return
    for file in files:
        name = str(PurePosixPath(file.path).parent)
        if file.path != f"{name}/{PANELS}" or not (out / file.path).is_file():
            yield f"{BUILDING} names '{file.path}', and there is no such file: run the job again."
        elif name in hung and file.placed != hung[name].placed:
            yield (
                f"{BUILDING} hangs '{name}' at {_told(file.placed)} mm, and its report at {_told(hung[name].placed)} "
                "mm: run the job again."
            )


def _told(place: tuple[float, float, float]) -> str:
    return f"({', '.join(f'{part:.12g}' for part in place)})"
