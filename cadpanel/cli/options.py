"""Options that several commands share, and the settings that options make."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, is_dataclass, replace
from functools import wraps
from inspect import Parameter, Signature, signature
from pathlib import Path
from typing import Annotated, Any, get_args, get_origin, get_type_hints

import typer

from cadpanel.errors import SettingsError
from cadpanel.features.catalogue import AUTO
from cadpanel.setting import Option, options_of

ReferenceFile = Annotated[
    Path,
    typer.Argument(
        metavar="REFERENCE",
        help="STEP, IGES, .brep or .3dm file; each product in it is one panel's faces, unless it is to be cut.",
    ),
]


def folder_named(text: str) -> Path:
    """The folder that a name stands for; the empty one would be the folder that the command runs in.

    Raises:
        SettingsError: the name is empty.
    """
    if not text.strip():
        raise SettingsError("--out is the name of the folder to write, not ''")
    return Path(text)


Out = Annotated[
    Path,
    typer.Option("--out", metavar="DIR", parser=folder_named, help="Folder to write, whole or not at all."),
]
Overwrite = Annotated[bool, typer.Option("--overwrite", help="Replace a delivery that stands there already.")]
TimeLimit = Annotated[
    float | None,
    typer.Option(
        "--time-limit",
        metavar="SECONDS",
        min=0.001,
        help="End the fit of all panels after so long, with the best so far; what is missed is told.",
    ),
]
Quiet = Annotated[bool, typer.Option("--quiet", help="Print nothing but what is wrong.")]


@dataclass(frozen=True, slots=True)
class Only:
    """Beside a parameter's type: which fields of its settings a command asks for, in that order."""

    names: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Without:
    """Beside a parameter's type: which fields of its settings a command does not ask for."""

    names: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Usual:
    """Beside a parameter's type: settings that hold where nothing is given, instead of their fields' defaults."""

    settings: object

    def own(self) -> dict[str, object]:
        """What differs from the defaults."""
        found = {field: getattr(self.settings, field.name) for field, _ in options_of(type(self.settings))}
        return {field.name: value for field, value in found.items() if value != field.default}


@dataclass(frozen=True, slots=True, kw_only=True)
class _Asked:
    """One setting as a command asks for it; `usual` where nothing is given, if it is not the settings' default."""

    name: str
    option: Option
    parameter: Parameter
    usual: Mapping[str, object]

    def of(self, given: Mapping[str, Any]) -> dict[str, object]:
        """The setting by its name; nothing where what is shown as the default stands, which says it for people."""
        value = given[self.name]
        if value is None or value == self.parameter.default:
            return dict(self.usual)
        return {self.name: value if self.option.read is None else self.option.read(flag(self.name), value)}


def flag(name: str) -> str:
    """The option that a field is asked for by."""
    return f"--{name.replace('_', '-')}"


def made_of_settings(command: Callable[..., None]) -> Callable[..., None]:
    """A command whose parameters of settings are asked for by one option a field, where the parameter stands.

    What is not given is left to the settings' own defaults.

    Raises:
        SettingsError: when the command runs; an option is out of its range, or contradicts another one.
    """
    hints = get_type_hints(command, include_extras=True)
    shown: list[Parameter] = []
    made: dict[str, tuple[type[Any], list[_Asked]]] = {}
    for name, parameter in signature(command).parameters.items():
        settings, choice = _settings_of(hints[name])
        if settings is None:
            shown.append(parameter.replace(annotation=hints[name], kind=Parameter.KEYWORD_ONLY))
            continue
        made[name] = (settings, _asked(settings, choice))
        shown += [one.parameter for one in made[name][1]]

    @wraps(command)
    def asking(**given: Any) -> None:
        _refuse_contradictions(given)
        settings = {
            name: kind(**{key: value for one in asked for key, value in one.of(given).items()})
            for name, (kind, asked) in made.items()
        }
        options = {one.name for _, asked in made.values() for one in asked}
        command(**settings, **{name: value for name, value in given.items() if name not in options})

    asking.__signature__ = Signature(shown)  # type: ignore[attr-defined] # as inspect reads it, and so typer
    asking.__annotations__ = {parameter.name: parameter.annotation for parameter in shown}
    return asking


def _settings_of(hint: Any) -> tuple[type[Any] | None, Iterable[object]]:
    """The settings that a parameter holds, if any, and what stands beside its type."""
    kind, *beside = get_args(hint) if get_origin(hint) is Annotated else (hint,)
    return (kind if is_dataclass(kind) and isinstance(kind, type) else None), beside


def _asked(settings: type[Any], choice: Iterable[object]) -> list[_Asked]:
    hints = get_type_hints(settings)
    usual = {name: value for one in choice if isinstance(one, Usual) for name, value in one.own().items()}
    found = {}
    for field, option in options_of(settings):
        name, told = field.name, usual.get(field.name, field.default)
        # What may be left empty is not told, or it would seem to have been given.
        option = replace(option, told=option.told and field.default is not None)
        found[name] = _Asked(
            name=name,
            option=option,
            parameter=_parameter(name, hints[name], told, option),
            usual={name: usual[name]} if name in usual else {},
        )
    names = list(found)
    for one in choice:
        if isinstance(one, Only):
            names = list(one.names)
        if isinstance(one, Without):
            names = [name for name in names if name not in one.names]
    return [found[name] for name in names]


def _parameter(name: str, kind: Any, default: Any, option: Option) -> Parameter:
    """The parameter of a command that typer makes an option of."""
    told = option.told and default is not None
    takes = option.takes or kind
    return Parameter(
        name,
        Parameter.KEYWORD_ONLY,
        default=(default if option.show is None else option.show(default)) if told else None,
        annotation=Annotated[
            takes if told else takes | None, typer.Option(flag(name), metavar=option.metavar, help=option.help)
        ],
    )


def _refuse_contradictions(given: Mapping[str, Any]) -> None:
    """Refuse options that cannot stand together, by the names that they have here."""
    for gap in ("gap_tolerance", "joint_tolerance", "step", "shift") if given.get("weights") is not None else ():
        if given.get(gap) is not None:
            raise SettingsError(f"--weights take the place of a tolerance: leave out either --weights or {flag(gap)}.")
    if "feature" in given and (given["feature"] == AUTO) != (given["max_deviation"] is not None):
        raise SettingsError(f"--feature {AUTO} and --max-deviation go together: give both or neither.")
