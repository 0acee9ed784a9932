"""Names of regions, which are those of their folders: written by users, or made by a matrix."""

from __future__ import annotations

import hashlib
import unicodedata
from collections.abc import Collection, Iterator, Mapping, Sequence
from itertools import product
from typing import Any

from cadpanel.delivery.file_names import file_names
from cadpanel.delivery.own_files import JOB
from cadpanel.jobs.building import BUILDING
from cadpanel.jobs.summary import SUMMARY, SUMMARY_TABLE

LONGEST = 120
"""Signs that a name may have."""
RESERVED = frozenset({JOB, BUILDING, SUMMARY, SUMMARY_TABLE})
"""Files that stand beside the folders of regions."""
_SUM_SIGNS = 8


def first_fault(names: Sequence[str], whole: Sequence[bool]) -> tuple[int, str] | None:
    """Which of the names that a user gave to regions can be none, and why; None where all can.

    Args:
        names: of the regions.
        whole: of each, whether that is the name of its folder, and nothing is put behind.
    """
    for place, name in enumerate(names):
        (safe,) = file_names([name], LONGEST)
        if name != safe:
            return place, f"the region '{name}' cannot have a folder of its name: call it '{safe}', for example"
    places = [place for place, alone in enumerate(whole) if alone]
    for place, free in zip(places, file_names([names[place] for place in places], LONGEST, RESERVED), strict=True):
        if names[place] != free:
            kept = file_names([names[place]], LONGEST, RESERVED) == [names[place]]
            other = "another one, where case does not count" if kept else "a file that stands beside the regions"
            return place, f"the region '{names[place]}' is called as {other}: call it '{free}', for example"
    return None


def variant_names(wanted: Sequence[str], taken: Collection[str]) -> list[str]:
    """The names of regions that a matrix makes: as they are wanted where folders can have them, else nearly so.

    Args:
        wanted: a region's name with what the matrix puts behind.
        taken: names of what stands beside their folders.
    """
    return file_names([_short(name) for name in wanted], LONGEST, taken)


def combinations(matrix: Mapping[str, Sequence[Any]]) -> Iterator[tuple[str, dict[str, Any]]]:
    """Every combination of the values, the first name changing slowest, and what is put behind a region's name.

    Values are told by signs that names of files may have, and no two of one list alike.
    """
    told = [
        zip(file_names([_told(value) for value in values], LONGEST), values, strict=True) for values in matrix.values()
    ]
    for chosen in product(*told):
        pairs = list(zip(matrix, chosen, strict=True))
        yield "".join(f"-{name}={said}" for name, (said, _) in pairs), {name: value for name, (_, value) in pairs}


def _told(value: Any) -> str:
    if isinstance(value, Mapping):
        return "_".join(f"{key}_{_told(inner)}" for key, inner in value.items())
    return "x".join(map(_told, value)) if isinstance(value, list) else str(value)


def _short(name: str) -> str:
    """A name that is not too long; of one that is the end gives way to a sum of the whole, so that it stays its own."""
    (kept,) = file_names([name], LONGEST)
    if len(kept) >= len(unicodedata.normalize("NFC", name)):
        return name
    ending = f"-{hashlib.sha256(name.encode()).hexdigest()[:_SUM_SIGNS]}"
    return f"{kept[: -len(ending)]}{ending}"
