"""Which program makes results: a part of what a result depends on, and the same for all who work at a job."""

from __future__ import annotations

import hashlib
import json
import sys
from collections.abc import Iterable, Mapping
from functools import cache
from importlib.metadata import PackageNotFoundError, requires, version
from pathlib import Path
from typing import Any

_COMPILED = "__pycache__"


@cache
def program(needs: tuple[str, ...] = ()) -> Mapping[str, Any]:
    """Which program it is: its version, its own files, and what it computes with.

    Python counts by its minor version: from 3.12 on its `sum` of numbers rounds otherwise than before.

    Args:
        needs: packages that are computed with besides those that are always there.
    """
    return {
        "version": version("cadpanel"),
        "text": text_sum(Path(__file__).parents[1]),
        "python": "{}.{}".format(*sys.version_info),
        "packages": _versions((*_required(), *needs)),
    }


def program_sum(needs: tuple[str, ...] = ()) -> str:
    """The same in one word."""
    return hashlib.sha256(json.dumps(program(needs), sort_keys=True).encode()).hexdigest()


def text_sum(home: Path) -> str:
    """Of all files of a package, as pages are made of more than Python; not of what Python makes of them."""
    found = hashlib.sha256()
    for file in sorted(home.rglob("*")):
        if file.is_file() and _COMPILED not in file.parts:
            content = file.read_bytes()
            found.update(f"{file.relative_to(home).as_posix()}\0{len(content)}\0".encode() + content)
    return found.hexdigest()


def _required() -> set[str]:
    """The packages without which there is no cadpanel, and the kernel that they bring along."""
    names = {line.split(";")[0].split("[")[0] for line in requires("cadpanel") or () if "extra ==" not in line}
    return {"".join(sign for sign in _before(name) if not sign.isspace()) for name in (*names, "cadquery-ocp")}


def _versions(names: Iterable[str]) -> dict[str, str]:
    found = {}
    for name in sorted(set(names)):
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            continue  # another package of the same content
    return found


def _before(requirement: str) -> str:
    """A package's name without the versions that are wanted."""
    for sign in "<>=!~ (":
        requirement = requirement.partition(sign)[0]
    return requirement
