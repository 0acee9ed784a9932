"""Variables, `${name}`: what they stand for, and which of them a value needs."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from types import MappingProxyType
from typing import Any

from cadpanel.errors import SettingsError
from cadpanel.near import near_names

_NAMED = re.compile(r"\$(\$(?=\{)|\{(?P<name>[^{}]*)\})")
_NOWHERE: Mapping[str, str] = MappingProxyType({})


def substituted(value: Any, variables: Mapping[str, Any], elsewhere: Mapping[str, str] = _NOWHERE) -> Any:
    """A value with the variables in its texts; a text that is one variable alone becomes what the variable is.

    `$${` stands for `${`.

    Args:
        value: as TOML has it.
        variables: that are known here.
        elsewhere: what to say of names that are not known here, and are in another place.

    Raises:
        SettingsError: there is no variable of a name.
    """

    def known(name: str) -> Any:
        if name in variables:
            return variables[name]
        raise SettingsError(elsewhere.get(name) or f"there is no variable '{name}'; {near_names(name, variables)}")

    def in_text(text: str) -> Any:
        alone = _NAMED.fullmatch(text)
        if alone is not None and alone["name"] is not None:
            return known(alone["name"])
        return _NAMED.sub(lambda found: "$" if found["name"] is None else str(known(found["name"])), text)

    return _in_texts(value, in_text)


def escaped(value: Any) -> Any:
    """The value that becomes this one when variables are put in their places, whatever signs stand in it."""
    return _in_texts(value, lambda text: text.replace("${", "$${"))


def names_in(value: Any) -> Iterator[str]:
    """The names of all variables in a value."""
    if isinstance(value, Mapping):
        for inner in value.values():
            yield from names_in(inner)
    elif isinstance(value, list):
        for inner in value:
            yield from names_in(inner)
    elif isinstance(value, str):
        yield from (found["name"] for found in _NAMED.finditer(value) if found["name"] is not None)


def _in_texts(value: Any, change: Callable[[str], Any]) -> Any:
    if isinstance(value, Mapping):
        return {key: _in_texts(inner, change) for key, inner in value.items()}
    if isinstance(value, list | tuple):
        return type(value)(_in_texts(inner, change) for inner in value)
    return change(value) if isinstance(value, str) else value
