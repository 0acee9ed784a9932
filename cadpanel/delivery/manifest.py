"""manifest.json: the size and SHA-256 of every other file of a delivery, written last.

Whoever receives a delivery sees by it whether a file is the one that was written; nobody's honesty is proved by it, as
whoever changes a file can change the manifest.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field

from cadpanel.delivery.records.jsonfile import NonNegativeCount, Record, read_json, write_json

MANIFEST = "manifest.json"
SCHEMA = "cadpanel.manifest/1"


class FileModel(Record):
    """A file as it was written: its size in bytes, and the SHA-256 of its content in hexadecimal digits."""

    size: NonNegativeCount
    sha256: Annotated[str, Field(pattern="^[0-9a-f]{64}$")]


class ManifestModel(Record):
    """manifest.json as a whole: every other file by its path in the delivery, with slashes."""

    schema_name: Literal["cadpanel.manifest/1"] = Field(default="cadpanel.manifest/1", alias="schema")
    files: dict[str, FileModel]


def write_manifest(folder: Path) -> None:
    """Write down what stands in a folder; the same files give the same bytes.

    Raises:
        DeliveryError: it cannot be written.
    """
    write_json(ManifestModel(files=dict(_files(folder))), folder / MANIFEST)


def read_manifest(folder: Path) -> ManifestModel:
    """What was written down in a folder.

    Raises:
        DeliveryError: it cannot be read or is no manifest; one sentence says where.
    """
    return read_json(folder / MANIFEST, ManifestModel, schema=SCHEMA, what="a cadpanel manifest")


def changed_files(folder: Path) -> tuple[str, ...]:
    """The files that are not as the folder's manifest has them, or not there any more, in their order.

    Raises:
        DeliveryError: the manifest cannot be read.
        OSError: a file cannot be read.
    """
    stated = read_manifest(folder).files
    return tuple(name for name, file in stated.items() if not _is(folder / name, file))


def unlisted_files(folder: Path) -> tuple[str, ...]:
    """The files in a folder that its manifest does not tell of, in their order.

    Raises:
        DeliveryError: the manifest cannot be read.
    """
    stated = read_manifest(folder).files
    return tuple(name for name, _ in _paths(folder) if name not in stated)


def _files(folder: Path) -> Iterator[tuple[str, FileModel]]:
    for name, path in _paths(folder):
        yield name, _told(path)


def _paths(folder: Path) -> Iterator[tuple[str, Path]]:
    for path in sorted(folder.rglob("*"), key=lambda path: path.relative_to(folder).parts):
        if path.is_file() and path != folder / MANIFEST:
            yield path.relative_to(folder).as_posix(), path


def _told(path: Path) -> FileModel:
    with path.open("rb") as file:
        digest = hashlib.file_digest(file, "sha256").hexdigest()
    return FileModel(size=path.stat().st_size, sha256=digest)


def _is(path: Path, stated: FileModel) -> bool:
    """Whether a file is the one that was written; one of another size is not read."""
    return path.is_file() and path.stat().st_size == stated.size and _told(path) == stated
