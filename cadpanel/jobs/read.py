"""From a job file to its regions: the whole of it is checked before anything runs."""

from __future__ import annotations

import os
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NoReturn

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from cadpanel.brep.files.text_check import require_files
from cadpanel.delivery.file_names import file_names
from cadpanel.delivery.outputs.catalogue import chosen_outputs
from cadpanel.errors import CadpanelError, SettingsError
from cadpanel.jobs.lines import line_of
from cadpanel.jobs.region import Job, Region
from cadpanel.jobs.schema import RULES, asked, made, region_values
from cadpanel.jobs.variables import combinations, resolved, substituted
from cadpanel.near import near_names
from cadpanel.reference.texts import BY_FITS

_LONGEST_NAME = 120
_REFERENCE, _SHA256, _MATRIX = "reference", "sha256", "matrix"

Table = dict[str, Any]
Path_ = tuple[str, ...]


class JobModel(BaseModel):
    """A job file as it is written; what stands in its regions is checked once variables are put in their places.

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


@dataclass(frozen=True, slots=True)
class _Values:
    """The values of a region before they are checked, and where in the file each stands."""

    name: str
    values: Table
    places: Mapping[str, Path_]
    header: Path_

    def place(self, key: str) -> Path_:
        return self.places.get(key, self.header)


class _File:
    """The text of a job file, for refusals that name a line of it."""

    def __init__(self, path: Path, text: str) -> None:
        self.path, self.text = path, text

    def refuse(self, place: Sequence[str], said: str) -> NoReturn:
        """Say in one sentence what is wrong on which line."""
        sentence = said.strip().rstrip(".")
        raise SettingsError(f"'{self.path}', line {line_of(self.text, place)}: {sentence}.")


def read_job(path: Path) -> Job:
    """The job in a file.

    Raises:
        SettingsError: it cannot be read, or something in it is refused; one sentence says what, and on which line.
    """
    file = _File(path, _text(path))
    try:
        content = tomllib.loads(file.text)
    except tomllib.TOMLDecodeError as error:
        raise SettingsError(f"the job '{path}' is no TOML: {error}.") from error
    try:
        model = JobModel.model_validate(content)
    except ValidationError as error:
        _refuse_model(file, error)
    try:
        variables = resolved(model.variables)
    except SettingsError as error:
        file.refuse(("variables",), str(error))
    regions = [_region(file, one) for one in _expanded(file, model, variables)]
    _require_different(file, regions)
    folder = path.absolute().parent
    out = _filled(file, ("out",), model.out, variables)
    return Job(out=Path(os.path.normpath(folder / str(out))) if out else None, regions=tuple(regions))


def _text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8")
    except OSError as error:
        raise SettingsError(f"the job '{path}' cannot be read: {error.strerror or error}.") from error
    except UnicodeDecodeError as error:
        raise SettingsError(f"the job '{path}' is no text in UTF-8: save the file as such.") from error


def _refuse_model(file: _File, error: ValidationError) -> NoReturn:
    fault = error.errors(include_url=False)[0]
    place = tuple(str(part) for part in fault["loc"])
    if fault["type"] == "extra_forbidden":
        known = [*JobModel.model_fields, "regions.NAME"] if place[0] not in asked() else list(JobModel.model_fields)
        there = "; settings stand in [defaults] or in a region" if place[0] in asked() else ""
        file.refuse(place, f"a job has no '{place[0]}'{there or f'; {near_names(place[0], known)}'}")
    if place == ("regions",):
        file.refuse(place, "a job has at least one region: a table [regions.NAME] with a reference")
    file.refuse(place, f"'{'.'.join(place[:2])}': {_lower(fault['msg'])}")


def _expanded(file: _File, model: JobModel, variables: Mapping[str, Any]) -> Iterator[_Values]:
    """Every region with what it takes over from the defaults, once for each combination of its matrix."""
    for name, own in model.regions.items():
        header = ("regions", name)
        places = {key: ("defaults", key) for key in model.defaults} | {key: (*header, key) for key in own}
        given = {**model.defaults, **own}
        matrix = _matrix(file, places.get(_MATRIX, header), given.pop(_MATRIX, {}), variables)
        for ending, chosen in combinations(matrix):
            known = {**variables, "region": name, **chosen}
            values = {key: _filled(file, places[key], value, known) for key, value in given.items()}
            settings = {key: value for key, value in chosen.items() if key in asked() or key == _REFERENCE}
            there = {key: (*places[_MATRIX], key) for key in settings}
            yield _Values(f"{name}{ending}", {**values, **settings}, {**places, **there}, header)


def _matrix(file: _File, place: Path_, given: Any, variables: Mapping[str, Any]) -> dict[str, list[Any]]:
    found = _filled(file, place, given, variables)
    if not isinstance(found, dict):
        file.refuse(place, "a matrix is a table of lists, like gap_tolerance = [1, 3]")
    for key, values in found.items():
        if not isinstance(values, list) or not values:
            file.refuse((*place, key), f"'{key}' in a matrix is a list of values, not {values!r}")
    return found


def _filled(file: _File, place: Path_, value: Any, variables: Mapping[str, Any]) -> Any:
    try:
        return substituted(value, variables)
    except SettingsError as error:
        file.refuse(place, str(error))


def _region(file: _File, given: _Values) -> Region:
    """One region, checked.

    Raises:
        SettingsError: saying on which line something is wrong.
    """
    try:
        values = region_values().validate_python(given.values)
    except ValidationError as error:
        _refuse_values(file, given, error)
    folder = file.path.absolute().parent
    reference = Path(os.path.normpath(folder / values.pop(_REFERENCE)))
    sha256 = values.pop(_SHA256, "")
    for key, value in values.items():
        if asked()[key].is_file and isinstance(value, str) and value:
            values[key] = os.path.normpath(folder / value)
    how, settings, sheet, shop = _made(file, given, values)
    _check(file, given, reference, how, settings, shop)
    if settings.rules is not None:
        values[RULES] = _thawed(settings.rules.plain())
    return Region(
        name=given.name,
        reference=reference,
        sha256=sha256,
        given=values,
        how=how,
        settings=settings,
        sheet=sheet,
        shop=shop,
    )


def _check(file: _File, given: _Values, reference: Path, how: Any, settings: Any, shop: Any) -> None:
    """Refuse what the settings cannot know by themselves: files, packages, and what goes with what."""
    try:
        require_files(reference, how)
    except CadpanelError as error:
        key = next((one for one in ("network", "mesh", "spine") if one in given.values), _REFERENCE)
        beside = how.beside(reference)
        file.refuse(given.place(_REFERENCE if beside is None or beside.name not in str(error) else key), str(error))
    try:
        chosen_outputs(shop.outputs)
    except SettingsError as error:
        file.refuse(given.place("outputs"), str(error))
    if how.divide in BY_FITS and settings.max_deviation is None:
        file.refuse(given.place("divide"), f"'divide = \"{how.divide}\"' is chosen by a max_deviation: give one, too")


def _refuse_values(file: _File, given: _Values, error: ValidationError) -> NoReturn:
    fault = error.errors(include_url=False)[0]
    key = str(fault["loc"][0])
    if fault["type"] == "extra_forbidden":
        known = [_REFERENCE, _SHA256, _MATRIX, *asked()]
        file.refuse(given.place(key), f"there is no setting '{key}' of a region; {near_names(key, known)}")
    if fault["type"] == "missing":
        file.refuse(given.header, f"region '{given.name}' has no reference: name its file by 'reference = \"...\"'")
    wanted = " or ".join(dict.fromkeys(_lower(one["msg"]) for one in error.errors() if one["loc"][0] == key))
    file.refuse(given.place(key), f"'{key}' of region '{given.name}': {wanted}, and it is {given.values[key]!r}")


def _made(file: _File, given: _Values, values: Table) -> tuple[Any, Any, Any, Any]:
    """The settings, or a refusal on the line of the value without which there would be none."""
    try:
        return made(values)
    except SettingsError as error:
        key = next((key for key in reversed(values) if _holds_without(values, key)), None)
        said = str(error)
        for name in asked():  # messages know settings by their options
            said = said.replace(f"--{name.replace('_', '-')} ", f"{name} ")
        file.refuse(given.header if key is None else given.place(key), f"region '{given.name}': {said}")


def _holds_without(values: Table, key: str) -> bool:
    try:
        made({name: value for name, value in values.items() if name != key})
    except SettingsError:
        return False
    return True


def _require_different(file: _File, regions: Sequence[Region]) -> None:
    """Refuse names that are no folders, or one where case does not count."""
    names = [region.name for region in regions]
    for name, safe in zip(names, file_names(names, _LONGEST_NAME), strict=True):
        if name != safe or name.startswith("."):
            file.refuse(
                ("regions", name),
                f"the region '{name}' cannot have a folder of its name: call it '{safe.lstrip('.')}', for example",
            )


def _thawed(value: Any) -> Any:
    """As TOML has it."""
    if isinstance(value, Mapping):
        return {key: _thawed(inner) for key, inner in value.items()}
    return [_thawed(inner) for inner in value] if isinstance(value, list | tuple) else value


def _lower(said: str) -> str:
    return said[:1].lower() + said[1:]
