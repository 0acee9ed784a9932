"""Arguments of the kinds that a function's annotations say: what is of another kind is refused before any work."""

from __future__ import annotations

import collections.abc
import functools
import inspect
import os
import sys
import types
import typing
from collections.abc import Callable, Mapping, Sequence
from numbers import Integral, Real
from pathlib import Path
from typing import Any, ParamSpec, TypeVar

import numpy as np

from cadpanel.errors import SettingsError
from cadpanel.near import near_names

Arguments = ParamSpec("Arguments")
Given = TypeVar("Given")
_CALLED = {
    float: "a number",
    int: "a whole number",
    bool: "True or False",
    str: "a word",
    Path: "a path",
    type(None): "None",
}


def checked(function: Callable[Arguments, Given]) -> Callable[Arguments, Given]:
    """The same function, which refuses arguments of another kind than its annotations say.

    Annotations that only type checkers can resolve are left to the function.
    """
    signature = inspect.signature(function)

    @functools.wraps(function)
    def with_checked_arguments(*args: Arguments.args, **kwargs: Arguments.kwargs) -> Given:
        try:
            given = signature.bind(*args, **kwargs).arguments
        except TypeError as error:
            raise SettingsError(f"{function.__name__}() {error}{_near(error, kwargs, signature)}") from error
        for changes in [value for name, value in given.items() if name == _open_keywords(signature)]:
            given = {**given, **changes}
        for name, kind in _kinds_of(function).items():
            if name in given and not fits(given[name], kind):
                _refuse(function, name, given[name], kind)
        return function(*args, **kwargs)

    return with_checked_arguments


def _near(error: TypeError, given: Mapping[str, object], signature: inspect.Signature) -> str:
    """The names of arguments that a keyword nearly is, where it is the keyword that does not go."""
    known = [one.name for one in signature.parameters.values() if one.name != "self"]
    wrong = next((word for word in given if word not in known and f"'{word}'" in str(error)), None)
    return "" if wrong is None else f"; {near_names(wrong, known)}"


def _refuse(function: Callable[..., object], name: str, value: object, kind: Any) -> None:
    raise SettingsError(f"'{name}' of {function.__name__}() must be {called(kind)}, not {shown(value)}")


def shown(value: object) -> str:
    """A value on one line."""
    return f"{' '.join(repr(value).split()):.80}"


def _open_keywords(signature: inspect.Signature) -> str | None:
    return next((one.name for one in signature.parameters.values() if one.kind is one.VAR_KEYWORD), None)


@functools.cache
def _kinds_of(function: Callable[..., object]) -> dict[str, Any]:
    """The annotations of a function, and of the keywords that it unpacks, as far as they can be resolved."""
    names = vars(sys.modules[function.__module__])
    found: dict[str, Any] = {}
    for one in inspect.signature(function).parameters.values():
        if one.annotation is one.empty:  # as the self of a method
            continue
        if one.kind is one.VAR_POSITIONAL:  # they come as a tuple, and the annotation is that of each
            each = _resolved({one.name: one.annotation}, names)
            found |= {name: types.GenericAlias(tuple, (kind, ...)) for name, kind in each.items()}
        elif one.kind is not one.VAR_KEYWORD:
            found |= _resolved({one.name: one.annotation}, names)
        elif isinstance(keywords := names.get(str(one.annotation).removeprefix("Unpack[").rstrip("]")), type):
            found |= _resolved(keywords.__annotations__, vars(sys.modules[keywords.__module__]))
    return found


def _resolved(annotations: Mapping[str, Any], names: Mapping[str, Any]) -> dict[str, Any]:
    found = {}
    for name, text in annotations.items():
        expression = text.__forward_arg__ if isinstance(text, typing.ForwardRef) else text
        try:
            found[name] = eval(expression, dict(names))
        except NameError:
            if name == "progress":  # its arguments are named where only type checkers look
                found[name] = Callable[..., object] | None
    return found


def fits(value: object, kind: Any) -> bool:
    """Whether a value is of a kind: a class, a union, a literal, or a sequence of such; true of what is not known."""
    origin, parts = typing.get_origin(kind), typing.get_args(kind)
    if kind is Any or kind is None:
        return kind is Any or value is None
    if origin in (typing.Union, types.UnionType):
        return any(fits(value, part) for part in parts)
    if origin is typing.Literal:
        return any(type(value) is type(part) and value == part for part in parts)
    if origin is collections.abc.Callable:
        return callable(value)
    if origin in (tuple, list, Sequence):
        return _is_sequence(value, origin, parts)
    if origin in (dict, Mapping):
        return isinstance(value, Mapping)
    if kind is float:
        return isinstance(value, Real) and not isinstance(value, bool)
    if kind is int:
        return isinstance(value, Integral) and not isinstance(value, bool)
    if kind is Path:
        return isinstance(value, os.PathLike)
    return not isinstance(kind, type) or isinstance(value, kind)


def _is_sequence(value: object, origin: Any, parts: tuple[Any, ...]) -> bool:
    if isinstance(value, np.ndarray):
        return value.ndim > 0 and _is_sequence(value.tolist(), origin, parts)
    if isinstance(value, str | bytes) or not isinstance(value, Sequence):
        return False
    if origin is tuple and parts and parts[-1] is not Ellipsis:
        return len(value) == len(parts) and all(map(fits, value, parts))
    return not parts or all(fits(one, parts[0]) for one in value)


def called(kind: Any) -> str:
    """A kind in words."""
    origin, parts = typing.get_origin(kind), typing.get_args(kind)
    if origin in (typing.Union, types.UnionType):
        # Whoever may give a path may give it as a word.
        told = [part for part in parts if part is not str or Path not in parts]
        return " or ".join(dict.fromkeys(called(part) for part in told))
    if origin is typing.Literal:
        return " or ".join(map(repr, parts))
    if origin is collections.abc.Callable:
        return "a function"
    if origin in (tuple, list, Sequence):
        return "a list" if not parts else f"a list, of which each is {called(parts[0])}"
    return _CALLED.get(kind, getattr(kind, "__name__", str(kind)))
