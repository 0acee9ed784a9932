"""What may stand in a region of a job: the fields of all settings, by their own names, read as their options are.

The model is made of the settings' fields, so that a new setting is one here, too; their ranges, and what contradicts
what, is for the settings to say.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import Field, dataclass
from functools import cache
from pathlib import Path
from types import NoneType, UnionType
from typing import Any, Literal, NotRequired, Union, get_args, get_origin, get_type_hints

from pydantic import ConfigDict, TypeAdapter
from typing_extensions import TypedDict

from cadpanel.delivery.settings import SheetSettings
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.errors import SettingsError
from cadpanel.fitting.rules.book import Rules
from cadpanel.fitting.settings import OF_GAPS, FitSettings
from cadpanel.reference.settings import ReferenceSettings
from cadpanel.setting import Option, options_of

KINDS: tuple[type[Any], ...] = (ReferenceSettings, FitSettings, SheetSettings, ShopSettings)
OF_A_FILE = "FILE"
"""What stands for the value of an option that names a file."""
RULES = "rules"
REFERENCE, SHA256, DELIVERIES, MATRIX = "reference", "sha256", "deliveries", "matrix"
"""What stands in a region besides settings."""


@dataclass(frozen=True, slots=True)
class Asked:
    """One setting: whose field it is, its type, and how the command line reads it."""

    kind: type[Any]
    field: Field[Any]
    hint: Any
    option: Option

    @property
    def is_file(self) -> bool:
        """Whether it names a file."""
        return self.option.metavar == OF_A_FILE

    def value(self, given: Any) -> Any:
        """From what a job says to what the setting is.

        Raises:
            SettingsError: it cannot be read.
        """
        read = self.option.read
        if read is not None and (self.option.takes is not str or isinstance(given, str)):
            return read(self.field.name, given)
        return _frozen(given)


@cache
def asked() -> Mapping[str, Asked]:
    """All settings that a job may give, by name."""
    return {name: one for kind in KINDS for name, one in _of(kind)}


def _of(kind: type[Any]) -> Iterator[tuple[str, Asked]]:
    hints = get_type_hints(kind)
    for field, option in options_of(kind):
        yield field.name, Asked(kind, field, hints[field.name], option)


@cache
def region_values() -> TypeAdapter[dict[str, Any]]:
    """What checks the values of a region: the reference and every setting, by types alone."""
    settings: dict[str, Any] = {name: NotRequired[_toml_type(one)] for name, one in asked().items()}
    # A dictionary with these keys, and no class with attributes: one of the settings is called "schema".
    others = {REFERENCE: str, SHA256: NotRequired[str], DELIVERIES: NotRequired[dict[str, str]]}
    values = TypedDict("values", {**others, **settings})  # type: ignore[misc]
    values.__pydantic_config__ = ConfigDict(extra="forbid", strict=True, allow_inf_nan=False)  # type: ignore[attr-defined]
    checked: TypeAdapter[dict[str, Any]] = TypeAdapter(values)  # type: ignore[arg-type] # made here
    return checked


def made(given: Mapping[str, Any]) -> tuple[ReferenceSettings, FitSettings, SheetSettings, ShopSettings]:
    """The settings that a region's values make.

    Raises:
        SettingsError: a value is out of its range, or contradicts another one.
    """
    _refuse_contradictions(given)
    values = {name: asked()[name].value(value) for name, value in given.items()}
    parts = [kind(**{name: value for name, value in values.items() if asked()[name].kind is kind}) for kind in KINDS]
    how, settings, sheet, shop = parts
    return how, settings, sheet, shop


def _refuse_contradictions(given: Mapping[str, Any]) -> None:
    gaps = [name for name in OF_GAPS if name in given]
    if "weights" in given and gaps:
        raise SettingsError(f"weights take the place of a tolerance: leave out either 'weights' or '{gaps[0]}'")


def _toml_type(one: Asked) -> Any:
    """The type of a setting's value in TOML."""
    takes = () if one.option.takes is None else (one.option.takes,)
    members = tuple(_plain_types(one.hint))
    return Union[(*takes, *members)]


def _plain_types(hint: Any) -> Iterator[Any]:
    """The types of which TOML has values."""
    origin = get_origin(hint)
    if origin in (Union, UnionType):
        for member in get_args(hint):
            yield from _plain_types(member)
    elif hint is Path:
        yield str
    elif hint is Rules:
        yield dict[str, Any]
    elif hint in (str, int, float, bool) or origin is Literal:
        yield hint
    elif isinstance(origin, type) and issubclass(origin, Sequence | Iterable):
        inner = {member: None for part in get_args(hint) if part is not ... for member in _plain_types(part)}
        members: Any = Union[tuple(inner)] if inner else str  # noqa: UP007
        yield list[members]
    elif hint is not NoneType:
        return  # what a program alone can give, as a feature of its own


def _frozen(value: Any) -> Any:
    return tuple(map(_frozen, value)) if isinstance(value, list) else value
