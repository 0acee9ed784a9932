"""A region as a task that may be worked off anywhere: its files are told by what they hold, not by where they lie."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from cadpanel.brep.files.text_check import MARGIN_BYTES, RHINO_START
from cadpanel.delivery.outputs.catalogue import chosen_outputs
from cadpanel.delivery.own_files import REPORT
from cadpanel.delivery.settings import SheetSettings
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.errors import SettingsError
from cadpanel.fitting.settings import FitSettings
from cadpanel.jobs.program import program, program_sum
from cadpanel.jobs.region import Region
from cadpanel.jobs.schema import RULES, asked
from cadpanel.reference.settings import ReferenceSettings

_RHINO = "rhino3dm"


@dataclass(frozen=True, slots=True)
class Content:
    """A file that a task needs.

    Attributes:
        name: of the file, as reports tell it.
        sha256: of its bytes.
        path: where it lies for whoever made the task.
        needs: the package that reads it, if one is needed besides those that are always there.
    """

    name: str
    sha256: str
    path: Path
    needs: str = ""

    def read(self) -> bytes:
        """Its bytes.

        Raises:
            SettingsError: they cannot be read, or are not those that the task is about.
        """
        try:
            found = self.path.read_bytes()
        except OSError as error:
            raise SettingsError(f"'{self.path}' cannot be read: {error.strerror or error}") from error
        if hashlib.sha256(found).hexdigest() != self.sha256:
            raise SettingsError(f"'{self.path}' has changed since the run began: run the job again")
        return found


@dataclass(frozen=True, slots=True, kw_only=True)
class Task:
    """What is to be made.

    Attributes:
        name: of the region.
        key: of all that the result depends on; the same key, the same result.
        contents: the files: the reference, what is read beside it, reports of earlier deliveries.
        beside: the place of what is read beside the reference; None where there is nothing.
        locks: the places of the reports of earlier deliveries, by the names that rules have for these.
        how: how the reference is read; what is read beside it is named by `beside` alone.
        settings, sheet, shop: how panels are fitted, built and delivered.
        date: the date of files, as SOURCE_DATE_EPOCH has it; None for the present.
        needs: packages that it needs besides those that are always there: what reads its files, and writes its outputs.
        program: the sum of the program that is to make it, these packages included.
    """

    name: str
    key: str
    contents: tuple[Content, ...]
    beside: int | None
    locks: Mapping[str, int]
    how: ReferenceSettings
    settings: FitSettings
    sheet: SheetSettings
    shop: ShopSettings
    date: str | None
    needs: tuple[str, ...]
    program: str


class Files:
    """The files of a run: each is looked at once, and is the same for all regions that are about it."""

    def __init__(self) -> None:
        """Nothing was looked at yet."""
        self._known = dict[Path, Content]()

    def content(self, path: Path) -> Content:
        """What a file holds, or held when it was first asked for.

        Raises:
            SettingsError: it cannot be read.
        """
        if path not in self._known:
            self._known[path] = _content(path)
        return self._known[path]


def parts_of(regions: Sequence[Region], date: str | None = None) -> list[tuple[Region, Task]]:
    """The regions of a run with their tasks.

    Raises:
        SettingsError: as `task_of` says.
    """
    files = Files()
    return [(region, task_of(region, date, files)) for region in regions]


def task_of(region: Region, date: str | None = None, files: Files | None = None) -> Task:
    """The task of a region.

    Args:
        region: what is to be made.
        date: of files, as SOURCE_DATE_EPOCH has it.
        files: those of the run; looked at now if None.

    Raises:
        SettingsError: a file cannot be read, or the reference is another one than the job was made for.
    """
    files = files or Files()
    contents = [files.content(region.reference)]
    if region.sha256 and region.sha256 != contents[0].sha256:
        raise SettingsError(
            f"'{region.reference}' of region '{region.name}' is not the file that the job was made with: bring that "
            "back, or leave out 'sha256' to take this one"
        )
    beside, file = None, region.how.spine or region.how.network or region.how.mesh
    if file is not None:
        other = region.how.beside(region.reference)
        beside = 0 if other is None else len(contents)
        contents += [] if other is None else [files.content(other)]
    locks: dict[str, int] = {}
    for name, place in region.deliveries.items():
        locks[name] = len(contents)
        contents.append(files.content(place / REPORT))
    needs = _needs(region, contents)
    return Task(
        name=region.name,
        key=_key(region, contents, date, needs),
        contents=tuple(contents),
        beside=beside,
        locks=locks,
        how=region.how,
        settings=region.settings,
        sheet=region.sheet,
        shop=region.shop,
        date=date,
        needs=needs,
        program=program_sum(needs),
    )


def located(how: ReferenceSettings, beside: Path | None) -> ReferenceSettings:
    """The same where what is read beside the reference lies elsewhere."""
    if beside is None:
        return how
    role = next(name for name in ("spine", "network", "mesh") if getattr(how, name) is not None)
    changes: dict[str, Any] = {role: beside}
    return replace(how, **changes)


def _needs(region: Region, contents: list[Content]) -> tuple[str, ...]:
    found = {package for output in chosen_outputs(region.shop.outputs) for package in output.needs}
    return tuple(sorted(found | {content.needs for content in contents if content.needs}))


def _key(region: Region, contents: list[Content], date: str | None, needs: tuple[str, ...]) -> str:
    """Of all that the result depends on: contents, settings, and the program with what it computes with."""
    given = {name: value for name, value in region.given.items() if name == RULES or not asked()[name].is_file}
    told = {
        "program": program(needs),
        "date": date,
        "contents": [(content.name, content.sha256) for content in contents],
        "beside": sorted(name for name in region.given if name != RULES and asked()[name].is_file),
        "settings": given,
    }
    return hashlib.sha256(json.dumps(told, sort_keys=True, ensure_ascii=False).encode()).hexdigest()


def _content(path: Path) -> Content:
    try:
        with path.open("rb") as file:
            digest = hashlib.file_digest(file, "sha256").hexdigest()
            file.seek(0)
            needs = _RHINO if RHINO_START.match(file.read(MARGIN_BYTES)) else ""
    except OSError as error:
        raise SettingsError(f"'{path}' cannot be read: {error.strerror or error}") from error
    return Content(path.name, digest, path, needs)
