"""A whole building: one STEP file on top of the deliveries of its regions, which stay the files that they are."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path

from cadpanel.brep.step.file import write_assembly
from cadpanel.brep.step.part_files import PartFile
from cadpanel.brep.step.products import Header
from cadpanel.delivery.hung import Hung, hung_by
from cadpanel.delivery.outputs.step_files import PANELS
from cadpanel.delivery.own_files import OWN_FILES, REPORT
from cadpanel.delivery.records.report import read_report
from cadpanel.delivery.source_date import source_date
from cadpanel.errors import DeliveryError
from cadpanel.kinds import checked

_OF_A_DELIVERY = {name.casefold() for name in OWN_FILES}  # some disks take capitals for small letters


@checked
def assemble(deliveries: Sequence[str | Path], file: str | Path) -> None:
    """Write a STEP assembly in which the panels of several deliveries hang, each delivery where it lies in the model.

    It names their files and holds none of their shapes, so that it is small however many panels there are, and a region
    that is delivered again is seen when the assembly is next opened. Deliveries and assembly are moved together.

    Args:
        deliveries: their folders, in this order; each is called as its folder.
        file: an existing one is replaced.

    Raises:
        DeliveryError: a folder holds no delivery, two are called alike or have different schemas, one has a path that
            readers of STEP do not find again or stands on another drive, the file would take the place of one of a
            delivery, or it cannot be written.
    """
    # One report at a time: of a whole building they take more memory than everything else.
    told = {Path(folder).absolute(): hung_by(read_report(Path(folder) / REPORT)) for folder in deliveries}
    assemble_told(told, Path(file).absolute())


def assemble_told(told: Mapping[Path, Hung], target: Path) -> None:
    """The same where it is known how each delivery hangs.

    Args:
        told: of each folder, absolute.
        target: the file, absolute.

    Raises:
        DeliveryError: see `assemble`.
    """
    _demand_parts(list(told), target)
    schemas = {one.schema for one in told.values()}
    if len(schemas) != 1:
        raise DeliveryError(f"'{target.name}' cannot hold {', '.join(sorted(schemas)) or 'no delivery'}: choose one.")
    parts = [
        PartFile(name=folder.name, path=_way_to(folder, target), placed=one.placed) for folder, one in told.items()
    ]
    write_assembly(target, parts, title=target.stem, schema=schemas.pop(), header=Header(date=source_date()))


def _way_to(folder: Path, target: Path) -> str:
    """The path to a delivery's panels from the folder of the assembly, as readers of STEP want it, with slashes.

    Where it goes up, both ends are resolved: above a folder that is a link lies another one than its name has there.
    """
    if ".." not in folder.parts and folder.is_relative_to(target.parent):
        return (folder.relative_to(target.parent) / PANELS).as_posix()
    try:
        way = os.path.relpath(os.path.realpath(folder), os.path.realpath(target.parent))
    except ValueError as error:
        raise DeliveryError(
            f"'{folder}' stands on another drive than '{target}', and no path in a STEP file leads there: write the "
            "assembly to the drive of the deliveries, or copy them."
        ) from error
    return (Path(way) / PANELS).as_posix()


def _demand_parts(folders: Sequence[Path], target: Path) -> None:
    """Names that tell regions apart, and the files that are to be found and to be left as they are."""
    for name, times in Counter(folder.name for folder in folders).items():
        if times > 1:
            raise DeliveryError(f"{times} deliveries are called '{name}', which '{target.name}' cannot tell apart.")
    for folder in folders:
        if not (folder / PANELS).is_file():
            raise DeliveryError(f"'{folder}' holds no {PANELS} to hang in '{target.name}': deliver that region again.")
        if target.name.casefold() in _OF_A_DELIVERY and target.parent.is_dir() and target.parent.samefile(folder):
            raise DeliveryError(f"'{target}' would take the place of a file of that delivery: name another file.")
