"""Variables, `${name}`, and matrices: one region for every combination of some values."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from typing import Any

from cadpanel.errors import SettingsError
from cadpanel.near import near_names

_NAMED = re.compile(r"\$(\$(?=\{)|\{(?P<name>[^{}]*)\})")


def substituted(value: Any, variables: Mapping[str, Any]) -> Any:
    """A value with the variables in its texts; a text that is one variable alone becomes what the variable is.

    `$${` stands for `${`.

    Raises:
        SettingsError: there is no variable of a name.
    """
    if isinstance(value, Mapping):
        return {key: substituted(inner, variables) for key, inner in value.items()}
    if isinstance(value, list):
        return [substituted(inner, variables) for inner in value]
    if not isinstance(value, str):
        return value
    alone = _NAMED.fullmatch(value)
    if alone is not None and alone["name"] is not None:
        return _looked_up(alone["name"], variables)
    return _NAMED.sub(lambda found: "$" if found["name"] is None else str(_looked_up(found["name"], variables)), value)


def resolved(variables: Mapping[str, Any]) -> dict[str, Any]:
    """Variables in which those before them may stand.

    Raises:
        SettingsError: one is used that does not stand before.
    """
    found: dict[str, Any] = {}
    for name, value in variables.items():
        found[name] = substituted(value, found)
    return found


def combinations(matrix: Mapping[str, Sequence[Any]]) -> Iterator[tuple[str, dict[str, Any]]]:
    """Every combination of the values, the first name changing slowest, and what is put behind a region's name."""
    for values in product(*matrix.values()):
        chosen = dict(zip(matrix, values, strict=True))
        yield "".join(f"-{name}={_told(value)}" for name, value in chosen.items()), chosen


def _told(value: Any) -> str:
    return "x".join(map(_told, value)) if isinstance(value, list) else str(value)


def _looked_up(name: str, variables: Mapping[str, Any]) -> Any:
    if name not in variables:
        raise SettingsError(f"there is no variable '{name}'; {near_names(name, variables)}")
    return variables[name]
