"""building.step: one STEP assembly on top of the deliveries of a job, which stay the files that they are."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Sequence
from pathlib import Path

from cadpanel.brep.step.hung_files import is_written_here
from cadpanel.delivery.hung import Hung
from cadpanel.delivery.outputs.step_files import PANELS
from cadpanel.errors import DeliveryError
from cadpanel.jobs.region import Region

BUILDING = "building.step"
_LEAST = 2
"""Deliveries from which there is something to put together."""
_VALUE = re.compile(r"-[^-=]+=")
"""Behind the name of a region, where the values begin that a matrix has chosen for it."""


def put_together(out: Path, regions: Sequence[tuple[Region, Hung]]) -> tuple[bool, str | None]:
    """Write the assembly, or remove an earlier one that tells of regions as they were.

    Args:
        out: the folder of the job.
        regions: those that are delivered, with how they hang; the ones without STEP files are left out.

    Returns:
        Whether it was written, and in sentences what does not hang in it or why there is none; nothing is said where
        there are no two files for it.
    """
    place = out / BUILDING
    hanging, said = _chosen([(region, hung) for region, hung in regions if (out / region.name / PANELS).is_file()])
    try:
        if os.path.lexists(place) and not _is_ours(place):
            left = f"'{place}' is not as cadpanel wrote it and is left alone: move it elsewhere, and run the job again."
            return False, left if len(hanging) >= _LEAST else _sentences(said)
        if len(hanging) >= _LEAST:
            # Only here: it loads the kernel, for which nobody should wait who has nothing to put together.
            from cadpanel.delivery.assemble import assemble_told

            assemble_told({(out / region.name).absolute(): hung for region, hung in hanging}, place.absolute())
            return True, _sentences(said)
    except DeliveryError as error:
        said = [str(error), *said]
        if isinstance(error.__cause__, OSError) and place.is_file():  # of a disk: what was right may be so still
            return False, _sentences([*said, f"'{place}' is of an earlier run."])
    try:
        place.unlink(missing_ok=True)
    except OSError as error:
        said.append(f"'{place}' of an earlier run cannot be deleted: {error.strerror or error}.")
    return False, _sentences(said)


def family(name: str) -> str:
    """The name that a region has in its job file, where a matrix makes several of it."""
    return _VALUE.split(name, maxsplit=1)[0]


def listed(names: Iterable[str]) -> str:
    """Names for a sentence."""
    return ", ".join(f"'{name}'" for name in names)


def _chosen(regions: Sequence[tuple[Region, Hung]]) -> tuple[list[tuple[Region, Hung]], list[str]]:
    """Those that hang, and what is said of the others."""
    first = dict[object, str]()
    hanging, upon, not_found = list[tuple[Region, Hung]](), list[str](), list[str]()
    for region, hung in regions:
        taken = first.setdefault(_place(region), region.name)
        if taken != region.name:
            upon.append(region.name)
        elif not region.name.isascii():
            not_found.append(region.name)
        else:
            hanging.append((region, hung))
    said = []
    if upon:
        said.append(
            f"Variants of a matrix lie in one place, so that only the first of each hangs there, not {listed(upon)}."
        )
    if not_found:
        said.append(
            f"Readers of STEP find no file whose path has other letters than ASCII, so not {listed(not_found)}: "
            "rename what shall hang."
        )
    return hanging, said


def _place(region: Region) -> object:
    """The same for regions of a matrix whose panels lie upon each other: other settings, but the same surface."""
    chosen = region.how.faces, region.shop.only
    return (family(region.name), region.reference, *chosen) if _VALUE.search(region.name) else region.name


def _is_ours(place: Path) -> bool:
    try:
        return is_written_here(place)
    except OSError:
        return False


def _sentences(said: Iterable[str]) -> str | None:
    return " ".join(said) or None
