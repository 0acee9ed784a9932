"""From a job file to its regions: the whole of it is checked before anything runs."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, NoReturn

from pydantic import ValidationError

from cadpanel.brep.files.text_check import require_files
from cadpanel.delivery.outputs.catalogue import chosen_outputs
from cadpanel.delivery.own_files import REPORT
from cadpanel.errors import CadpanelError, SettingsError
from cadpanel.fitting.rules.lock import LockRule
from cadpanel.fitting.settings import FitSettings
from cadpanel.jobs.expand import Given, expanded, out_of, variables_of
from cadpanel.jobs.job_file import JobFile, Table, lower
from cadpanel.jobs.region import Job, Region
from cadpanel.jobs.schema import DELIVERIES, MATRIX, REFERENCE, RULES, SHA256, asked, made, region_values
from cadpanel.near import near_names
from cadpanel.reference.texts import BY_FITS


def read_job(path: Path) -> Job:
    """The job in a file.

    Raises:
        SettingsError: it cannot be read, or something in it is refused; one sentence says what, and on which line.
    """
    file = JobFile(path)
    variables = variables_of(file)
    regions = tuple(_region(file, given) for given in expanded(file, variables))
    out = out_of(file, variables)
    return Job(out=Path(os.path.normpath(path.absolute().parent / out)) if out else None, regions=regions)


def _region(file: JobFile, given: Given) -> Region:
    """One region, checked.

    Raises:
        SettingsError: saying on which line something is wrong.
    """
    try:
        values = region_values().validate_python(given.values)
    except ValidationError as error:
        _refuse_values(file, given, error)
    folder = file.path.absolute().parent
    reference = Path(os.path.normpath(folder / values.pop(REFERENCE)))
    sha256 = values.pop(SHA256, "").lower()  # some programs tell it in capitals
    named = values.pop(DELIVERIES, {})
    for key, value in values.items():
        if asked()[key].is_file and isinstance(value, str) and value:
            values[key] = os.path.normpath(folder / value)
    how, settings, sheet, shop = _made(file, given, values)
    lying = {name: Path(os.path.normpath(folder / value)) for name, value in named.items()}
    deliveries = dict(_deliveries(file, given, settings, lying))
    _check(file, given, reference, how, settings, shop)
    if settings.rules is not None:
        values[RULES] = _thawed(settings.rules.plain())
    return Region(
        name=given.name,
        reference=reference,
        sha256=sha256,
        deliveries=deliveries,
        given=values,
        how=how,
        settings=settings,
        sheet=sheet,
        shop=shop,
    )


def _deliveries(
    file: JobFile, given: Given, settings: FitSettings, named: Mapping[str, Path]
) -> Iterator[tuple[str, Path]]:
    """The earlier deliveries that panels are locked to, by their names, and where they lie.

    Raises:
        SettingsError: one is not there, or a folder is named that no rule is about.
    """
    rules = () if settings.rules is None else settings.rules.rules
    locks = dict.fromkeys(rule.delivery for rule in rules if isinstance(rule, LockRule) and rule.unread)
    for name in named if given.place(DELIVERIES) == (*given.header, DELIVERIES) else ():
        if name not in locks:
            file.refuse(
                given.place(DELIVERIES),
                f"no [[lock]] is about the delivery '{name}'; {near_names(name, locks)}",
            )
    for name in locks:
        place = Path(named.get(name, name)).absolute()
        if not (place / REPORT).is_file():
            where = (
                "" if name in named else f", which is looked for where the program runs unless '{DELIVERIES}' names it"
            )
            file.refuse(
                given.place(DELIVERIES if name in named else RULES),
                f"region '{given.name}' locks panels to '{name}'{where}: there is no {REPORT} in '{place}'",
            )
        yield name, place


def _check(file: JobFile, given: Given, reference: Path, how: Any, settings: Any, shop: Any) -> None:
    """Refuse what the settings cannot know by themselves: files, packages, and what goes with what."""
    try:
        require_files(reference, how)
    except CadpanelError as error:
        key = next((one for one in ("network", "mesh", "spine") if one in given.values), REFERENCE)
        beside = how.beside(reference)
        file.refuse(given.place(REFERENCE if beside is None or beside.name not in str(error) else key), str(error))
    try:
        chosen_outputs(shop.outputs)
    except SettingsError as error:
        file.refuse(given.place("outputs"), str(error))
    if how.divide in BY_FITS and settings.max_deviation is None:
        file.refuse(given.place("divide"), f"'divide = \"{how.divide}\"' is chosen by a max_deviation: give one, too")


def _refuse_values(file: JobFile, given: Given, error: ValidationError) -> NoReturn:
    fault = error.errors(include_url=False)[0]
    key = str(fault["loc"][0])
    if fault["type"] == "extra_forbidden":
        known = [REFERENCE, SHA256, DELIVERIES, MATRIX, *asked()]
        file.refuse(given.place(key), f"there is no setting '{key}' of a region; {near_names(key, known)}")
    if fault["type"] == "missing":
        file.refuse(given.header, f"region '{given.name}' has no reference: name its file by 'reference = \"...\"'")
    wanted = " or ".join(dict.fromkeys(lower(one["msg"]) for one in error.errors() if one["loc"][0] == key))
    file.refuse(given.place(key), f"'{key}' of region '{given.name}': {wanted}, and it is {given.values[key]!r}")


def _made(file: JobFile, given: Given, values: Table) -> tuple[Any, Any, Any, Any]:
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


def _thawed(value: Any) -> Any:
    """As TOML has it."""
    if isinstance(value, Mapping):
        return {key: _thawed(inner) for key, inner in value.items()}
    return [_thawed(inner) for inner in value] if isinstance(value, list | tuple) else value
