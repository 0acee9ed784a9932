"""The proof of a job's folder: every delivery in it by itself, and the assembly on top of them by their reports."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from io import StringIO
from pathlib import Path, PurePosixPath

from cadpanel.brep.step.hung_files import HungFile, hung_files, is_written_here
from cadpanel.delivery.hung import Hung, hung_by
from cadpanel.delivery.outputs.step_files import PANELS
from cadpanel.delivery.own_files import JOB, MARKS_OF_A_DELIVERY
from cadpanel.delivery.settings import Schema
from cadpanel.delivery.sheets import Progress
from cadpanel.errors import CadpanelError, DeliveryError
from cadpanel.jobs.building import BUILDING
from cadpanel.jobs.folder import is_delivered, regions_of
from cadpanel.jobs.resolved import is_a_job
from cadpanel.jobs.summary import SUMMARY, read_summary


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
        if not is_written_here(path):
            yield f"'{path}' is not as cadpanel wrote it: move it elsewhere, and run the job again."
            return
        files = hung_files(path)
    except OSError as error:
        yield f"'{path}' cannot be read: {error.strerror or error}."
        return
    except DeliveryError as error:
        yield str(error)
        return
    faults = [*_faults_of_parts(out, files, hung), *_not_hung(out, files, hung)]
    yield from faults
    if not faults and _data(path.read_text(encoding="ascii")) != _data(_as_written(files, hung)):
        yield f"'{path}' says otherwise than the deliveries that hang in it: run the job again."


def _faults_of_parts(out: Path, files: Sequence[HungFile], hung: Mapping[str, Hung]) -> Iterator[str]:
    """What is wrong with the parts that it names."""
    for file, times in Counter(files).items():
        name = str(PurePosixPath(file.path).parent)
        if file.path != f"{name}/{PANELS}" or not (out / file.path).is_file():
            yield f"{BUILDING} names '{file.path}', and there is no such file: run the job again."
        elif times > 1:
            yield f"{BUILDING} hangs '{name}' {times} times: run the job again."
        elif name in hung and file.placed != hung[name].placed:
            yield (
                f"{BUILDING} hangs '{name}' at {_told(file.placed)} mm, and its report at {_told(hung[name].placed)} "
                "mm: run the job again."
            )


def _not_hung(out: Path, files: Sequence[HungFile], hung: Mapping[str, Hung]) -> Iterator[str]:
    """The deliveries of the job that do not hang in it, but for those of which the summary says so."""
    named = {file.path for file in files}
    left_out = (read_summary(out / SUMMARY).unassembled or "") if (out / SUMMARY).is_file() else ""
    for name in regions_of(out / JOB):
        path = f"{name}/{PANELS}"
        if name in hung and (out / path).is_file() and path not in named and f"'{name}'" not in left_out:
            yield f"'{name}' does not hang in {BUILDING}: run the job again."


def _as_written(files: Sequence[HungFile], hung: Mapping[str, Hung]) -> str:
    """The assembly of these files as the deliveries' reports have it; of a delivery that cannot be read, as it says."""
    from cadpanel.brep.step.part_files import PartFile, write_assembly_text  # it loads the kernel

    names = [str(PurePosixPath(file.path).parent) for file in files]
    placed = [hung[name].placed if name in hung else file.placed for name, file in zip(names, files, strict=True)]
    parts = [
        PartFile(name=name, path=file.path, placed=place)
        for name, file, place in zip(names, files, placed, strict=True)
    ]
    text = StringIO()
    schema: Schema = next((hung[name].schema for name in names if name in hung), "AP242")
    write_assembly_text(text, parts, Path(BUILDING).stem, schema)
    return text.getvalue()


def _data(text: str) -> str:
    """What stands behind the header, which has a date."""
    return text.partition("\nDATA;\n")[2]


def _told(place: tuple[float, float, float]) -> str:
    return f"({', '.join(f'{part:.12g}' for part in place)})"
