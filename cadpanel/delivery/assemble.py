"""A whole building: one STEP file on top of the deliveries of its regions, which stay the files that they are."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from cadpanel.brep.step.file import write_assembly
from cadpanel.brep.step.part_files import PartFile
from cadpanel.brep.step.products import Header
from cadpanel.delivery.outputs.step_files import PANELS
from cadpanel.delivery.own_files import REPORT
from cadpanel.delivery.records.report import ReportModel, read_report
from cadpanel.delivery.source_date import source_date
from cadpanel.errors import DeliveryError
from cadpanel.kinds import checked


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
            readers of STEP do not find again, or the file cannot be written.
    """
    target = Path(file).absolute()
    reports = {Path(folder).absolute(): read_report(Path(folder) / REPORT) for folder in deliveries}
    _demand_parts(list(reports), target)
    schemas = {report.settings.step_schema for report in reports.values()}
    if len(schemas) != 1:
        raise DeliveryError(f"'{target.name}' cannot hold {', '.join(sorted(schemas)) or 'no delivery'}: choose one.")
    parts = [_part(folder, report, target.parent) for folder, report in reports.items()]
    write_assembly(target, parts, title=target.stem, schema=schemas.pop(), header=Header(date=source_date()))


def _demand_parts(folders: Sequence[Path], target: Path) -> None:
    """Names that tell regions apart, and the files that are to be found."""
    for name, times in Counter(folder.name for folder in folders).items():
        if times > 1:
            raise DeliveryError(f"{times} deliveries are called '{name}', which '{target.name}' cannot tell apart.")
    for folder in folders:
        if not (folder / PANELS).is_file():
            raise DeliveryError(f"'{folder}' holds no {PANELS} to hang in '{target.name}': deliver that region again.")


def _part(folder: Path, report: ReportModel, beside: Path) -> PartFile:
    """What hangs in the assembly: a file in local coordinates is put where these lie in the model."""
    path = Path(os.path.relpath(folder / PANELS, beside)).as_posix()
    placed = (0.0, 0.0, 0.0) if report.origin.kept else report.origin.offset
    return PartFile(name=folder.name, path=path, placed=placed)
