"""A region as a task that may be worked off anywhere: its files are told by what they hold, not by where they lie."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cache
from importlib.metadata import PackageNotFoundError, requires, version
from pathlib import Path
from typing import Any

from cadpanel.delivery.own_files import REPORT
from cadpanel.delivery.settings import SheetSettings
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.errors import SettingsError
from cadpanel.fitting.settings import FitSettings
from cadpanel.jobs.region import Region
from cadpanel.jobs.schema import RULES, asked
from cadpanel.reference.settings import ReferenceSettings


@dataclass(frozen=True, slots=True)
class Content:
    """A file that a task needs.

    Attributes:
        name: of the file, as reports tell it.
        sha256: of its bytes.
        path: where it lies for whoever made the task.
    """

    name: str
    sha256: str
    path: Path

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
        program: the sum of the program that is to make it.
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
    program: str


def task_of(region: Region, date: str | None = None) -> Task:
    """The task of a region.

    Raises:
        SettingsError: a file cannot be read, or the reference is another one than the job was made for.
    """
    contents = [_content(region.reference)]
    if region.sha256 and region.sha256 != contents[0].sha256:
        raise SettingsError(
            f"'{region.reference}' of region '{region.name}' is not the file that the job was made with: bring that "
            "back, or leave out 'sha256' to take this one"
        )
    beside, file = None, region.how.spine or region.how.network or region.how.mesh
    if file is not None:
        other = region.how.beside(region.reference)
        beside = 0 if other is None else len(contents)
        contents += [] if other is None else [_content(other)]
    locks: dict[str, int] = {}
    for name, place in region.deliveries.items():
        locks[name] = len(contents)
        contents.append(_content(place / REPORT))
    return Task(
        name=region.name,
        key=_key(region, contents, date),
        contents=tuple(contents),
        beside=beside,
        locks=locks,
        how=region.how,
        settings=region.settings,
        sheet=region.sheet,
        shop=region.shop,
        date=date,
        program=program_sum(),
    )


def located(how: ReferenceSettings, beside: Path | None) -> ReferenceSettings:
    """The same where what is read beside the reference lies elsewhere."""
    if beside is None:
        return how
    role = next(name for name in ("spine", "network", "mesh") if getattr(how, name) is not None)
    changes: dict[str, Any] = {role: beside}
    return replace(how, **changes)


def _key(region: Region, contents: list[Content], date: str | None) -> str:
    """Of all that the result depends on: contents, settings, and the program with what it computes with."""
    given = {name: value for name, value in region.given.items() if name == RULES or not asked()[name].is_file}
    told = {
        "program": program(),
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
    except OSError as error:
        raise SettingsError(f"'{path}' cannot be read: {error.strerror or error}") from error
    return Content(path.name, digest, path)


@cache
def program() -> Mapping[str, Any]:
    """Which program it is: its version, its own text, and the versions of what it computes with."""
    text = hashlib.sha256()
    home = Path(__file__).parents[1]
    for file in sorted(home.rglob("*.py")):
        text.update(file.relative_to(home).as_posix().encode() + b"\0" + file.read_bytes())
    return {"version": version("cadpanel"), "text": text.hexdigest(), "packages": _packages()}


def program_sum() -> str:
    """The same in one word."""
    return hashlib.sha256(json.dumps(program(), sort_keys=True).encode()).hexdigest()


def _packages() -> dict[str, str]:
    names = {line.split(";")[0].split("[")[0] for line in requires("cadpanel") or () if "extra ==" not in line}
    bare = {"".join(sign for sign in _before(name) if not sign.isspace()) for name in (*names, "cadquery-ocp")}
    found = {}
    for name in sorted(bare):
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            continue  # another package of the same content
    return found


def _before(requirement: str) -> str:
    """A package's name without the versions that are wanted."""
    for sign in "<>=!~ (":
        requirement = requirement.partition(sign)[0]
    return requirement
