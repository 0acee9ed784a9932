"""Put a change into functions that are loaded already, so that nothing needs to be loaded anew for it."""

from __future__ import annotations

import gc
from collections.abc import Iterator, Sequence
from pathlib import Path
from types import CodeType, FunctionType

from tests.mutation.mutants import Mutant

# A file, and the first line of a function, its decorators included.
Place = tuple[str, int]


def loaded_functions(root: Path, mutants: Sequence[Mutant]) -> dict[Place, list[FunctionType]]:
    """All functions of this process that begin where a change's outermost function does."""
    wanted = {(str((root / one.path).resolve()), one.function[0]) for one in mutants}
    found: dict[Place, list[FunctionType]] = {}
    for thing in gc.get_objects():
        if isinstance(thing, FunctionType):
            place = (thing.__code__.co_filename, thing.__code__.co_firstlineno)
            if place in wanted:
                found.setdefault(place, []).append(thing)
    return found


def put_in(mutant: Mutant, text: str, root: Path, functions: dict[Place, list[FunctionType]]) -> None:
    """Give the functions about a change its code, in this process.

    Args:
        mutant: a change inside a function.
        text: of its file, as it is.
        root: of the checkout.
        functions: from `loaded_functions`.
    """
    file = str((root / mutant.path).resolve())
    changed = compile(mutant.applied(text), file, "exec", dont_inherit=True)
    codes = {(code.co_firstlineno, code.co_name): code for code in _codes(changed)}
    for function in functions.get((file, mutant.function[0]), ()):
        code = function.__code__
        function.__code__ = codes[code.co_firstlineno, code.co_name]


def _codes(code: CodeType) -> Iterator[CodeType]:
    """The code of all functions and classes in some code."""
    for inner in code.co_consts:
        if isinstance(inner, CodeType):
            yield inner
            yield from _codes(inner)
