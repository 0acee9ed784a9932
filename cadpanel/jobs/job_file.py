"""A job file as it is written: its text, for refusals that name a line of it, and what stands in it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NoReturn

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from cadpanel.errors import SettingsError
from cadpanel.jobs.lines import line_of
from cadpanel.jobs.schema import asked
from cadpanel.jobs.variables import substituted
from cadpanel.near import near_names
from cadpanel.toml_file import read_toml

Table = dict[str, Any]
Keys = tuple[str, ...]
"""Where something stands: the names of the tables from the outermost in, then its own."""


class JobModel(BaseModel):
    """What stands in a job; its regions are checked once variables are put in their places.

    Attributes:
        out: the folder to write into.
        variables: what `${name}` stands for.
        defaults: what holds for every region that does not say otherwise.
        regions: by name.
    """

    model_config = ConfigDict(extra="forbid", strict=True, allow_inf_nan=False)

    out: str = ""
    variables: dict[str, str | int | float | bool | list[Any]] = {}
    defaults: Table = {}
    regions: dict[str, Table] = Field(min_length=1)


class JobFile:
    """A job file that was read.

    Attributes:
        path: the file.
        model: what stands in it.
    """

    def __init__(self, path: Path) -> None:
        """Read it.

        Raises:
            SettingsError: it cannot be read, or is no job.
        """
        self.path = path
        self._text, content = read_toml(path, "the job")
        try:
            self.model = JobModel.model_validate(content)
        except ValidationError as error:
            self._refuse_model(error)

    def refuse(self, place: Sequence[str], said: str) -> NoReturn:
        """Say in one sentence what is wrong on which line."""
        sentence = said.strip().rstrip(".")
        raise SettingsError(f"'{self.path}', line {line_of(self._text, place)}: {sentence}.")

    def filled(self, place: Keys, value: Any, known: Mapping[str, Any], elsewhere: Mapping[str, str]) -> Any:
        """A value of the file with variables in their places, as `substituted` does it.

        Raises:
            SettingsError: there is no variable of a name; the sentence names the line.
        """
        try:
            return substituted(value, known, elsewhere)
        except SettingsError as error:
            self.refuse(place, str(error))

    def _refuse_model(self, error: ValidationError) -> NoReturn:
        fault = error.errors(include_url=False)[0]
        place = tuple(str(part) for part in fault["loc"])
        if fault["type"] == "extra_forbidden":
            known = [*JobModel.model_fields, "regions.NAME"] if place[0] not in asked() else list(JobModel.model_fields)
            there = "; settings stand in [defaults] or in a region" if place[0] in asked() else ""
            self.refuse(place, f"a job has no '{place[0]}'{there or f'; {near_names(place[0], known)}'}")
        if place == ("regions",):
            self.refuse(place, "a job has at least one region: a table [regions.NAME] with a reference")
        self.refuse(place, f"'{'.'.join(place[:2])}': {lower(fault['msg'])}")


def lower(said: str) -> str:
    """A sentence as a part of another one."""
    return said[:1].lower() + said[1:]
