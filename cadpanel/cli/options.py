"""Options that several commands share, and the settings that options make."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, is_dataclass, replace
from functools import wraps
from inspect import Parameter, Signature, signature
from itertools import product
from pathlib import Path
from typing import Annotated, Any, get_args, get_origin, get_type_hints

import typer

from cadpanel.cli.groups import OUTPUT, RUN, group_of, rank
from cadpanel.errors import SettingsError
from cadpanel.features.catalogue import AUTO
from cadpanel.fitting.settings import OF_GAPS
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
    typer.Option(
        "--out",
        metavar="DIR",
        parser=folder_named,
        help="Folder to write, whole or not at all.",
        rich_help_panel=OUTPUT,
    ),
]
Overwrite = Annotated[
    bool, typer.Option("--overwrite", help="Replace a delivery that stands there already.", rich_help_panel=OUTPUT)
]
TimeLimit = Annotated[
    float | None,
    typer.Option(
        "--time-limit",
        metavar="SECONDS",
        min=0.001,
        help="End the fit of all panels after so long, with the best so far; what is missed is told.",
        rich_help_panel=RUN,
    ),
]
TellSteps = Annotated[
    bool,
    typer.Option(
        "--tell-steps",
        help="Tell each step as a line of JSON on the error stream, for programs to show.",
        rich_help_panel=RUN,
    ),
]
Verbose = Annotated[
    bool,
    typer.Option(
        "--verbose",
        help="Hold the result against each panel alone and against two stages, in the closing table.",
        rich_help_panel=RUN,
    ),
]
Quiet = Annotated[bool, typer.Option("--quiet", help="Print nothing but what is wrong.", rich_help_panel=RUN)]


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


@dataclass(frozen=True, slots=True)
class Each:
    """Beside a tuple of settings: which of their fields are asked for by lists, and by which options.

    The command gets one of the settings for each combination, the first field changing slowest.
    """

    options: Mapping[str, str]


@dataclass(frozen=True, slots=True, kw_only=True)
class _Asked:
    """One setting as a command asks for it; `usual` where nothing is given, if it is not the settings' default."""

    name: str
    option: Option
    default: Any
    parameter: Parameter
    usual: Mapping[str, object]
    each: str | None = None

    def values(self, given: Mapping[str, Any]) -> list[dict[str, object]]:
        """The same for each of the values of a list, and for the one of any other option; without doubles, in order."""
        if self.each is None or given[self.name] is None:
            return [self.of(given)]
        words = [word.strip() for word in given[self.name].split(",")]
        return list({str(value): {self.name: value} for value in (self._read(word) for word in words)}.values())

    def _read(self, word: str) -> object:
        if self.option.read is not None:
            return self.option.read(self.each or flag(self.name), word)
        try:
            return float(word) if self.default is None else type(self.default)(word)
        except ValueError:
            raise SettingsError(f"{self.each} is a list of numbers like 1,2,5, not '{word}'") from None

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
    made: dict[str, tuple[type[Any], bool, list[_Asked]]] = {}
    for name, parameter in signature(command).parameters.items():
        settings, several, choice = _settings_of(hints[name])
        if settings is None:
            shown.append(parameter.replace(annotation=hints[name], kind=Parameter.KEYWORD_ONLY))
            continue
        made[name] = (settings, several, _asked(settings, choice))
        shown += [one.parameter for one in made[name][2]]

    @wraps(command)
    def asking(**given: Any) -> None:
        _refuse_contradictions(given)
        settings = {name: _made(kind, several, asked, given) for name, (kind, several, asked) in made.items()}
        options = {one.name for _, _, asked in made.values() for one in asked}
        command(**settings, **{name: value for name, value in given.items() if name not in options})

    shown.sort(key=_place)
    asking.__signature__ = Signature(shown)  # type: ignore[attr-defined] # as inspect reads it, and so typer
    asking.__annotations__ = {parameter.name: parameter.annotation for parameter in shown}
    return asking


def _place(parameter: Parameter) -> int:
    """Where a parameter stands in the help: what has no group first, then group by group."""
    groups = [getattr(beside, "rich_help_panel", None) for beside in get_args(parameter.annotation)[1:]]
    return rank(next((group for group in groups if group is not None), None))


def _made(kind: type[Any], several: bool, asked: Iterable[_Asked], given: Mapping[str, Any]) -> object:
    """The settings that the options make, or all of them where lists ask for several."""
    combinations = product(*(one.values(given) for one in asked))
    made = tuple(kind(**{key: value for part in parts for key, value in part.items()}) for parts in combinations)
    return made if several else made[0]


def _settings_of(hint: Any) -> tuple[type[Any] | None, bool, Iterable[object]]:
    """The settings that a parameter holds, if any, whether it holds several, and what stands beside its type."""
    kind, *beside = get_args(hint) if get_origin(hint) is Annotated else (hint,)
    several = get_origin(kind) is tuple
    if several:
        kind = get_args(kind)[0]
    return (kind if is_dataclass(kind) and isinstance(kind, type) else None), several, beside


def _asked(settings: type[Any], choice: Iterable[object]) -> list[_Asked]:
    hints = get_type_hints(settings)
    usual = {name: value for one in choice if isinstance(one, Usual) for name, value in one.own().items()}
    found = {}
    for field, option in options_of(settings):
        name, told = field.name, usual.get(field.name, field.default)
        # What may be left empty is not told, or it would seem to have been given.
        option = replace(option, told=option.told and (field.default is not None or name in usual))
        found[name] = _Asked(
            name=name,
            option=option,
            default=field.default,
            parameter=_parameter(name, hints[name], told, option, group_of(settings, name)),
            usual={name: usual[name]} if name in usual else {},
        )
    names = list(found)
    for one in choice:
        if isinstance(one, Only):
            names = list(one.names)
        if isinstance(one, Without):
            names = [name for name in names if name not in one.names]
        if isinstance(one, Each):
            found |= {name: _listed(found[name], option) for name, option in one.options.items()}
    return [found[name] for name in names]


def _parameter(name: str, kind: Any, default: Any, option: Option, group: str | None) -> Parameter:
    """The parameter of a command that typer makes an option of."""
    told = option.told and default is not None
    takes = option.takes or kind
    return Parameter(
        name,
        Parameter.KEYWORD_ONLY,
        default=(default if option.show is None else option.show(default)) if told else None,
        annotation=Annotated[
            takes if told else takes | None,
            typer.Option(flag(name), metavar=option.metavar, help=option.help, rich_help_panel=group),
        ],
    )


def _listed(asked: _Asked, option: str) -> _Asked:
    """The same setting asked for by a list."""
    what = f"{asked.option.help} Several, with commas between them."
    metavar = f"{(asked.option.metavar or 'X').partition('|')[0]},..."
    group = get_args(asked.parameter.annotation)[1].rich_help_panel
    parameter = asked.parameter.replace(
        default=None,
        annotation=Annotated[str | None, typer.Option(option, metavar=metavar, help=what, rich_help_panel=group)],
    )
    return replace(asked, parameter=parameter, each=option)


def _refuse_contradictions(given: Mapping[str, Any]) -> None:
    """Refuse options that cannot stand together, by the names that they have here."""
    for gap in OF_GAPS if given.get("weights") is not None else ():
        if given.get(gap) is not None:
            raise SettingsError(f"--weights take the place of a tolerance: leave out either --weights or {flag(gap)}.")
    if given.get("feature") == AUTO and given["max_deviation"] is None:
        raise SettingsError(f"--feature {AUTO} is chosen by the largest deviation: give --max-deviation, too.")
