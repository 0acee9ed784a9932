"""What an assembly of files says of its parts, read from its text: which files they are, and where each is placed.

Only files that cadpanel wrote are understood: an instance a line, as `write_assembly_text` writes them.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import NamedTuple

from cadpanel.errors import DeliveryError
from cadpanel.sizes import refuse_huge

_HEAD = 65_536
"""Bytes within which a header ends: titles and people in it are a few words."""
_WRITTEN_HERE = b",'cadpanel','cadpanel','');\n"
_PLACED = "CONTEXT_DEPENDENT_SHAPE_REPRESENTATION("
_END = "END-ISO-10303-21;\n"
_STRING = re.compile(r"'((?:[^']|'')*)'")
_INSTANCE = re.compile(r"^#(\d+)=(.*?);\n", re.DOTALL | re.MULTILINE)
_POINT = re.compile(r"\(([^()]*)\)\)$")


class HungFile(NamedTuple):
    """A file that is a part: its path from the assembly, and where the origin of its coordinates lies there, mm."""

    path: str
    placed: tuple[float, float, float]


def is_written_here(path: Path) -> bool:
    """Whether a STEP file is as cadpanel wrote it, and not saved by another program since.

    Raises:
        OSError: it cannot be read.
    """
    with path.open("rb") as file:
        return _WRITTEN_HERE in file.read(_HEAD).partition(b"ENDSEC;")[0]


def hung_files(path: Path) -> tuple[HungFile, ...]:
    """The parts of an assembly, in its order.

    Raises:
        DeliveryError: it cannot be read, or is no assembly of files that cadpanel wrote.
    """
    refuse_huge(path, DeliveryError)
    try:
        text = path.read_text(encoding="ascii")
    except (OSError, ValueError) as error:
        raise DeliveryError(f"'{path}' cannot be read: {error}.") from error
    told = _Instances(_INSTANCE.findall(text))
    try:
        if _WRITTEN_HERE.decode() not in text or not text.endswith(_END):
            raise ValueError(path)
        return tuple(_hung(told, entity) for entity in told.values() if entity.startswith(_PLACED))
    except (KeyError, ValueError, TypeError) as error:
        raise DeliveryError(f"'{path}' is no assembly of files as cadpanel writes it, or is damaged.") from error


class _Instances(dict[str, str]):
    """Instances by their numbers."""

    def used(self, entity: str, place: int) -> str:
        """The instance that stands at a place among those which another one refers to."""
        numbers = re.findall(r"#(\d+)", _STRING.sub("''", entity))
        return self[numbers[place] if -len(numbers) <= place < len(numbers) else ""]


def _hung(told: _Instances, placing: str) -> HungFile:
    """From the instance that relates a part's shape to the assembly's to the file of the one and the place of it."""
    relation, shape = told.used(placing, 0), told.used(placing, 1)
    part = told.used(told.used(shape, 0), 1)
    document = told.used(part, -1)
    called = _STRING.search(document)
    point = told.used(told.used(told.used(relation, 2), 1), 0)
    numbers = _POINT.search(point)
    if not document.startswith("DOCUMENT_FILE(") or called is None or numbers is None:
        raise ValueError(placing)
    x, y, z = map(float, numbers[1].split(","))
    return HungFile(called[1].replace("''", "'").replace("\\\\", "\\"), (x, y, z))
