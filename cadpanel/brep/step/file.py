"""STEP files of panels: written straight from the exact topology, read back through the kernel.

The text is written without the kernel's own translator: it keeps every digit of a double (the translator keeps 12), is
byte for byte the same for the same panels, half the size, and takes half the time. It goes to the disk panel by panel,
so that neither the text nor shapes that are made as they are asked for stay in memory.
"""

from __future__ import annotations

import os
import secrets
import time
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import IO

from OCP.Standard import Standard_Failure
from OCP.TopoDS import TopoDS_Shape

from cadpanel.brep.files.step_reader import StepDocument, StepFault, read_document
from cadpanel.brep.files.xcaf import products_of
from cadpanel.brep.kernel.said import said_by
from cadpanel.brep.step.part_files import PartFile, write_assembly_text
from cadpanel.brep.step.products import Header, NamedShape, write_step_text
from cadpanel.brep.step.properties import ATTRIBUTES, PartData, Stated
from cadpanel.brep.step.schemas import Schema
from cadpanel.brep.step.stated import stated_of
from cadpanel.brep.step.text import NoReal
from cadpanel.brep.step.topology import UnsupportedGeometry
from cadpanel.errors import DeliveryError
from cadpanel.sizes import refuse_huge

Color = tuple[float, float, float]
_STALE_SECONDS = 3600.0
"""Nobody has written to a file for so long: it is left behind."""


def write_step(
    path: str | os.PathLike[str],
    shapes: Iterable[NamedShape],
    *,
    title: str,
    schema: Schema = "AP242",
    placed: tuple[float, float, float] = (0.0, 0.0, 0.0),
    data: Iterable[PartData] | None = None,
    header: Header | None = None,
) -> None:
    """Write a flat assembly, one product a shape with its name and colour, whole or not at all.

    Arguments:
        path: the file; an existing one is replaced once the new one is complete.
        shapes: name, a solid or an open shell that cadpanel built, sRGB colour with components in 0 to 1 or None.
            Names must differ. Each is asked for once all before it are written, and let go of.
        title: name of the assembly.
        schema: "AP242" or "AP214".
        placed: where the origin of the shapes' coordinates lies in the assembly, mm. Their own numbers stay small: far
            from the origin the kernel's checks lose their digits.
        data: what is said of each shape besides; None to say nothing but their names.
        header: who wrote it, and when.

    Raises:
        DeliveryError: if the file cannot be written, a shape has other than plane, cone and cylinder faces, or a
            number is not finite.
    """
    target = Path(path)
    try:
        _write_whole(target, lambda file: write_step_text(file, shapes, title, schema, placed, data, header))
    except UnsupportedGeometry as error:
        raise DeliveryError(f"{target} cannot be written: it would hold {error}, not an exact panel.") from error


def write_assembly(
    path: str | os.PathLike[str],
    parts: Sequence[PartFile],
    *,
    title: str,
    schema: Schema = "AP242",
    header: Header | None = None,
) -> None:
    """Write an assembly of STEP files that lie beside it, whole or not at all.

    Args:
        path: the file; an existing one is replaced once the new one is complete.
        parts: the files, in their order; they need not be there yet. Names must differ.
        title: name of the assembly.
        schema: "AP242" or "AP214".
        header: who wrote it, and when.

    Raises:
        DeliveryError: it cannot be written, or a file's path has letters that readers of STEP do not find again.
    """
    target = Path(path)
    for part in parts:
        if not part.path.isascii():
            raise DeliveryError(f"{target} cannot be written: '{part.path}' has other letters than ASCII; rename it.")
    _write_whole(target, lambda file: write_assembly_text(file, parts, title, schema, header))


def _write_whole(target: Path, write: Callable[[IO[str]], None]) -> None:
    """Write beside the target, and put it in its place once it is complete; whatever goes wrong leaves nothing."""
    _clear_left_behind(target)
    beside = target.with_name(f"{_beside(target)}{secrets.token_hex(4)}")
    try:
        try:
            with beside.open("x", encoding="ascii", newline="\n") as file:
                write(file)
                file.flush()
                os.fsync(file.fileno())
            beside.replace(target)
        finally:
            with suppress(OSError):  # what went wrong before is told
                beside.unlink(missing_ok=True)
    except OSError as error:
        raise DeliveryError(f"{target} cannot be written: {error.strerror or error}.") from error
    except NoReal as error:
        raise DeliveryError(f"{target} cannot be written: it would hold {error}.") from error


def _beside(target: Path) -> str:
    """How the names of files begin that are on their way to a target."""
    return f".{target.name}.cadpanel-"


def _clear_left_behind(target: Path) -> None:
    """Remove what runs have left beside a target that were killed while they wrote it."""
    with suppress(OSError):  # what cannot be read or removed is in nobody's way
        for path in target.parent.iterdir():
            if path.name.startswith(_beside(target)) and time.time() - path.stat().st_mtime > _STALE_SECONDS:
                path.unlink()


def read_step_shapes(path: str | os.PathLike[str], *, heal: bool = False) -> list[tuple[str, TopoDS_Shape]]:
    """The products of a flat assembly with their names, in the file's order; a single part counts as one.

    Arguments:
        path: the file.
        heal: whether the kernel may repair what it reads, as it does by default. Without, the shapes are what the file
            says, and reading takes less than half the time.

    Raises:
        DeliveryError: if the file is missing, not STEP, cut short, or damaged.
    """
    return open_step(path, heal=heal).shapes


@dataclass(frozen=True, slots=True)
class OpenStep:
    """A file's products with their names, in its order.

    The kernel's reader is kept for as long as the shapes are worked on: see `StepDocument`.
    """

    document: StepDocument
    shapes: list[tuple[str, TopoDS_Shape]]

    def stated(self) -> dict[str, Stated]:
        """What the file says of its products besides, by their names; nothing if it was not read for it."""
        return stated_of(self.document.document, ATTRIBUTES)


def open_step(path: str | os.PathLike[str], *, heal: bool = False, properties: bool = False) -> OpenStep:
    """The same, for longer work on the shapes; and if asked for, what is said of them besides."""
    target = Path(path)
    if not target.is_file():
        raise DeliveryError(f"'{target}' cannot be read: there is no such file.")
    refuse_huge(target, DeliveryError)
    try:
        step = read_document(target, labels=False, heal=heal, properties=properties)
    except StepFault as error:
        why = f"is damaged ({error.fault})" if error.fault else "is not a complete STEP file"
        raise DeliveryError(f"'{target}' cannot be read: it {why}.") from error
    except Standard_Failure as error:
        raise DeliveryError(f"'{target}' cannot be read: it makes the CAD kernel fail ({said_by(error)}).") from error
    shapes = products_of(step.document)
    if not shapes:
        raise DeliveryError(f"'{target}' cannot be read: it holds no shapes.")
    return OpenStep(step, shapes)
