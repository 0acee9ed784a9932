"""A job as it was run, without variables, defaults and matrices: running it again gives the same."""

from __future__ import annotations

import os
from codecs import BOM_UTF8
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import tomli_w

from cadpanel.jobs.program import program
from cadpanel.jobs.region import Region
from cadpanel.jobs.schema import DELIVERIES, REFERENCE, RULES, SHA256, asked
from cadpanel.jobs.task import Task
from cadpanel.jobs.variables import escaped

_MARK = "# A job of cadpanel"


def job_text(parts: Sequence[tuple[Region, Task]], folder: Path) -> str:
    """What job.toml in a folder holds of some regions, files by where they lie from there.

    Args:
        parts: the regions, each with its task, which knows the sum of its reference.
        folder: in which the text is to stand.
    """
    regions = {region.name: _plain(region, task, folder) for region, task in parts}
    keys = ", ".join(task.key[:16] for _, task in parts)
    head = (
        f"{_MARK} {program()['version']}, as it was run; 'cadpanel run' of this file gives the same.\n"
        "# Files are named by where they lie from here; a reference with another sha256 is refused.\n"
        f"# Content: {keys}\n"
    )
    return f"{head}\n{tomli_w.dumps({'regions': regions})}"


def is_a_job(path: Path) -> bool:
    """Whether a file is one that was written here.

    Raises:
        OSError: it cannot be read.
    """
    with path.open("rb") as file:
        # Some editors put a mark before the text that they save.
        return file.read(len(_MARK) + len(BOM_UTF8)).removeprefix(BOM_UTF8).startswith(_MARK.encode())


def _plain(region: Region, task: Task, folder: Path) -> Mapping[str, Any]:
    given = {
        key: _from(folder, value) if key != RULES and asked()[key].is_file else value
        for key, value in region.given.items()
    }
    lying = {name: _from(folder, place) for name, place in region.deliveries.items()}
    whole = {
        REFERENCE: _from(folder, region.reference),
        SHA256: task.contents[0].sha256,
        **({DELIVERIES: lying} if lying else {}),
        **given,
    }
    plain: Mapping[str, Any] = escaped(whole)
    return plain


def _from(folder: Path, path: str | Path) -> str:
    """Where a file lies from a folder; the whole path where no way leads there, as from one drive to another."""
    try:
        return Path(os.path.relpath(path, folder)).as_posix()
    except ValueError:
        return Path(path).as_posix()
